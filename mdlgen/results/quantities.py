"""The quantities for which the error of a run is estimated: each with its name, norm, unit and scale.

A name is the quantity's place in summary.json without its unit: `sheets.note.position`,
`rollers.counter.slide`, `contacts.note.motor.max_force`. A difference of two runs is relative to the
quantity's scale, which never is zero; what its motion is small against is stated at each.

| quantity | norm | scale |
|---|---|---|
| `sheets.S.position` | RMS over boxes, by mass, and stored times of the distance | the sheet's travel, at least a tenth of its length [mm] |
| `sheets.S.orientation`, of one box | RMS over stored times of the angle, times half its diagonal | the same [mm] |
| `rollers.R.slide`, `planes.P.slide` | RMS over stored times | range of the way, at least a tenth of the radius, of a plate of its thickness [mm] |
| `rollers.R.angle`, of an arm | RMS over stored times | range of the angle, at least what moves the roller by a tenth of its radius [rad] |
| `rollers.R.omega`, of one that may turn | RMS over stored times | greatest speed, at least a tenth of a radian in the run [rad/ms] |
| `probes.P.displacement` | RMS over stored times of the distance | greatest displacement, at least a tenth of the sheet's length [mm] |
| `sensors.S.times` | greatest difference of a time at which it is covered or cleared; 1 where one run has more of them | the duration [ms] |
| `contacts.A.B.force` | mean over stored times of the difference | mean force [N] |
| `contacts.A.B.max_force`, `.mean_force`, `.max_penetration`, `.mean_penetration` | difference, of all steps, and not less than that over stored times, at any of them or in the mean | the value, at least a hundredth of the greatest of all contacts [N], [mm] |
| `sheets.S.strain.max_md` (`min_md`, `max_cd`, `min_cd`), `.curvature.max_md` (`max_cd`), `.twist.max` | greatest difference of any joint at any stored time | the greatest of the sheet in size, at least 1e-6; 1e-3 over its length for bending and twist [1/mm] |
| `sheets.S.residual.curvature`, of one that may yield | the same of what its joints keep | the greatest at the end, at least 1e-3 over its length [1/mm] |

`run.tolerance` judges positions and orientations by these scales; slides and angles by theirs, but not less than
the greatest travel or tenth of a length of any sheet, which is what positions of the scene are relative to.
"""  # noqa: E501

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import Floats, Ints, MachinePart, MovingPart, PlanePart, RollerPart
from mdlgen.results.gates import place
from mdlgen.results.residual import left
from mdlgen.results.result import Result
from mdlgen.results.strain import apart, sheet_joints

# Stored times that differ by less than this part of the run are the same; they differ by round-off.
SAME_TIME = 1e-9
# Least scale of a motion, as a part of a length, radius, thickness or turn.
TENTH = 0.1
# Part of the greatest force or penetration; below it a force or depth is not used as a scale.
GRAZE = 0.01
LEAST_STRAIN, LEAST_BEND = 1e-6, 1e-3
# Exponent of force over depth.
EXPONENT = 1.5
LEAST = 1e-300


@dataclass(frozen=True)
class Difference:
    """Difference of two runs in one quantity."""

    name: str
    value: float  # relative to the scale
    scale: float
    unit: str  # of the scale
    judged: float | None = None  # scale by which run.tolerance judges it; None: it does not
    plain: float | None = None  # of the one number that is reported, where `value` bounds it; else the same

    @property
    def kind(self) -> str:
        """The kind of quantity: `strain`, `curvature`, `twist`, `contacts.max_force`, `rollers.slide`, ..."""
        head, *_, one, two = self.name.split(".")
        return one if one in ("strain", "curvature", "twist", "residual") else f"{head}.{two}"

    @property
    def reported(self) -> float:
        """The difference of the reported number, relative to the scale."""
        return self.value if self.plain is None else self.plain


