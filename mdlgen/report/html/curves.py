"""The figures of the page as numbers: lines over time, as in the paper, or over a sheet's length."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from mdlgen.model.tables import Floats, Ints, RollerPart
from mdlgen.report.animation import thinned
from mdlgen.results.compare import travel
from mdlgen.results.drag import drags
from mdlgen.results.gates import shown
from mdlgen.results.losses import driven, summed
from mdlgen.results.result import Result
from mdlgen.results.slide import slide
from mdlgen.results.strain import SheetJoints
from mdlgen.results.summary_of_parts import part_rows
from mdlgen.results.swing import swing
from mdlgen.results.torques import drive_power, drive_torque, grips, over_time
from mdlgen.units import PER_SECOND

POINTS = 4000  # of a line; more are not seen


@dataclass(frozen=True)
class Line:
    name: str
    x: Floats
    y: Floats


@dataclass
class Panel:
    """Lines that share two axes."""

    key: str  # the same in every run
    title: str
    unit: str
    short: str = field(default="", kw_only=True)  # its name next to a part, in words; else its key
    lines: list[Line] = field(default_factory=list)
    x_title: str = "time [ms]"
    note: str = ""
    equal: bool = False  # one scale for both axes
    least: float = 1e-6  # the smallest range that is drawn: round-off is not shown as if it were a pattern


def panels(
    result: Result, at: Ints, deep: Floats, joints: tuple[SheetJoints, Floats, Floats] | None
) -> list[Panel]:
    """The figures of a run.

    `deep` is what `boxes.contact` gives at the states `at`, (t, rows), `joints` what `strain.histories`
    gives there.
    """
    if result.model.run.analysis == "static" or len(result.time) < 2:
        return [panel for panel in (*_shapes(result), *_tensions(result)) if panel.lines]
    found = [*_motion(result), *_tilt(result, at), *_rollers(result, at, deep), *_drags(result)]
    found += _energies(result)
    found += [*_tensions(result), *_bearing(result, at, joints)]
    return [panel for panel in found if panel.lines]


def _thin(result: Result) -> Ints:
    """Indices of the stored states that are drawn, for quantities known at all of them."""
    every = max(1, -(-len(result.time) // POINTS))
    return thinned(len(result.time), every)


def _motion(result: Result) -> list[Panel]:
    """Displacement, speed, drift and yaw of each sheet's centre of mass, and the probes' displacement."""
    thin = _thin(result)
    time = result.time[thin]
    moved = Panel("displacement", "Displacement of the sheet's centre of mass", "mm")
    speed = Panel("speed", "Speed of the sheet's centre of mass", "mm/s")
    drift = Panel("drift", "Drift across the way of travel", "mm")
    yaw = Panel("yaw", "Yaw", "deg")
    for k, sheet in enumerate(result.model.sheets):
        place, rate, turned = result.sheet_motion(k)
        place = place - place[0] + travel(result, k, at=0)
        for axis, name in enumerate("xyz"):
            moved.lines.append(Line(f"{sheet.name} {name}", time, place[thin, axis]))
            speed.lines.append(Line(f"{sheet.name} {name}", time, rate[thin, axis] * PER_SECOND))
        side = _across(result, k, place[-1])
        if side is not None:
            drift.lines.append(Line(sheet.name, time, (place @ side)[thin]))
        yaw.lines.append(Line(sheet.name, time, np.degrees(turned[thin])))
    drift.note = "positive to the left of the way, seen from the side the sheet's normal points to"
    return [moved, speed, drift, yaw]


def _across(result: Result, sheet: int, way: Floats) -> Floats | None:
    """Unit vector in the first plane of a sheet, to the left of where it went; None where it stayed."""
    normal = result.model.sheets[sheet].rotation[:, 2]
    side = np.cross(normal, way)
    size = float(np.linalg.norm(side))
    return side / size if size > 1e-9 else None


def _tilt(result: Result, at: Ints) -> list[Panel]:
    """Tilt of the mean normal of a sheet's boxes, by their mass, along its first x and y axes."""
    from mdlgen.model.rotations import column

    panel = Panel("tilt", "Tilt of the sheet", "deg")
    panel.note = "of the mean normal of its boxes, about the sheet's y axis (pitch) and x axis (roll)"
    for k, sheet in enumerate(result.model.sheets):
        boxes = np.arange(sheet.first, sheet.first + sheet.count)
        normals = column(result.rotation[np.ix_(at, boxes)], 2)
        normal = result.model.mass_share(k) @ normals @ sheet.rotation
        for name, angle in (
            ("pitch", np.arctan2(normal[:, 0], normal[:, 2])),
            ("roll", np.arctan2(-normal[:, 1], normal[:, 2])),
        ):
            panel.lines.append(Line(f"{sheet.name} {name}", result.time[at], np.degrees(angle)))
    return [panel]


