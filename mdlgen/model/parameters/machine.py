"""The parameters that the user gave for parts of the machine of any kind: places and springs."""

from __future__ import annotations

from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.tables import Parameter
from mdlgen.spec.machine import Press


def center_rows(name: str, center: tuple[float, ...], base: tuple[str, str]) -> list[Parameter]:
    return [
        Parameter(name, axis, f"Centre {axis}", center[k], "mm", (*base, "center", k))
        for k, axis in enumerate(NAMED_AXES)
    ]


def spring_rows(name: str, press: Press, base: tuple[str, str]) -> list[Parameter]:
    """The spring of a roller or a plate."""
    way = (*base, "press")
    return [
        Parameter(name, "k", "Spring stiffness", press.stiffness, "N/mm", (*way, "stiffness")),
        Parameter(name, "f", "Spring preload (N)", press.preload, "N", (*way, "preload")),
        Parameter(name, "l", "Spring free length", press.free_length, "mm", (*way, "free_length")),
        Parameter(name, "zeta", "Relative damping", press.damping_ratio, "1", (*way, "damping_ratio")),
    ]


def start_row(name: str, start: float, press: Press) -> Parameter:
    where = "in static equilibrium" if press.start is None else "where the scene has it"
    label = f"Start along the slide {where}, as written"
    return Parameter(name, "start", label, start, "mm", None)