class Pair:
    """Two results of one scene at the stored times that both have, or cover."""

    def __init__(self, result: Result, other: Result):
        self.result, self.other = result, other
        slack = SAME_TIME * max(float(result.time[-1]), LEAST)
        at = np.searchsorted(other.time, result.time - slack)
        there = at < len(other.time)
        there[there] &= np.abs(other.time[at[there]] - result.time[there]) <= slack
        # where both have states they are not interpolated
        self.here: Ints = np.flatnonzero(there)
        self.there: Ints = at[self.here]
        self.whole = bool(len(result.time)) and bool(len(other.time)) and self._ends(slack)

    def _ends(self, slack: float) -> bool:
        return abs(float(self.result.time[-1] - self.other.time[-1])) <= slack

    def apart(self, bodies: slice | int) -> Floats:
        """Position of bodies in the first run minus that in the second [mm], (t, bodies, 3); one: (t, 3)."""
        return self.result.position[self.here, bodies] - self.other.position[self.there, bodies]


def differences(result: Result, other: Result, judged: bool = False) -> dict[str, Difference]:
    """The differences by name; or only those that `run.tolerance` judges, which are quick to compute.

    Empty where the two do not end at the same time.
    """
    pair = Pair(result, other)
    if not pair.whole:
        return {}
    parts = [_sheets(pair), _pressed(pair)]
    if not judged:
        parts += [
            _speeds(pair),
            _probes(pair),
            _contacts(pair),
            _peaks(pair),
            _residual(pair),
            _sensors(pair),
        ]
    return {found.name: found for part in parts for found in part}


def all_names(result: Result) -> list[str]:
    """Names of all quantities of a scene, of contacts that are not touched, too; any result of it will do."""
    contacts = zip(result.model.contacts.part_a, result.model.contacts.part_b, strict=True)
    message = ("force", "max_force", "mean_force", "max_penetration", "mean_penetration")
    named = [f"contacts.{a}.{b}.{name}" for a, b in contacts for name in message]
    return list(dict.fromkeys([*differences(result, result), *named]))


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(np.square(values)))) if values.size else 0.0


def reference(result: Result) -> float:
    """Length that positions are relative to [mm]: greatest travel of a sheet, or a tenth of its length."""
    return max(found.scale for found in _sheets(Pair(result, result)) if found.kind == "sheets.position")


def _sheets(pair: Pair) -> Iterator[Difference]:
    model = pair.result.model
    for k, sheet in enumerate(model.sheets):
        boxes = slice(sheet.first, sheet.first + sheet.count)
        share = model.mass_share(k)
        start = model.bodies.position[boxes]
        travel = float(np.linalg.norm(share @ (pair.result.position[-1, boxes] - start)))
        scale = max(travel, TENTH * max(sheet.size))
        square = share @ np.mean(np.square(pair.apart(boxes)).sum(axis=2), axis=0)
        yield Difference(f"sheets.{sheet.name}.position", float(np.sqrt(square)) / scale, scale, "mm", scale)
        if sheet.count == 1 and not model.bodies.fixed[sheet.first]:
            angle = angles(
                pair.result.rotation[pair.here, sheet.first], pair.other.rotation[pair.there, sheet.first]
            )
            lever = float(np.linalg.norm(model.bodies.half[sheet.first]))
            yield Difference(
                f"sheets.{sheet.name}.orientation", lever * _rms(angle) / scale, scale, "mm", scale
            )


def angles(one: Floats, other: Floats) -> Floats:
    """Angle [rad] of the rotation between Euler parameters (..., 4), at most half a turn, (...,)."""
    sign = np.where((one * other).sum(axis=-1) < 0.0, -1.0, 1.0)
    return 4.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(one - sign[..., None] * other, axis=-1), 1.0))


def swing(result: Result, roller: RollerPart) -> Floats:
    """Angle of a roller's arm since the start of the run [rad], (t,)."""
    assert roller.arm is not None, "asked only of a roller on an arm"
    first = roller.center - roller.arm.pivot
    first = first - (first @ roller.axis) * roller.axis
    side = np.cross(roller.axis, first)
    way = result.position[:, roller.body] - roller.arm.pivot
    return np.unwrap(np.arctan2(way @ side, way @ first))