def _rollers(result: Result, at: Ints, deep: Floats) -> list[Panel]:
    """Nip forces, penetrations by sheets and speeds, each by roller; of spring plates where they are, too."""
    thin = _thin(result)
    plates = result.model.plates
    each = "each roller and spring plate" if plates else "each roller"
    force = Panel("force", f"Normal force on {each}", "N")
    depth = Panel("penetration", f"Penetration of sheets into {each}", "mm")
    place = Panel("slide", f"Way of {each} that is pressed along its press direction", "mm", short="way")
    place.note = "from where it is given; it falls as a sheet lifts the part"
    arms = Panel("arm", "Angle of each arm", "deg", short="arm")
    arms.note = "since it was given, positive about the roller's axis"
    spin = Panel("omega", "Speed of each roller", "rad/s", short="speed")
    depth.note = "of the deepest box at stored states; the table has the greatest over every step"
    for part in (*result.model.rollers, *(plate for plate, _ in plates)):
        rows = list(part_rows(result, part))
        sheets = [k for k in rows if not result.model.contacts.of_machine[k]]
        if rows:
            y = result.contact_force[:, rows].sum(axis=1)
            force.lines.append(Line(part.name, result.time[thin], y[thin]))
        if sheets:
            depth.lines.append(Line(part.name, result.time[at], deep[:, sheets].max(axis=1)))
        way = slide(result, part)
        if way is not None:
            place.lines.append(Line(part.name, result.time[thin], way[thin]))
    for roller in result.model.rollers:
        turned = swing(result, roller)
        if turned is not None:
            arms.lines.append(Line(roller.name, result.time[thin], np.degrees(turned[thin])))
        omega = result.spin[:, roller.body] @ roller.axis * PER_SECOND
        spin.lines.append(Line(roller.name, result.time[thin], omega[thin]))
    return [force, depth, place, arms, *_gates(result, thin), spin, *_drives(result, thin)]


def _gates(result: Result, thin: Ints) -> list[Panel]:
    """Places of parts that turn about a pivot or slide."""
    angles = Panel("pivot", "Angle of each part about its pivot", "deg", short="pivot")
    ways = Panel("gate", "Way of each part along its slide", "mm", short="slide")
    for part, moving in result.model.gates:
        found = shown(result, part)
        if found is not None:
            panel = angles if moving.turns else ways
            panel.lines.append(Line(part.name, result.time[thin], found[1][thin]))
    for panel in (angles, ways):
        panel.note = "from where it is given"
    return [angles, ways]


def _drives(result: Result, thin: Ints) -> list[Panel]:
    """Torque and power of each drive, and the used part of the grip of sheets on each roller."""
    torque = Panel("torque", "Torque of each drive", "N mm")
    torque.note = "about the roller's axis: what contacts and its inertia take"
    power = Panel("power", "Power of each drive", "W")
    traction = Panel("traction", "Used part of the grip of sheets on each roller", "%", short="grip used")
    traction.note = "friction along the surface over the most that it can be, mu times the normal force"
    sheets = {sheet.name for sheet in result.model.sheets}
    for roller in result.model.rollers:
        for panel, found in ((torque, drive_torque), (power, drive_power)):
            values = found(result, roller) if roller.driven else None
            if values is not None:
                panel.lines.append(Line(roller.name, result.time[thin], values[thin]))
        for grip in grips(result, roller):
            if grip.other in sheets and np.isfinite(grip.used).any():
                name = roller.name if len(sheets) == 1 else f"{roller.name} {grip.other}"
                traction.lines.append(Line(name, result.time[thin], 100.0 * np.nan_to_num(grip.used[thin])))
    return [torque, power, traction]


def _drags(result: Result) -> list[Panel]:
    """Friction drag of planes, guides and fixed meshes on sheets."""
    thin = _thin(result)
    panel = Panel("drag", "Drag of each plane and guide on sheets", "N")
    panel.note = "friction, summed over contact points"
    several = len(result.model.sheets) > 1
    for part in result.model.machine:
        for sheet, drag in drags(result, part).items():
            if drag.any():
                name = f"{part.name} {sheet}" if several else part.name
                panel.lines.append(Line(name, result.time[thin], drag[thin]))
    return [panel]


