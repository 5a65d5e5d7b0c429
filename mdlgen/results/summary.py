"""The numbers of a run that a person or a script reads first: summary.json."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

import numpy as np

from mdlgen.model.curves import WAYS
from mdlgen.model.parts.kinds import KINDS
from mdlgen.model.tables import Floats
from mdlgen.results.compare import travel
from mdlgen.results.estimates import complete
from mdlgen.results.losses import driven, kinetic
from mdlgen.results.mark import chaotic, mark
from mdlgen.results.passing import at_ends, span
from mdlgen.results.residual import of_sheet
from mdlgen.results.result import Result
from mdlgen.results.sensors import of_rules, of_sensors
from mdlgen.results.summary_of_parts import of_part
from mdlgen.results.tension import Tension
from mdlgen.results.torques import (
    over_time,
)
from mdlgen.results.verdict import doubts, verdict
from mdlgen.results.way import at_the_end
from mdlgen.units import PER_SECOND
from mdlgen.version import version


def summary(result: Result, without: Collection[str] = ()) -> dict[str, Any]:
    """The content of summary.json; every vector is [x, y, z], every speed that of the centre of mass at the
    end.

    A number that is not finite, or that the run did not reach, is None. `without` names what need not be
    worked out: "events", "bearing" (what the joints of the sheets bore), "estimates", "verdict".
    """
    model = result.model
    energy = result.energy
    record: dict[str, Any] = {
        "scene": model.name,
        "solver": result.solver,
        "status": result.status,
        "mark": mark(result),
        "duration_ms": model.run.duration,
        "t_end_ms": result.time[-1] if len(result.time) else 0.0,
        "steps": result.steps,
        "step_ms": result.step,
        "iterations": result.iterations,
        "rounds": result.iterations,  # as it was called before
        "wall_s": result.wall_s,
        "estimate_s": result.estimate_s,
        "compile_s": result.compile_s,
        "build_s": result.build_s,
        "pairs": {
            "possible": model.pairs.possible,
            "kept": len(model.pairs),
            "searched": len(model.pairs.searched),
            "touched": result.touched,
            "margin_mm": model.pairs.margin,
            "margin_given_mm": model.run.margin,
        },
        "halved": result.halved,
        "error_estimate": result.error_estimate,
        "error_estimate_of": result.error_estimate_of,
        "error_below": result.error_below,
        "error_unknown": result.error_unknown or None,
        "search_ended": result.search_ended or None,
        "chaotic": None if result.chaotic is None else _chaotic(result),
        "tolerance": model.run.tolerance,
        "energy": {
            "kinetic": energy.kinetic,
            "elastic": energy.elastic,
            "dissipated": energy.dissipated,
            "numerical": energy.numerical,
            "plastic": energy.plastic,
            "driven": energy.driven,
            "entered": energy.entered,
            "left": energy.left,
            "balance_error": energy.balance_error,
            "scale": energy.scale,
            **_accounts(result),
        },
        **({} if "events" in without else {"events": result.events}),
        "sheets": {s.name: _sheet(result, k, "bearing" not in without) for k, s in enumerate(model.sheets)},
        **{k.table: {p.name: of_part(result, p) for p in model.parts_of(k.part)} for k in KINDS},
        "probes": {p.name: _probe(result, k) for k, p in enumerate(model.probes)},
        **({"sensors": of_sensors(result)} if model.reactions.sensors else {}),
        **({"rules": of_rules(result)} if model.reactions.rules else {}),
        "versions": versions(result),
    }
    judges = not {"verdict", "events", "bearing"} & set(without) and len(result.time) > 0
    if judges and model.require and not result.doubts:  # before the coarser runs are released
        others = [(run, plain(summary(run, without=("estimates", "verdict")))) for run in result.coarser[:1]]
        result.doubts = doubts(result, plain(record), others)
    if "estimates" not in without:
        estimates = complete(result)
        record["estimates"] = {name: found.value for name, found in estimates.items()}
        record["estimate_scales"] = {
            name: {"scale": found.scale, "unit": found.unit} for name, found in estimates.items()
        }
        record["estimates_below"] = [name for name, found in estimates.items() if found.below]
    if judges:
        record["verdict"] = verdict(result, plain(record))
    if model.tension is not None:
        record["strain"] = strain(result) if len(result.time) else None
    return plain(record)


def _chaotic(result: Result) -> dict[str, Any]:
    """Divergence of two runs whose starts nearly agree, and the change by half the step."""
    found = result.chaotic
    assert found is not None, "asked only where it is"
    length = found.unit == "mm"
    names = {"apart_mm" if length else "apart_rad": found.apart}
    names["step_apart_mm" if length else "step_apart_rad"] = found.step_apart
    return {
        "quantity": found.quantity,
        "start_mm": found.start_mm,
        **names,
        "in_words": chaotic(result, "SPEC"),
    }


def versions(result: Result) -> dict[str, str]:
    """Versions of the packages that made the result: those that a saved one has, else the installed ones."""
    return {"mdlgen": version(), "numpy": np.__version__, **result.versions}


def plain(value: Any) -> Any:
    """Only what JSON knows: Python numbers, and None for those that are not finite."""
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(v) for v in value]
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        # + 0.0: a negative zero says nothing to a reader
        return float(value) + 0.0 if math.isfinite(value) else None
    return value


def strain(result: Result) -> float:
    """Elongation over the length of the flexible part, of a clamped strip under edge stress.

    The elongation is the mean displacement of the last row of box centres along the pull, from the clamp
    line's half-cell hinge on: the flexible length is the sum of the joint lengths.
    """
    tension = result.model.tension
    assert tension is not None, "asked only where the Model has a tension"
    sheet, axis, length = result.model.sheets[tension.sheet], tension.axis, tension.length
    assert sheet.clamp is not None, "a tension has a clamped sheet"
    outward = 1.0 if sheet.clamp.edge.endswith("min") else -1.0
    last = -1 if outward > 0 else 0
    grid = np.arange(sheet.first, sheet.first + sheet.count).reshape(sheet.n_y, sheet.n_x)
    pulled = grid[:, last] if axis == 0 else grid[last]
    moved = result.position[-1, pulled] - result.model.bodies.position[pulled]
    return float((moved @ sheet.rotation[:, axis]).mean() * outward / length)


def _sheet(result: Result, index: int, bearing: bool) -> dict[str, Any]:
    sheet = result.model.sheets[index]
    numbers = ("travel_mm", "speed_mm_per_s", "yaw_deg", "way_mm", "mean_speed_mm_per_s", "skew_deg")
    record: dict[str, Any] = dict.fromkeys(numbers)
    if len(result.time):
        _, rate, yaw = result.sheet_motion(index)
        _, last = span(result, index)
        way, fast, skew = at_the_end(result, index)
        record = {
            "travel_mm": travel(result, index),
            "speed_mm_per_s": rate[last] * PER_SECOND,
            "yaw_deg": math.degrees(yaw[-1]),
            "way_mm": way,
            "mean_speed_mm_per_s": fast * PER_SECOND,
            "skew_deg": math.degrees(skew),
        }
    return {
        **record,
        **at_ends(result, index),
        "boxes": sheet.count,
        "bushings": int(np.sum(result.model.bushings.sheet == index)),
        **(_bearing(result, index) if bearing else {}),
        "residual": of_sheet(result, index),
        "energy": _energy__sheet(result, index),
    }


def _accounts(result: Result) -> dict[str, float | None]:
    """Energy that contacts took by friction and rolling, and the rest of all that was dissipated. The rest is
    by dampers of joints, presses and normal forces, in contacts without an account, and between stored
    states. Also the energy that drives brought in by their torques, and what the solver counts beyond that:
    it falls between stored states."""
    found = result.losses
    names = ("friction", "other_losses", "drives", "drives_unseen")
    if found is None:
        return dict.fromkeys(names)
    rubbed = float(sum(np.trapezoid(power, result.time) for power in found.rows.values()))
    given, own = 0.0, 0.0
    for roller in result.model.rollers:
        if (energy := driven(result, roller)) is not None:
            given += float(energy[-1])
            if not roller.turns:  # the solvers do not count the work of turning them
                inertia = roller.loaded_inertia
                rates = result.spin[[0, -1], roller.body] @ roller.axis
                own += 0.5 * inertia * float(rates[1] ** 2 - rates[0] ** 2)
    lost = result.energy.dissipated + (result.energy.numerical or 0.0) - (result.energy.plastic or 0.0)
    numbers = (rubbed, lost - rubbed, given, result.energy.driven + own - given)
    return dict(zip(names, numbers, strict=True))


def _energy__sheet(result: Result, index: int) -> dict[str, float | None]:
    """Increase of its kinetic energy, and energy that its contacts took by friction and rolling."""
    sheet, found = result.model.sheets[index], result.losses
    if found is None:
        return dict.fromkeys(("kinetic_n_mm", "friction_n_mm"))
    boxes = slice(sheet.first, sheet.first + sheet.count)
    contacts, rubbed = result.model.contacts, 0.0
    first, last = span(result, index)
    for row, power in found.rows.items():
        if sheet.name in (contacts.part_a[row], contacts.part_b[row]):
            rubbed += float(np.trapezoid(power, result.time))
    return {
        "kinetic_n_mm": kinetic(result, boxes, last) - kinetic(result, boxes, first),
        "friction_n_mm": rubbed,
    }


def _bearing(result: Result, index: int) -> dict[str, Any]:
    """Peaks over joints and stored times, with place and time of the greatest, and the tension; None without
    joints."""
    strains = result.strains
    if strains is None or not (strains.joints.sheet == index).any():
        return {"strain": None, "curvature": None, "twist": None, "tension": None}
    joints = strains.joints
    mine = joints.sheet == index

    def of(values: Floats, least: bool = False) -> dict[str, float]:
        extreme = np.min if least else np.max
        ways = ("md", mine & (joints.axis == 0)), ("cd", mine & (joints.axis == 1))
        return {way: float(extreme(values[rows])) for way, rows in ways if rows.any()}

    def place(values: Floats, at: Floats) -> dict[str, Any]:
        row = int(np.argmax(np.where(mine, values, -np.inf)))
        return {"at_mm": joints.at[row], "at_ms": at[row], "joint": joints.name[row]}

    stretch, bend, turn = strains.stretch, np.abs(strains.curvature.value), np.abs(strains.twist.value)
    strain = {f"max_{way}": value for way, value in of(stretch.value).items()}
    strain |= {f"min_{way}": value for way, value in of(strains.squeeze.value, least=True).items()}
    strain |= place(stretch.value, stretch.at)
    margin = strains.margin
    if margin is not None and np.isfinite(margin[mine]).any():
        row = int(np.nanargmin(np.where(mine, margin, np.nan)))
        strain |= {"margin": margin[row], "margin_joint": joints.name[row]}
    curvature = {f"max_{way}_per_mm": value for way, value in of(bend).items()}
    return {
        "strain": strain,
        "curvature": curvature | place(bend, strains.curvature.at),
        "twist": {"max_per_mm": turn[mine].max(), **place(turn, strains.twist.at)},
        "tension": _tension(result, result.tensions[index]),
    }


def _tension(result: Result, tension: Tension | None) -> dict[str, Any] | None:
    """Extremes over sections and stored times. Also the mean over the run of the section where it is greatest
    in magnitude. Each has its place along the direction of motion from the sheet's centre."""
    if tension is None:
        return None
    force = tension.force
    high, low = (np.unravel_index(k, force.shape) for k in (force.argmax(), force.argmin()))
    means = [over_time(result, values) for values in tension.force.T]
    most = int(np.abs(means).argmax())
    return {
        "along": WAYS[tension.axis],
        "max_n": force[high],
        "at_mm": tension.at[high[1]],
        "at_ms": result.time[high[0]],
        "min_n": force[low],
        "least_at_mm": tension.at[low[1]],
        "least_at_ms": result.time[low[0]],
        "mean_n": means[most],
        "mean_at_mm": tension.at[most],
    }


def _probe(result: Result, index: int) -> dict[str, Any]:
    if not len(result.time):
        return {"displacement_mm": None, "speed_mm_per_s": None}
    anchor, bodies = result.model.probes[index], result.model.bodies
    start = np.zeros(3)
    for body, local, share in zip(anchor.body, anchor.local, anchor.share, strict=True):
        start += share * (bodies.position[body] + bodies.rotation[body] @ local)
    place, rate = result.anchor_motion(index)
    _, last = span(result, anchor.sheet)
    return {"displacement_mm": place[-1] - start, "speed_mm_per_s": rate[last] * PER_SECOND}
