"""The scene as an engineer writes it in Exudyn by hand, with Exudyn's own items only.

Boxes are rigid bodies, bushings ObjectConnectorRigidBodySpringDamper; for contact see exudyn_contact.py.
Nothing of our force laws or of backends/exudyn_local is used. SI units: m, kg, s, N.
"""

from __future__ import annotations

import time
from importlib import import_module
from typing import Any

import numpy as np

from mdlgen.backend import Backend
from mdlgen.bench.peers.exudyn_contact import GRAM, MM, MS, contacts
from mdlgen.bench.peers.scene import Motion, anchor, check
from mdlgen.model.tables import Model, RollerPart
from mdlgen.results.result import Result

# the Model's N/mm, N mm/rad, N ms/mm and N mm ms/rad in SI, for three shifts and three turns
STIFFNESS = np.repeat((1e3, 1e-3), 3)
DAMPING = np.repeat((1.0, 1e-6), 3)
STEP = 0.05  # [ms], where none is given
# Newton's iteration ends at the round-off of k x; Exudyn's own 1e-10 lies below it, and fails.
ABSOLUTE = 1e-8
# At Exudyn's own 1e-8 it takes a third longer, and the error against the reference does not change.
RELATIVE = 1e-6


def solve(model: Model, progress: Any = None, step: float | None = None) -> Result:
    """Run it. Raises RefusedError for a scene that the script does not hold."""
    check(model, "the Exudyn script")
    exu = import_module("exudyn")
    exu.special.userInterface.SuppressAll(True)
    began = time.perf_counter()
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    boxes = _boxes(mbs, model)
    sensors = _sensors(mbs, boxes)
    _bushings(mbs, model, boxes)
    rollers = {roller.name: _roller(mbs, model, roller, ground) for roller in model.rollers}
    contacts(mbs, model, boxes, rollers, ground)
    mbs.Assemble()
    built = time.perf_counter() - began

    dt = step or model.run.step or STEP
    status, began = "ok", time.perf_counter()
    try:
        mbs.SolveDynamic(_settings(model, dt))
    except exu.SolverError as error:
        status = "Exudyn: " + " ".join(str(error).split())[:200]
    wall = time.perf_counter() - began
    stored = [np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    times, positions = stored[0][:, 0] / MS, np.stack([one[:, 1:] for one in stored], axis=1) / MM
    # the solver also says that it is done after a time-out
    if status == "ok" and not (times[-1] > model.run.duration - dt and np.isfinite(positions).all()):
        status = f"Exudyn ended at {times[-1]:g} ms"
    steps = mbs.sys["dynamicSolver"].it.currentStepIndex
    return Motion(times, positions, dt, steps, wall, built).result(model, "exudyn-script", status)


def _settings(model: Model, dt: float) -> Any:
    exu = import_module("exudyn")
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = model.run.print_step * MS
    settings.timeIntegration.numberOfSteps = round(model.run.duration / dt)
    settings.timeIntegration.endTime = model.run.duration * MS
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.newton.absoluteTolerance = ABSOLUTE
    settings.timeIntegration.newton.relativeTolerance = RELATIVE
    # a contact that starts or ends within a step is iterated; the step is halved only where that fails
    settings.timeIntegration.discontinuous.useRecommendedStepSize = False
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.parallel.numberOfThreads = 1
    return settings


def _boxes(mbs: Any, model: Model) -> list[Any]:
    inertia = import_module("exudyn.utilities").RigidBodyInertia
    bodies = model.bodies
    return [
        mbs.CreateRigidBody(
            referencePosition=bodies.position[row] * MM,
            inertia=inertia(bodies.mass[row] * GRAM, np.diag(bodies.inertia[row]) * GRAM * MM**2),
            gravity=model.gravity * MM / MS**2,
        )
        for row in range(model.sheets[0].count)
    ]


def _sensors(mbs: Any, boxes: list[Any]) -> list[Any]:
    sensor = import_module("exudyn.itemInterface").SensorBody
    what = import_module("exudyn").OutputVariableType.Position
    return [
        mbs.AddSensor(sensor(bodyNumber=box, storeInternal=True, writeToFile=False, outputVariableType=what))
        for box in boxes
    ]


def _bushings(mbs: Any, model: Model, boxes: list[Any]) -> None:
    """In Exudyn's default formulation; the intrinsic one takes twice as long for the same error."""
    item = import_module("exudyn.itemInterface")
    table, centers = model.bushings, model.bodies.position
    for row in range(len(table)):
        arms = [(box, (table.origin[row] - centers[box]) * MM) for box in (table.a[row], table.b[row])]
        mbs.AddObject(
            item.ObjectConnectorRigidBodySpringDamper(
                markerNumbers=[
                    mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=boxes[box], localPosition=arm))
                    for box, arm in arms
                ],
                stiffness=np.diag(table.k[row] * STIFFNESS),
                damping=np.diag(table.c[row] * DAMPING),
            )
        )


def _roller(mbs: Any, model: Model, roller: RollerPart, ground: Any) -> Any:
    """A roller whose local z axis is its own, so that it turns about the last angle without end."""
    item = import_module("exudyn.itemInterface")
    moments = (roller.inertia_transverse, roller.inertia_transverse, roller.inertia_axial)
    inertia = import_module("exudyn.utilities").RigidBodyInertia
    made = mbs.CreateRigidBody(
        referencePosition=model.bodies.position[roller.body] * MM,
        referenceRotationMatrix=[[1, 0, 0], [0, 0, 1], [0, -1, 0]],
        inertia=inertia(roller.mass * GRAM, np.diag(moments) * GRAM * MM**2),
        gravity=model.gravity * MM / MS**2,
        nodeType=import_module("exudyn").NodeType.RotationRxyz,
        returnDict=True,
    )
    still = mbs.AddNode(item.NodePointGround())
    fixed = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=still, coordinate=0))
    held: dict[int, dict[str, Any]] = {0: {}, 1: {}, 3: {}, 4: {}}
    if roller.press is None:
        held[2] = {}
    if roller.speed is not None:
        held[5] = {"offsetUserFunction": _turned(roller)}
    for coordinate, options in held.items():
        marker = item.MarkerNodeCoordinate(nodeNumber=made["nodeNumber"], coordinate=coordinate)
        mbs.AddObject(item.CoordinateConstraint(markerNumbers=[fixed, mbs.AddMarker(marker)], **options))
    if roller.press is not None:
        end, length = anchor(roller)
        ends = [(ground, end * MM), (made["bodyNumber"], (0.0, 0.0, 0.0))]
        mbs.AddObject(
            item.SpringDamper(
                markerNumbers=[
                    mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=at))
                    for body, at in ends
                ],
                stiffness=roller.press.stiffness * STIFFNESS[0],
                damping=roller.press.damping * DAMPING[0],
                referenceLength=length * MM,
            )
        )
    return made["bodyNumber"]


def _turned(roller: RollerPart) -> Any:
    """The angle of a driven roller over time: a linear ramp to its speed."""
    speed, ramp = (roller.speed or 0.0) * roller.axis[1] / MS, roller.ramp * MS

    def angle(mbs: Any, t: float, item: int, offset: float) -> float:
        return speed * (t * t / (2 * ramp) if t < ramp else t - ramp / 2)

    return angle


BACKEND = Backend(solve=solve)
