"""The scene in MuJoCo: a 2D flex with nodes at the box corners, and rollers as cylinders.

The sheet is isotropic: its membrane and bending stiffness are the geometric means of the two directions
(a flex takes one Young's modulus and one thickness), without Poisson's ratio, and one damping. Contact is
MuJoCo's soft constraint, linear in depth, with as stiff a spring as our law has under the roller's preload;
restitution has no counterpart. Each node has the same mass. Units are the Model's: mm, g, ms, N.
"""

from __future__ import annotations

import math
import time
from importlib import import_module
from typing import Any

import numpy as np

from mdlgen.backend import Backend
from mdlgen.bench.peers import MISSING
from mdlgen.bench.peers.scene import Motion, check
from mdlgen.errors import RefusedError
from mdlgen.model.tables import (
    BOX_CYLINDER,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    Floats,
    Model,
    RollerPart,
    SheetPart,
)
from mdlgen.results.result import Result

STEP = 0.05  # [ms], where none is given
# A constraint's force is k d/(1 - d) depth/A, A the inverse mass that it meets: close to 1 friction creeps
# little, at 1 the solver is ill-conditioned.
IMPEDANCE = 0.99
DAMPING_RATIO = 0.5  # of a contact
FRICTION = 10  # times as stiff as the normal direction, against creep
KEEP_SPEED = 1e6  # gain of the drives [N mm ms]: a roller of 25 g mm^2 is 25 ns behind

APART = 'contype="0" conaffinity="0"'  # touches only bodies that a pair names


def solve(model: Model, progress: Any = None, step: float | None = None) -> Result:
    """Run it. Raises RefusedError where MuJoCo is not installed, or for a scene that it does not hold."""
    check(model, "the MuJoCo model")
    try:
        mujoco = import_module("mujoco")
    except ModuleNotFoundError:
        raise RefusedError(MISSING) from None

    began = time.perf_counter()
    dt = step or model.run.step or STEP
    every = round(model.run.print_step / dt)
    if abs(every * dt - model.run.print_step) > 1e-9 * dt:
        raise RefusedError(
            f"MuJoCo's fixed step {dt:g} ms is no part of the {model.run.print_step:g} ms stored"
        )
    compiled = mujoco.MjModel.from_xml_string(mjcf(model, dt))
    data = mujoco.MjData(compiled)
    mujoco.mj_forward(compiled, data)
    corners = _Corners(model.sheets[0], data.flexvert_xpos)
    driven = [roller for roller in model.rollers if roller.speed is not None]
    times, centers = [0.0], [corners.centers(data.flexvert_xpos)]
    steps = round(model.run.duration / dt)
    built = time.perf_counter() - began

    status, began = "ok", time.perf_counter()
    for count in range(1, steps + 1):
        data.ctrl[:] = [_speed(roller, count * dt) for roller in driven]
        mujoco.mj_step(compiled, data)
        if count % every == 0:
            times.append(count * dt)
            centers.append(corners.centers(data.flexvert_xpos))
    wall = time.perf_counter() - began
    warned = [mujoco.mjtWarning(kind).name for kind, message in enumerate(data.warning) if message.number]
    if warned or not np.isfinite(centers[-1]).all():
        status = f"MuJoCo warned of {', '.join(warned) or 'nothing, and its state is not finite'}"
    motion = Motion(np.array(times), np.array(centers), dt, steps, wall, built)
    return motion.result(model, "mujoco", status)


def mjcf(model: Model, dt: float) -> str:
    """The model as MuJoCo reads it."""
    kinds = model.contacts.kind
    parts = [_plane(model, int(row)) for row in np.flatnonzero(kinds == BOX_PLANE)]
    parts += [_roller(model, roller) for roller in model.rollers]
    pairs = [_pair(model, int(row)) for row in np.flatnonzero(kinds == CYLINDER_CYLINDER)]
    drives = [
        f'<velocity joint="spin_{roller.name}" kv="{KEEP_SPEED:g}"/>'
        for roller in model.rollers
        if roller.speed is not None
    ]
    # elastic forces of a flex are implicit under `discrete` alone; Newton needs a tenth of CG's iterations
    return f"""<mujoco>
<compiler angle="radian"/>
<option timestep="{dt!r}" gravity="{_words(model.gravity)}" integrator="discrete" solver="Newton"
  cone="elliptic" impratio="{FRICTION}" tolerance="1e-8" iterations="100"/>
<size memory="200M"/>
<worldbody>
{"".join(parts)}{_sheet(model, model.sheets[0])}
</worldbody>
<contact>{"".join(pairs)}</contact>
<actuator>{"".join(drives)}</actuator>
</mujoco>"""


def _sheet(model: Model, sheet: SheetPart) -> str:
    """The flex; what its two directions differ by, d_x/d_y included, cancels in the geometric mean."""
    joints, derived = 2 if sheet.layout == "edge_to_edge" else 1, sheet.derived
    membrane = joints * math.sqrt(derived["k_x"] * derived["k_y"])
    bending = joints * math.sqrt(derived["k_tx"] * derived["k_ty"])
    # from E t and E t^3/12
    thickness = math.sqrt(12 * bending / membrane)
    mass = _node_mass(model) * (sheet.n_x + 1) * (sheet.n_y + 1)
    return f"""<flexcomp name="{sheet.name}" type="grid" dim="2" pos="{_words(sheet.center)}"
 count="{sheet.n_x + 1} {sheet.n_y + 1} 1" spacing="{_words((sheet.d_x, sheet.d_y, 1.0))}"
 radius="{sheet.thickness / 2!r}" mass="{mass!r}" inertiabox="0.001">
<elasticity young="{membrane / thickness!r}" poisson="0" thickness="{thickness!r}" elastic2d="both"
 damping="{derived["c_x"] / derived["k_x"]!r}"/>
<contact selfcollide="none" contype="1" conaffinity="0"/>
</flexcomp>"""


