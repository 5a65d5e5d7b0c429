"""A result for those who work with xarray and pandas: names on its axes and columns."""

from __future__ import annotations

from typing import Any

from mdlgen.errors import RefusedError
from mdlgen.results.result import Result

_UNITS = {
    "position": "mm",
    "rotation": "1",
    "velocity": "mm/ms",
    "spin": "rad/ms",
    "contact_force": "N",
    "contact_torque": "N*mm",
    "contact_friction": "N",
}


def dataset(result: Result) -> Any:
    """See `Result.to_xarray`. Raises RefusedError where xarray is not installed."""
    try:
        import xarray
    except ImportError:
        raise RefusedError("to_xarray needs xarray; install it: pip install 'mdlgen[xarray]'") from None
    contacts = result.model.contacts
    axes = {
        "position": ("time", "body", "axis"),
        "rotation": ("time", "body", "parameter"),
        "velocity": ("time", "body", "axis"),
        "spin": ("time", "body", "axis"),
        "contact_force": ("time", "contact"),
        "contact_torque": ("time", "contact", "part"),
        "contact_friction": ("time", "contact", "friction"),
    }
    axes = {name: dims for name, dims in axes.items() if getattr(result, name) is not None}
    return xarray.Dataset(
        {name: (dims, getattr(result, name), {"units": _UNITS[name]}) for name, dims in axes.items()},
        coords={
            "time": ("time", result.time, {"units": "ms"}),
            "body": list(result.model.bodies.name),
            "axis": ["x", "y", "z"],
            "parameter": ["w", "x", "y", "z"],
            "part": ["a", "b"],
            "friction": ["along", "limit"],
            "contact": [f"{a} / {b}" for a, b in zip(contacts.part_a, contacts.part_b, strict=True)],
        },
        attrs={"scene": result.model.name, "solver": result.solver, "status": result.status},
    )


def frame(result: Result) -> Any:
    """See `Result.to_pandas`. Raises RefusedError where pandas is not installed."""
    try:
        import pandas
    except ImportError:
        raise RefusedError("to_pandas needs pandas; install it: pip install 'mdlgen[pandas]'") from None
    from mdlgen.results.io.series import series

    table = pandas.DataFrame(series(result)).set_index("time_ms")
    table.attrs["units"] = {"time_ms": "ms", **{str(name): unit_of(str(name)) for name in table.columns}}
    return table


def unit_of(column: str) -> str:
    """The unit that stands at the end of the name of a column."""
    endings = (
        ("_mm_per_s", "mm/s"),
        ("_rad_per_s", "rad/s"),
        ("_n_mm", "N*mm"),
        ("_mm", "mm"),
        ("_deg", "deg"),
        ("_n", "N"),
        ("_w", "W"),
    )
    return next((unit for ending, unit in endings if column.endswith(ending)), "1")