def _energies(result: Result) -> list[Panel]:
    """Energy that drives have put in since the start, and that contacts took by friction and rolling."""
    given = Panel("driven_energy", "Energy that each drive has given", "N mm", short="driven")
    rubbed = Panel("friction_loss", "Energy lost at each part by friction and rolling", "N mm", short="lost")
    rubbed.note = "at its contacts with sheets, and half of what is between two parts; from stored states"
    if result.losses is None:
        return []
    thin = _thin(result)
    for part in result.model.machine:
        energy = driven(result, part) if isinstance(part, RollerPart) else None
        if energy is not None:
            given.lines.append(Line(part.name, result.time[thin], energy[thin]))
        if (power := result.losses.of(result, part)) is not None and power.any():
            rubbed.lines.append(Line(part.name, result.time[thin], summed(result, power)[thin]))
    return [given, rubbed]


def _tensions(result: Result) -> list[Panel]:
    """Tension of each sheet along its way: its extremes over time, and over its length."""
    thin = _thin(result)
    extremes = Panel("tension", "Tension of the sheet along its way, greatest and least of its sections", "N")
    extremes.note = "membrane force over a section across the way, positive where it is pulled"
    places = Panel("tension along", "Tension over the sheet's length", "N")
    places.x_title = "place along the way from the sheet's centre [mm]"
    places.note = "of each section across the way" + (
        ": the greatest and least of the run, and its mean" if len(result.time) > 1 else ""
    )
    for sheet, tension in zip(result.model.sheets, result.tensions, strict=True):
        if tension is None or not tension.force.any():
            continue
        if len(result.time) < 2:
            places.lines.append(Line(sheet.name, tension.at, tension.force[-1]))
            continue
        for name, values in (("greatest", tension.greatest), ("least", tension.least)):
            extremes.lines.append(Line(f"{sheet.name} {name}", result.time[thin], values[thin]))
        means = np.array([over_time(result, values) for values in tension.force.T])
        for name, values in (
            ("greatest", tension.force.max(axis=0)),
            ("mean", means),
            ("least", tension.force.min(axis=0)),
        ):
            places.lines.append(Line(f"{sheet.name} {name}", tension.at, values))
    return [extremes, places]


def _bearing(result: Result, at: Ints, joints: tuple[SheetJoints, Floats, Floats] | None) -> list[Panel]:
    """The greatest strain and curvature of each sheet over time, along x (MD) and y (CD)."""
    if joints is None:
        return []
    kinds = (
        Panel("strain", "Greatest membrane strain of the joints", "-", least=1e-9),
        Panel("curvature", "Greatest curvature of the joints", "1/mm", least=1e-9),
    )
    table = joints[0]
    for index, sheet in enumerate(result.model.sheets):
        for axis, way in enumerate(("MD", "CD")):
            mine = (table.sheet == index) & (table.axis == axis)
            if mine.any():
                values = joints[1][:, mine].max(axis=1), np.abs(joints[2][:, mine]).max(axis=1)
                for panel, y in zip(kinds, values, strict=True):
                    panel.lines.append(Line(f"{sheet.name} {way}", result.time[at], y))
    return list(kinds)


def _shapes(result: Result) -> list[Panel]:
    """Box centres of each sheet from the side, along its longer side, before and after."""
    found = []
    for sheet in result.model.sheets:
        mine = slice(sheet.first, sheet.first + sheet.count)
        axis = 0 if sheet.outline[0] > sheet.outline[1] else 1
        name = ("x (MD)", "y (CD)")[axis]
        panel = Panel(f"shape {sheet.name}", f"{sheet.name}: box centres from the side", "mm", equal=True)
        panel.x_title = f"along the sheet's {name} [mm]"
        panel.note = "normal to the sheet, over its length; every strip of boxes"
        for label, places in (
            ("before", result.model.bodies.position[mine]),
            ("after", result.position[-1, mine]),
        ):
            grid = ((places - sheet.center) @ sheet.rotation).reshape(sheet.n_y, sheet.n_x, 3)
            for strip in grid if axis == 0 else grid.swapaxes(0, 1):
                panel.lines.append(Line(label, strip[:, axis], strip[:, 2]))
        found.append(panel)
    return found