def _plane(model: Model, row: int) -> str:
    plane = next(plane for plane in model.planes if plane.name == model.contacts.part_b[row])
    size = np.array(plane.size) / 2
    return (
        f'<geom name="{plane.name}" type="box" pos="{_words(plane.center)}" size="{_words(size)}"'
        f" {_touch(model, row, _node_mass(model))}/>\n"
    )


def _roller(model: Model, roller: RollerPart) -> str:
    """A cylinder for the sheet, and for other rollers a ball, which meets another in one point."""
    table = model.contacts
    own = [k for k in range(len(table)) if table.kind[k] == BOX_CYLINDER and table.part_b[k] == roller.name]
    touch = _touch(model, own[0], _node_mass(model)) if own else APART
    joints, press = "", roller.press
    if press is not None:
        rest = press.preload / press.stiffness + press.touch - press.start
        joints = (
            f'<joint type="slide" axis="{_words(press.direction)}" stiffness="{press.stiffness!r}"'
            f' springref="{rest!r}" damping="{press.damping!r}"/>'
        )
    inertia = (roller.inertia_transverse, roller.inertia_axial, roller.inertia_transverse)
    return f"""<body pos="{_words(model.bodies.position[roller.body])}">
{joints}<joint name="spin_{roller.name}" type="hinge" axis="{_words(roller.axis)}"/>
<inertial pos="0 0 0" mass="{roller.mass!r}" diaginertia="{_words(inertia)}"/>
<geom name="{roller.name}" type="cylinder" zaxis="0 1 0" size="{roller.radius!r} {roller.width / 2!r}"
 {touch}/>
<geom name="ball_{roller.name}" type="sphere" size="{roller.radius!r}" {APART}/>
</body>
"""


def _pair(model: Model, row: int) -> str:
    """Two rollers; of a body that has one way to move MuJoCo counts a third of the inverse mass."""
    first, second = model.contacts.part_a[row], model.contacts.part_b[row]
    both = [model.roller(name) for name in (first, second)]
    mass = 3 * next((roller.mass for roller in both if roller.press is not None), both[0].mass)
    mu = float(model.contacts.mu_dynamic[row])
    return (
        f'<pair geom1="ball_{first}" geom2="ball_{second}" condim="3" friction="{mu!r} {mu!r} 0 0 0"'
        f" {_spring(model, row, mass)}/>\n"
    )


def _touch(model: Model, row: int, mass: float) -> str:
    """Contact of a geom with the flex; by its priority the geom's numbers hold for both."""
    mu = float(model.contacts.mu_dynamic[row])
    friction = f'condim="3" friction="{mu!r} 0 0" {_spring(model, row, mass)}'
    return f'contype="0" conaffinity="1" priority="1" {friction}'


def _spring(model: Model, row: int, mass: float) -> str:
    """A contact point's spring: the secant of k z^1.5 at the rollers' greatest preload.

    The whole of it in each of the about six points that a roller has: softer, the contact creeps more.
    """
    preload = max((roller.press.preload for roller in model.rollers if roller.press), default=1.0)
    secant = float(model.contacts.stiffness[row]) ** (2 / 3) * preload ** (1 / 3)
    k = secant * (1 - IMPEDANCE) / IMPEDANCE / mass
    c = 2 * DAMPING_RATIO * math.sqrt(k)
    return f'solref="{-k!r} {-c!r}" solimp="{IMPEDANCE} {IMPEDANCE} 1"'


def _node_mass(model: Model) -> float:
    sheet = model.sheets[0]
    boxes = slice(sheet.first, sheet.first + sheet.count)
    return float(model.bodies.mass[boxes].sum()) / ((sheet.n_x + 1) * (sheet.n_y + 1))


class _Corners:
    """MuJoCo's order of the nodes, and the box centres between them."""

    def __init__(self, sheet: SheetPart, start: Floats) -> None:
        self.order = np.lexsort((start[:, 0].round(6), start[:, 1].round(6)))
        self.shape = (sheet.n_y + 1, sheet.n_x + 1, 3)

    def centers(self, nodes: Floats) -> Floats:
        """The mean of each box's four corners [mm], (boxes, 3)."""
        at = nodes[self.order].reshape(self.shape)
        return ((at[:-1, :-1] + at[1:, :-1] + at[:-1, 1:] + at[1:, 1:]) / 4).reshape(-1, 3)


def _words(numbers: Any) -> str:
    return " ".join(repr(float(number)) for number in numbers)


def _speed(roller: RollerPart, at: float) -> float:
    """Speed of a driven roller [rad/ms]: a linear ramp."""
    return (roller.speed or 0.0) * min(1.0, at / roller.ramp if roller.ramp else 1.0)


BACKEND = Backend(solve=solve)