def _pressed(pair: Pair) -> Iterator[Difference]:
    """Slides of rollers and plates, and angles of arms."""
    result = pair.result
    parts: list[tuple[str, RollerPart | PlanePart]] = [("rollers", roller) for roller in result.model.rollers]
    parts += [("planes", plate) for plate, _ in result.model.plates]
    whole = reference(result)
    for kind, part in parts:
        if isinstance(part, RollerPart) and part.arm is not None:
            one, two = swing(result, part), swing(pair.other, part)
            reach = float(np.linalg.norm(np.cross(part.axis, part.center - part.arm.pivot)))
            scale = max(float(np.ptp(one)), TENTH * part.radius / reach)
            gap = one[pair.here] - two[pair.there]
            judged = max(scale, whole / reach)
            yield Difference(f"{kind}.{part.name}.angle", _rms(gap) / scale, scale, "rad", judged)
        elif part.press is not None:
            way = result.position[:, part.body] @ part.press.direction
            size = part.radius if isinstance(part, RollerPart) else part.size[2]
            scale = max(float(np.ptp(way)), TENTH * size)
            gap = pair.apart(part.body) @ part.press.direction
            judged = max(scale, whole)
            yield Difference(f"{kind}.{part.name}.slide", _rms(gap) / scale, scale, "mm", judged)
    for part, moving in result.model.gates:
        if moving.free:
            yield _free(pair, part, moving, whole)


def _free(pair: Pair, part: MachinePart, moving: MovingPart, whole: float) -> Difference:
    """Angle or way of a part that turns about a pivot, or slides, as forces move it."""
    one, two = place(pair.result, part), place(pair.other, part)
    assert one is not None and two is not None, "asked of parts that move"
    kind = kind_of(part)
    block = kind.blocks(part)
    thin = float(np.linalg.norm(block[0, [1, 2, 4]] - block[0, 0], axis=1).min())
    reach = 1.0
    if moving.turns:
        arms = block.reshape(-1, 3) - moving.pivot
        reach = float(np.linalg.norm(np.cross(arms, moving.axis), axis=1).max())
    scale = max(float(np.ptp(one)), TENTH * thin / reach)
    gap = one[pair.here] - two[pair.there]
    what, unit = ("angle", "rad") if moving.turns else ("slide", "mm")
    name = f"{kind.table}.{part.name}.{what}"
    return Difference(name, _rms(gap) / scale, scale, unit, max(scale, whole / reach))


def _speeds(pair: Pair) -> Iterator[Difference]:
    result = pair.result
    for roller in result.model.rollers:
        if roller.turns:
            one, two = (run.spin[:, roller.body] @ roller.axis for run in (result, pair.other))
            scale = max(float(np.abs(one).max()), TENTH / max(result.model.run.duration, LEAST))
            gap = one[pair.here] - two[pair.there]
            yield Difference(f"rollers.{roller.name}.omega", _rms(gap) / scale, scale, "rad/ms")


def _sensors(pair: Pair) -> Iterator[Difference]:
    """Times at which sensors changed; all of the run where they changed another number of times."""
    scale = max(pair.result.model.run.duration, LEAST)
    for sensor in pair.result.model.reactions.sensors:
        one, two = (
            np.array([row["time_ms"] for row in run.reactions if row.get("sensor") == sensor.name])
            for run in (pair.result, pair.other)
        )
        apart = float(np.abs(one - two).max(initial=0.0)) / scale if len(one) == len(two) else 1.0
        yield Difference(f"sensors.{sensor.name}.times", apart, scale, "ms")


def _probes(pair: Pair) -> Iterator[Difference]:
    model = pair.result.model
    for k, probe in enumerate(model.probes):
        one, two = pair.result.anchor_motion(k)[0], pair.other.anchor_motion(k)[0]
        start = sum(
            share * (model.bodies.position[body] + model.bodies.rotation[body] @ local)
            for body, local, share in zip(probe.body, probe.local, probe.share, strict=True)
        )
        far = float(np.linalg.norm(one - start, axis=1).max())
        scale = max(far, TENTH * max(model.sheets[probe.sheet].size))
        gap = np.linalg.norm(one[pair.here] - two[pair.there], axis=1)
        yield Difference(f"probes.{probe.name}.displacement", _rms(gap) / scale, scale, "mm")


