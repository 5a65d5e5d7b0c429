"""The twelve scenes of the bench: short ones that together use most rules of the solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mdlgen.bench.campaign.scene import drawn
from mdlgen.bench.case import Run

if TYPE_CHECKING:
    from mdlgen.model.tables import Model

SEED = 1
ONE_WAY = "rollers.pick.one_way={direction: -1, torque: 1 N*mm}"


@dataclass(frozen=True)
class TuningScene:
    """A scene, its duration [ms] (None: its own) and its step [ms] (None: the solver searches it)."""

    name: str
    meaning: str
    scene: Callable[[], Model]
    duration: float | None
    step: float | None

    def model(self) -> Model:
        """The scene, lowered. Raises SpecError."""
        model = self.scene()
        run = replace(model.run, step=self.step)
        if self.duration is not None:
            run = replace(run, duration=self.duration, print_step=min(run.print_step, self.duration / 4))
        return replace(model, run=run)


def _sample(name: str, *overrides: str) -> Callable[[], Model]:
    return lambda: Run(name, overrides).model()


def _drawn(kind: str, number: int, sticking: bool = False) -> Callable[[], Model]:
    return lambda: drawn(SEED, number, kind, sticking).model()


def _text(text: str) -> Callable[[], Model]:
    def scene() -> Model:
        from mdlgen.model.lower import lower
        from mdlgen.spec.load import loads

        return lower(loads(text))

    return scene


_PAPER = "paper: {E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.40 N*mm, D_cd: 0.24 N*mm}"
_LAW = "stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3"

STACK = f"""
name: stack
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {{{_PAPER}}}
sheets:
  low: {{material: paper, size: [60 mm, 80 mm], thickness: 0.1 mm, mass: 0.4 g, boxes: [3, 4],
    center: [0 mm, 0 mm, 0.05 mm]}}
  mid: {{material: paper, size: [60 mm, 80 mm], thickness: 0.1 mm, mass: 0.4 g, boxes: [3, 4],
    center: [1 mm, 0.5 mm, 0.155 mm], turn: 0.5 deg}}
  top: {{material: paper, size: [60 mm, 80 mm], thickness: 0.1 mm, mass: 0.4 g, boxes: [3, 4],
    center: [-0.5 mm, 1 mm, 0.26 mm], turn: -0.7 deg}}
planes: {{table: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 200 mm, 10 mm]}}}}
contacts:
  - {{between: [low, mid], {_LAW}}}
  - {{between: [mid, top], {_LAW}}}
  - {{between: [low, table], {_LAW}}}
run: {{duration: 20 ms}}
"""

AT_REST = f"""
name: at_rest
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {{{_PAPER}}}
sheets:
  note: {{material: paper, size: [60 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [8, 2],
    center: [0 mm, 0 mm, 0.05 mm]}}
  held: {{material: paper, size: [60 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [8, 2],
    center: [0 mm, 100 mm, 0 mm], clamp: {{edge: x_min}}}}
  leans: {{material: paper, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.2 g, boxes: [3, 2],
    center: [150 mm, 0 mm, 1.07 mm], rotation: [0 deg, 11.5 deg, 0 deg]}}
planes:
  slope: {{center: [150 mm, 0 mm, 0 mm], normal: [0.2, 0, 0.98], size: [100 mm, 100 mm, 2 mm]}}
  plane_1: {{center: [-25 mm, 0 mm, -5 mm], normal: z, size: [20 mm, 40 mm, 10 mm]}}
  plane_2: {{center: [25 mm, 0 mm, -5 mm], normal: z, size: [20 mm, 40 mm, 10 mm]}}
contacts:
  - {{between: [note, "plane_*"], {_LAW}}}
  - {{between: [leans, slope], {_LAW}}}
run: {{analysis: static}}
"""

BLOCK = """
name: block
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {p: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  block: {material: p, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 2 mm], rotation: [3 deg, 5 deg, 0 deg], velocity: [300 mm/s, 0 mm/s, -200 mm/s]}
planes: {table: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 200 mm, 10 mm]}}
contacts:
  - {between: [block, table], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 10 mm/s}
run: {duration: 15 ms}
"""

SCENES = (
    TuningScene("transport", "the sample `transport_4x4`", _sample("transport_4x4"), 2.0, 0.05),
    TuningScene("flat", "a sheet falls flat on a plane", _drawn("fall_flat", 3), 12.0, 0.1),
    TuningScene("tilted", "a tilted sheet falls on a plane", _drawn("fall_tilted", 1), 10.0, None),
    TuningScene("mesh", "a sheet falls on a mesh", _drawn("fall_mesh", 2), 25.0, 0.2),
    TuningScene("arm", "a nip with its roller on an arm", _drawn("nip_arm", 2), 5.0, 0.05),
    TuningScene("channel", "the sample `channel`", _sample("channel"), 2.0, None),
    TuningScene("stack", "three sheets on a table, asleep at the end", _text(STACK), 20.0, 0.1),
    TuningScene("sticking", "sheets slide, friction sticks", _drawn("slide", 3, True), 5.0, 0.1),
    TuningScene("air", "the sample `landing`, air between two sheets", _sample("landing"), 5.0, 0.1),
    TuningScene(
        "retard", "`retard_pad`, the pick roller overruns", _sample("retard_pad", ONE_WAY), 10.0, 0.05
    ),
    TuningScene("at rest", "sheets held, on two planes and on a slope", _text(AT_REST), None, None),
    TuningScene("block", "a rigid block falls and slides", _text(BLOCK), 8.0, None),
)
