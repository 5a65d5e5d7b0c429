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
    }
    return xarray.Dataset(
        {name: (dims, getattr(result, name), {"units": _UNITS[name]}) for name, dims in axes.items()},
        coords={
            "time": ("time", result.time, {"units": "ms"}),
            "body": list(result.model.bodies.name),
            "axis": ["x", "y", "z"],
            "parameter": ["w", "x", "y", "z"],
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
    from mdlgen.results.series import series

    return pandas.DataFrame(series(result)).set_index("time_ms")
