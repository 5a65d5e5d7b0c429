"""A calibration in words, as data, and as a piece of a scene file."""

from __future__ import annotations

from typing import Any

import numpy as np

from mdlgen.calibrate.calibration import Calibration
from mdlgen.calibrate.measured import Decay
from mdlgen.calibrate.value import FITS, of_scene
from mdlgen.model.tables import CLAMP

DIGITS = 6  # of a value that is written for people; more is below what a run resolves


def report(found: Calibration) -> dict[str, Any]:
    """The output of `calibrate --json`, in mm, N, g, ms, rad."""
    sheet = found.model.sheets[found.probe.sheet]
    message: dict[str, Any] = {
        "fit": found.fit,
        "material": found.material,
        "value": found.value,
        "unit": found.unit,
        "probe": found.probe.name,
        "sheet": sheet.name,
        "free_length_mm": _free_length(found),
        "residual_mm": found.residual,
        "sensitivity_mm": _size(found.sensitivity),
        "runs": found.runs,
        "step_error": found.step_error,
        "numerical_damping": found.numerical,
        "solver": found.solver,
    }
    if isinstance(found.measured, Decay):
        message |= {"points": len(found.measured.time), "measured_max_mm": float(found.measured.drop.max())}
    else:
        message |= {"measured_mm": found.measured, "drop_mm": float(found.drop[0])}
    return message


def report_text(found: Calibration) -> str:
    """A few lines for a terminal."""
    change = _size(found.sensitivity) / 100.0
    lines = [
        f"{found.fit}{'' if of_scene(found.fit) else f' of {found.material}'}: {quantity(found)}",
        f"probe {found.probe.name}: {_agreement(found)}",
        f"sensitivity: 1 % more {found.fit} changes the drop by {change:.3g} mm"
        + (" (root of the mean square)" if len(found.drop) > 1 else ""),
        *_step_error(found),
        *_numerical(found),
        f"{found.runs} runs ({found.solver}); {_sheet(found)}",
        f'as an option: --set {_path(found)}="{quantity(found)}"',
    ]
    return "\n".join(lines)


def fragment(found: Calibration) -> str:
    """The piece of a scene file that gives the material this value, with how it was found."""
    outer = [] if of_scene(found.fit) else ["materials", found.material]
    outer += found.fit.split(".")[:-1]
    name = found.fit.split(".")[-1]
    instead = None if of_scene(found.fit) else FITS[found.fit].instead
    lines = [
        f"# Found by mdlgen calibrate with the scene {found.model.name}: probe {found.probe.name},",
        f"# {_agreement(found)};",
        f"# {found.runs} runs ({found.solver}); {_sheet(found)}.",
        *([f"# It takes the place of {instead}."] if instead else []),
        *(f"{'  ' * depth}{word}:" for depth, word in enumerate(outer)),
        f"{'  ' * len(outer)}{name}: {quantity(found)}",
        *([f"      at: {_frequency(found):.{DIGITS}g} Hz"] if found.fit == "damping.loss_factor" else []),
    ]
    return "\n".join(lines) + "\n"


def _path(found: Calibration) -> str:
    return found.fit if of_scene(found.fit) else f"materials.{found.material}.{found.fit}"


def _frequency(found: Calibration) -> float:
    """Frequency of the loss factor of the scene [Hz]."""
    sheet = found.model.sheets[found.probe.sheet].name
    (at,) = (p.value for p in found.model.parameters if p.data_set == sheet and p.member == "f")
    return 1e3 * at


def quantity(found: Calibration) -> str:
    """The value as it stands in a scene file."""
    return f"{found.value:.{DIGITS}g} {found.unit}".rstrip()


def _agreement(found: Calibration) -> str:
    if isinstance(found.measured, Decay):
        points, most = len(found.measured.time), float(found.measured.drop.max())
        part = found.residual / most
        return (
            f"{points} measured points up to {most:g} mm, residual {found.residual:.3g} mm "
            f"(root of the mean square, {part:.2g} of the greatest)"
        )
    return f"drop {found.drop[0]:.6g} mm, measured {found.measured:g} mm, residual {found.residual:.2g} mm"


def _step_error(found: Calibration) -> list[str]:
    if found.step_error is None:
        return []
    return [f"error of the value by the step of the runs: {found.step_error:.2%} (see run.tolerance)"]


def _numerical(found: Calibration) -> list[str]:
    """How much of the damping is that of the solver, which a fitted damping lacks."""
    if found.numerical is None:
        return []
    message = f"numerical damping of the solver took {found.numerical:.2%} of what was lost"
    if found.fit.startswith("damping."):
        message += "; the value is too small by that part"
    return [message]


def _sheet(found: Calibration) -> str:
    sheet = found.model.sheets[found.probe.sheet]
    length = _free_length(found)
    held = "" if length is None else f"free length {length:.6g} mm, "
    return f"{held}{sheet.n_x} x {sheet.n_y} boxes, {sheet.layout}, grid {sheet.grid}"


def _free_length(found: Calibration) -> float | None:
    """From the clamp line to the opposite edge [mm]; None for a sheet that is not clamped."""
    sheet = found.model.sheets[found.probe.sheet]
    if sheet.clamp is None:
        return None
    axis = 0 if sheet.clamp.edge[0] == "x" else 1
    bodies, bushings = found.model.bodies, found.model.bushings
    hinges = (bushings.kind == CLAMP) & (bushings.sheet == found.probe.sheet)
    boxes = slice(sheet.first, sheet.first + sheet.count)
    out = np.abs((bodies.position[boxes] - bushings.origin[hinges].mean(axis=0)) @ sheet.rotation[:, axis])
    free = ~bodies.fixed[boxes]
    return float((out + bodies.half[boxes, axis])[free].max())


def _size(slope: np.ndarray) -> float:
    """One number for the sensitivity: itself, or the root of the mean square over a curve."""
    return float(slope[0]) if len(slope) == 1 else float(np.sqrt(np.mean(slope**2)))
