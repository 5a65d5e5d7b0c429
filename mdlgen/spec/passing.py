"""Consistency checks of sheets that come in and leave during a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mdlgen.spec.between import known
from mdlgen.spec.stream import names_of
from mdlgen.spec.strict import fail

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene


def as_written(scene: Scene) -> dict[str, str]:
    """Names by which a nip may call a sheet, each with what it stands for: of a stream the sheet that all are
    like."""
    found = {}
    for name, stream in scene.streams.items():
        own = names_of(name, {"count": stream.count, "times": stream.times})
        found |= dict.fromkeys([name, stream.of, *own], stream.of)
    return {**found, **{sheet: found.get(sheet, sheet) for sheet in scene.sheets}}


def passing_sheets(scene: Scene) -> list[str]:
    """The sheets that are to be looked at: of a stream the last one, which the others are like."""
    streams = [names_of(n, {"count": s.count, "times": s.times}) for n, s in scene.streams.items()]
    others = {name for names in streams for name in names[:-1]}
    return [name for name in scene.sheets if name not in others]


def check_stream(scene: Scene, name: str) -> None:
    """Raises the error where a stream is of no sheet, or its sheets would be clamped."""
    stream, path = scene.streams[name], ("streams", name)
    first = names_of(name, {"count": stream.count, "times": stream.times})[0]
    if name in scene.sheets:
        raise fail(f"the name {name!r} is used twice (also sheets.{name})", path)
    if first not in scene.sheets:
        known(stream.of, scene.sheets, "sheet", (*path, "of"))
    if scene.sheets[first].clamp is not None:
        message = f"sheet {stream.of} is clamped: leave clamp out, or all sheets of the stream would be"
        raise fail(message, ("sheets", first, "clamp"))


def check_passing(scene: Scene, name: str) -> None:
    """Raises the error where a sheet comes in or leaves in a run without time, or comes in on a plane that it
    is to leave beyond."""
    sheet, path = scene.sheets[name], ("sheets", name)
    late = [key for key, value in (("enters", sheet.enters), ("by_rule", sheet.by_rule)) if value]
    if scene.run.analysis == "static" and (late or sheet.out):
        key = (late or ["out"])[0]
        raise fail(f"sheet {name}: {key} takes a transient run; a static one has no time", (*path, key))
    for k, out in enumerate(sheet.out):
        if out.axis is not None and sheet.center["xyz".index(out.axis)] == out.at:
            message = f"sheet {name} comes in at {out.axis} = {out.at:g} mm, so that no side is beyond it"
            raise fail(message, (*path, "out", k))
