"""The motion over time as a table: series.csv."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Floats, MachinePart, PlanePart, RollerPart
from mdlgen.results.drag import drags
from mdlgen.results.gates import shown
from mdlgen.results.losses import driven, summed
from mdlgen.results.result import Result
from mdlgen.results.slide import slide
from mdlgen.results.summary_of_parts import part_rows
from mdlgen.results.swing import swing
from mdlgen.results.torques import contact_torque, drive_power, drive_torque, grips
from mdlgen.units import PER_SECOND

SLIGHT = 1e-9  # part of a slide along an axis that is round-off


def series(result: Result) -> dict[str, Floats]:
    """Column name -> values at the stored times: sheets (centre of mass, tension), probes, rollers with their
    torques, pressed plates, then what does not move: planes, guides and meshes; with the drag on sheets."""
    table: dict[str, Floats] = {"time_ms": result.time}
    for index, sheet in enumerate(result.model.sheets):
        place, rate, yaw = result.sheet_motion(index)
        table |= _motion(sheet.name, place, rate)
        table[f"{sheet.name}.yaw_deg"] = np.degrees(yaw)
        if (tension := result.tensions[index]) is not None:
            table[f"{sheet.name}.tension_max_n"] = tension.greatest
            table[f"{sheet.name}.tension_min_n"] = tension.least
    for index, probe in enumerate(result.model.probes):
        table |= _motion(probe.name, *result.anchor_motion(index))
    for roller in result.model.rollers:
        rows = list(part_rows(result, roller))
        table |= _places(result, roller)
        table[f"{roller.name}.omega_rad_per_s"] = result.spin[:, roller.body] @ roller.axis * PER_SECOND
        table[f"{roller.name}.force_n"] = result.contact_force[:, rows].sum(axis=1)
        table |= _turning(result, roller)
    for plate, _ in result.model.plates:
        rows = list(part_rows(result, plate))
        table |= _places(result, plate)
        table[f"{plate.name}.force_n"] = result.contact_force[:, rows].sum(axis=1)
        table |= _drags(result, plate)
    pressed = {plate.name for plate, _ in result.model.plates}
    for part in result.model.machine:
        if isinstance(part, RollerPart) or part.name in pressed:
            continue
        table[f"{part.name}.force_n"] = result.contact_force[:, list(part_rows(result, part))].sum(axis=1)
        table |= _drags(result, part)
        if (found := shown(result, part)) is not None:
            table[f"{part.name}.{found[0]}"] = found[1]
    return table | _energies(result)


def _energies(result: Result) -> dict[str, Floats]:
    """Energy that each drive has put in, and that friction and rolling at the contacts of each part have
    dissipated, since the start."""
    found: dict[str, Floats] = {}
    if result.losses is None:
        return found
    for part in result.model.machine:
        given = driven(result, part) if isinstance(part, RollerPart) else None
        if given is not None:
            found[f"{part.name}.driven_energy_n_mm"] = given
        if (power := result.losses.of(result, part)) is not None:
            found[f"{part.name}.friction_loss_n_mm"] = summed(result, power)
    return found


def _places(result: Result, part: RollerPart | PlanePart) -> dict[str, Floats]:
    """x, y and z of its centre where it may move along them, on its slide or round its arm's pivot, z alone
    of one that stands; and its way along its press direction, and the angle of its arm."""
    moves = np.zeros(3) if part.press is None else np.abs(part.press.direction)
    if isinstance(part, RollerPart) and part.arm is not None:
        moves = 1.0 - np.abs(part.axis)
    places = result.position[:, part.body]
    table = {
        f"{part.name}.{axis}_mm": places[:, k]
        for k, axis in enumerate("xyz")
        if moves[k] > SLIGHT or (axis == "z" and not moves.any())
    }
    if isinstance(part, RollerPart) and (turned := swing(result, part)) is not None:
        table[f"{part.name}.arm_deg"] = np.degrees(turned)
    way = slide(result, part)
    return table if way is None else table | {f"{part.name}.slide_mm": way}


def _motion(name: str, place: Floats, rate: Floats) -> dict[str, Floats]:
    table = {f"{name}.{axis}_mm": place[:, k] for k, axis in enumerate("xyz")}
    return table | {f"{name}.v{axis}_mm_per_s": rate[:, k] * PER_SECOND for k, axis in enumerate("xyz")}


def _turning(result: Result, roller: RollerPart) -> dict[str, Floats]:
    """Torque and power of its drive, where it has one, and what its contacts turn it with."""
    found = {"contact_torque_n_mm": contact_torque(result, roller)}
    if roller.driven:
        found = {"torque_n_mm": drive_torque(result, roller), "power_w": drive_power(result, roller), **found}
    known = {f"{roller.name}.{name}": values for name, values in found.items() if values is not None}
    return known | {f"{roller.name}.{grip.other}.tangential_n": grip.along for grip in grips(result, roller)}


def _drags(result: Result, part: MachinePart) -> dict[str, Floats]:
    return {f"{part.name}.{sheet}.drag_n": drag for sheet, drag in drags(result, part).items()}


def csv(result: Result) -> str:
    """`series` as text; numbers as Python writes them, so that they read back exactly."""
    table = series(result)
    lines = [",".join(table)]
    for row in np.stack(list(table.values()), axis=1, dtype=float).tolist():
        lines.append(",".join(map(repr, row)))
    return "\n".join(lines) + "\n"
