"""All evaluated entities of a World, as numbers and tuples of numbers (lists, once they are JSON)."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from mdlgen.backends.motionview.reader.report import Notes, Trouble
from mdlgen.backends.motionview.reader.standard import FILE, PREFIX
from mdlgen.backends.motionview.reader.things.beams import PolyBeam
from mdlgen.backends.motionview.reader.things.bodies import Body
from mdlgen.backends.motionview.reader.things.data import Option, Table, Value
from mdlgen.backends.motionview.reader.things.systems import DataSet
from mdlgen.backends.motionview.reader.things.templates import Template
from mdlgen.backends.motionview.reader.things.thing import Thing
from mdlgen.backends.motionview.reader.world import World

# Kind of entity -> its list.
LISTS = {
    "Point": "points",
    "Vector": "vectors",
    "Body": "bodies",
    "Marker": "markers",
    "Bush": "bushings",
    "SpringDamper": "springs",
    "Graphic": "graphics",
    "Joint": "joints",
    "Motion": "motions",
    "Contact": "contacts",
    "Output": "outputs",
    "DeformableSurface": "surfaces",
    "Curve": "curves",
    "Template": "templates",
}


# Labels of entities without a record; the model itself, with its settings of the standard include.
_MORE = ("velocities", "datasets", "members", "labels", "model", "commands", "standard", "forces")


def values(world: World, notes: Notes) -> dict[str, dict[str, Any]]:
    """Records of all entities that could be evaluated; others are reported to `notes` and omitted."""
    found = values_of(world.things(), world, notes)
    begin = world.program.begin
    if begin is not None:
        statements = world.program.statements
        modes = [s.arg(0).upper() for s in statements if s.key == "setcurrentsolvermode"]
        record = {
            "label": begin.arg(1).strip('"'),
            "solver": modes[-1] if modes else None,
            "standard_include": tuple(s.args for s in statements if s.key == "standardinclude"),
        }
        found["model"][begin.arg(0)] = record
    return found


def values_of(
    things: Iterable[Thing], world: World, notes: Notes, made_markers: bool = True
) -> dict[str, dict[str, Any]]:
    """The values of some things, with or without the markers that MotionView makes for them."""
    found: dict[str, dict[str, Any]] = {name: {} for name in (*LISTS.values(), *_MORE)}
    collect = _Collector(world, notes, found, made_markers)
    for thing in things:
        collect.thing(thing)
    return found


class _Collector:
    def __init__(self, world: World, notes: Notes, found: dict[str, dict[str, Any]], made_markers: bool):
        self.made_markers = made_markers
        self.world = world
        self.notes = notes
        self.found = found

    def thing(self, thing: Thing) -> None:
        """One thing, with the markers that MotionView makes for it."""
        if isinstance(thing, (Value, Option, Table)):
            self._value(thing)
        elif isinstance(thing, DataSet) and thing.scope.standard:
            self.found["standard"].setdefault(thing.name.removeprefix(PREFIX), {})
        elif isinstance(thing, DataSet):
            self.found["datasets"].setdefault(thing.name, {})
            self._put("labels", thing, lambda: thing.ask("label"))
        elif isinstance(thing, PolyBeam):
            for body in self.attempt(thing, lambda: thing.ask("bodies")) or ():
                self._entry("bodies", body)
                self._markers(body)
            self._markers(thing)
        elif thing.kind in LISTS:
            if thing.kind == "Joint" and self.attempt(thing, lambda: thing.ask("isbush")):
                self._entry("bushings", thing.ask("bush"))
            elif thing.kind in ("Point", "Vector"):
                self._put(LISTS[thing.kind], thing, lambda: thing.ask("data"))
                self._put("labels", thing, lambda: thing.ask("label"))
            else:
                self._entry(LISTS[thing.kind], thing)
            self._markers(thing)
            if isinstance(thing, Template):
                self._put("commands", thing, lambda: thing.ask("commands"))
            if isinstance(thing, Body):
                self._put("velocities", thing, lambda: thing.ask("velocity"))
        elif thing.kind == "Force":
            if thing.declaration.kind == "ActionOnlyForce":
                self._entry("forces", thing)
            self._markers(thing)

    def attempt(self, thing: Thing, find: Callable[[], Any]) -> Any:
        """A value, or None after telling why there is none."""
        try:
            return self.world.force(find)
        except Trouble as trouble:
            self.notes.add_trouble(trouble, thing.statement.place())
        except RecursionError:
            message = f"{thing} depends on too many others in one expression"
            self.notes.add("error", "evaluate", thing.statement.place(), message)
        return None

    def _put(self, where: str, thing: Thing, find: Callable[[], Any]) -> None:
        value = self.attempt(thing, find)
        if value is not None:
            self.found[where][thing.name] = value

    def _entry(self, where: str, thing: Thing) -> None:
        self._put(where, thing, thing.record)

    def _markers(self, thing: Thing) -> None:
        if self.made_markers:
            self.found["markers"].update(self.attempt(thing, thing.marker_records) or ())

    def _value(self, thing: Value | Option | Table) -> None:
        holder, _, name = thing.name.rpartition(".")
        if thing.scope.standard:  # only what this text sets: an include of the user's may say anything
            value = self.attempt(thing, lambda: thing.ask("value")) if _is_set(thing) else None
            if value is not None:
                self.found["standard"].setdefault(holder.removeprefix(PREFIX), {})[name] = value
            return
        into = self.found["datasets"].setdefault(holder or "MODEL", {})
        edit = thing.statement.args[-1].upper()
        self._put("members", thing, lambda: {"label": thing.ask("label"), "edit": edit})
        if isinstance(thing, Table):
            columns = self.attempt(thing, lambda: {c: thing.cells(c) for c in thing.columns()})
            if columns is not None:
                into[name] = columns
            return
        value = self.attempt(thing, lambda: thing.ask("value"))
        if value is not None:
            into[name] = value


def _is_set(thing: Thing) -> bool:
    """True if a file that was read sets a value of the standard include."""
    settings = (thing.declaration.slot.settings or {}).values()
    return any(s.statement.source.file != FILE for found in settings for s in found)
