"""What the user gave of how guides, planes and meshes move, and of stops."""

from __future__ import annotations

from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.tables import Parameter
from mdlgen.spec.moving import MovingPart, Pivot, PivotStops, Slide, SlideStops

Path = tuple[str | int, ...]


def moving_rows(name: str, part: MovingPart, base: tuple[str, str]) -> list[Parameter]:
    """Pivot, and corners of a profile but for the first place, which is 0; of one that stands nothing. Of one
    that forces move what turns or slides, its spring and its stops."""
    motion = part.moves
    if motion is None:
        return []
    turns = isinstance(motion, Pivot)
    path = (*base, "pivot" if turns else "slide")
    rows = _point(name, "a", "Pivot", motion.at, (*path, "at")) if isinstance(motion, Pivot) else []
    corners = motion.profile or ()
    for k, (time, place) in enumerate(corners if len(corners) > 1 else ()):
        at = (*path, "profile", k)
        rows.append(Parameter(name, f"t_{k}", f"Time of corner {k}", time, "ms", (*at, 0)))
        if k:
            what, unit = ("Angle at corner %d (deg)", "rad") if turns else ("Place at corner %d", "mm")
            rows.append(Parameter(name, f"q_{k}", what % k, place, unit, (*at, 1)))
    if isinstance(motion, Pivot) and motion.inertia is not None:
        rows += _turning(name, motion, path)
    if isinstance(motion, Slide) and motion.mass is not None:
        rows += _sliding(name, motion, path)
    return rows + stops_rows(name, motion.stops, (*path, "stops"))


def _turning(name: str, motion: Pivot, path: Path) -> list[Parameter]:
    rows = []
    if motion.center is not None:
        rows = _point(name, "g", "Centre of mass", motion.center, (*path, "center"))
    assert motion.inertia is not None, "it turns freely"
    stiff, damp = "Stiffness of its spring (N mm/rad)", "Damping of its pivot (N mm s/rad)"
    about = "Inertia about its pivot (kg mm2)"
    rows.append(Parameter(name, "I_q", about, motion.inertia, "g*mm^2", (*path, "inertia")))
    if not motion.sprung:
        return rows
    return [
        *rows,
        Parameter(name, "k_q", stiff, motion.stiffness, "N*mm/rad", (*path, "stiffness")),
        Parameter(name, "c_q", damp, motion.damping, "N*mm*ms/rad", (*path, "damping")),
        Parameter(name, "f_q", "Torque of its spring (N mm)", motion.torque, "N*mm", (*path, "torque")),
    ]


def _sliding(name: str, motion: Slide, path: Path) -> list[Parameter]:
    assert motion.mass is not None, "it slides freely"
    damp = "Damping of its slide (N s/mm)"
    mass = Parameter(name, "M_q", "Mass of all that slides", motion.mass, "g", (*path, "mass"))
    if not motion.sprung:
        return [mass]
    return [
        mass,
        Parameter(name, "k_q", "Stiffness of its spring", motion.stiffness, "N/mm", (*path, "stiffness")),
        Parameter(name, "c_q", damp, motion.damping, "N*ms/mm", (*path, "damping")),
        Parameter(name, "f_q", "Force of its spring (N)", motion.force, "N", (*path, "force")),
    ]


def stops_rows(name: str, stops: PivotStops | SlideStops | None, path: Path) -> list[Parameter]:
    """Both ends of a motion, and what stops it there."""
    if stops is None:
        return []
    turns = isinstance(stops, PivotStops)
    unit, shown = ("rad", " (deg)") if turns else ("mm", "")
    stiff = "N*mm/rad" if turns else "N/mm"
    label = "Stiffness of its stops" + (" (N mm/rad)" if turns else "")
    return [
        Parameter(name, "e_lo", f"Lower stop{shown}", stops.low, unit, (*path, "low")),
        Parameter(name, "e_hi", f"Upper stop{shown}", stops.high, unit, (*path, "high")),
        Parameter(name, "k_e", label, stops.stiffness, stiff, (*path, "stiffness")),
        Parameter(
            name, "c_e", "Restitution c_R of its stops", stops.restitution, "1", (*path, "restitution")
        ),
    ]


def _point(name: str, start: str, label: str, place: tuple[float, ...], path: Path) -> list[Parameter]:
    return [
        Parameter(name, f"{start}_{axis}", f"{label} {axis}", place[k], "mm", (*path, k))
        for k, axis in enumerate(NAMED_AXES)
    ]