def _contacts(pair: Pair) -> Iterator[Difference]:
    """Differences of contacts that touched in one of the two runs.

    The difference of two numbers may vanish by accident where it changes its sign with the step. So the
    difference of a mean is at least the mean of the differences, and that of a peak at least the one at any
    stored time. That of a depth is at least the difference that follows from forces by F ~ depth^1.5.
    """
    result, other = pair.result, pair.other
    contacts, statistics = result.model.contacts, result.statistics
    means = result.contact_force.mean(axis=0)
    touched = (statistics.max_force > 0.0) | (other.statistics.max_force > 0.0)
    one, two = result.contact_force[pair.here], other.contact_force[pair.there]
    for row in np.flatnonzero(touched).tolist():
        name = f"contacts.{contacts.part_a[row]}.{contacts.part_b[row]}"
        scale = max(float(means[row]), GRAZE * float(means.max(initial=0.0)), LEAST)
        over_time = float(np.abs(one[:, row] - two[:, row]).mean()) / scale
        yield Difference(f"{name}.force", over_time, scale, "N")
        greatest = max(float(statistics.max_force[row]), GRAZE * float(statistics.max_force.max()), LEAST)
        at_once = float(np.abs(one[:, row] - two[:, row]).max()) / greatest
        for message, attribute, unit, least in (
            ("max_force", "max_force", "N", at_once),
            ("mean_force", "mean_force", "N", over_time),
            ("max_penetration", "max_depth", "mm", at_once / EXPONENT),
            ("mean_penetration", "mean_depth", "mm", over_time / EXPONENT),
        ):
            a, b = (getattr(run.statistics, attribute) for run in (result, other))
            scale = max(float(a[row]), GRAZE * float(a.max()), LEAST)
            plain = abs(float(a[row] - b[row])) / scale
            yield Difference(f"{name}.{message}", max(plain, least), scale, unit, plain=plain)


def _peaks(pair: Pair) -> Iterator[Difference]:
    """Differences in the load of the joints of sheets: the greatest of any joint at any stored time."""
    model = pair.result.model
    one, two = pair.result.strains, pair.other.strains
    found = apart(pair.result, pair.other, pair.here, pair.there)
    if one is None or two is None or found is None:
        return
    joints, (stretch, squeeze, curvature, twist) = found
    for k, sheet in enumerate(model.sheets):
        mine = joints.sheet == k
        ways = [(way, mine & (joints.axis == axis)) for axis, way in enumerate(("md", "cd"))]
        bend = LEAST_BEND / max(sheet.size)
        for kind, message, attribute, unit, least, gap, extreme in (
            ("strain", "max_", "stretch", "", LEAST_STRAIN, stretch, np.max),
            ("strain", "min_", "squeeze", "", LEAST_STRAIN, squeeze, np.min),
            ("curvature", "max_", "curvature", "1/mm", bend, curvature, _size),
            ("twist", "max", "twist", "1/mm", bend, twist, _size),
        ):
            a, b = (getattr(run, attribute).value for run in (one, two))
            scale = max(float(np.abs(a[mine]).max(initial=0.0)), least)
            for way, rows in ways if kind != "twist" else [("", mine)]:
                if rows.any():
                    name = f"sheets.{sheet.name}.{kind}.{message}{way}"
                    plain = abs(float(extreme(a[rows]) - extreme(b[rows]))) / scale
                    yield Difference(name, float(gap[rows].max()) / scale, scale, unit, plain=plain)


def _residual(pair: Pair) -> Iterator[Difference]:
    """Differences in the residual curvature of sheets: the greatest of any joint at any stored time."""
    one, two = left(pair.result), left(pair.other)
    if one is None or two is None:
        return
    joints = sheet_joints(pair.result.model)
    for k, sheet in enumerate(pair.result.model.sheets):
        mine = joints.sheet == k
        scale = max(float(np.abs(one[-1:, mine]).max(initial=0.0)), LEAST_BEND / max(sheet.size))
        gap = np.abs(one[pair.here][:, mine] - two[pair.there][:, mine]).max(initial=0.0)
        plain = abs(_size(one[-1:, mine]) - _size(two[-1:, mine])) / scale
        name = f"sheets.{sheet.name}.residual.curvature"
        yield Difference(name, float(gap) / scale, scale, "1/mm", plain=plain)


def _size(values: Floats) -> float:
    """Greatest magnitude of the values. A summary reports it for bending and twist, of either sign: the two
    sides of a symmetric sheet twist in opposite directions by the same amount."""
    return float(np.abs(values).max(initial=0.0))
