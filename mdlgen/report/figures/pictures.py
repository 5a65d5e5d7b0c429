"""The pictures of a run for print, stored in the folder of its page on request."""

from __future__ import annotations

from pathlib import Path

from mdlgen.results.result import Result

NAMES = ("report.png", "strain.png")


def are_drawn(folder: Path) -> bool:
    """True if `folder` has pictures."""
    return any((folder / name).exists() for name in NAMES)


def load_drawing() -> None:
    """Loads what they are drawn with, ahead of the first one."""
    import matplotlib.backends.backend_agg
    import matplotlib.figure  # noqa: F401


def pictures_of(result: Result) -> dict[str, bytes]:
    """PNGs by the names of their files; the same result gives the same bytes."""
    from mdlgen.report.figures.figure import figure
    from mdlgen.report.figures.maps import strain_map

    return dict(zip(NAMES, (figure(result), strain_map(result)), strict=True))
