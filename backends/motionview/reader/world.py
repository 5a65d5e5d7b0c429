"""The evaluator: all scopes of a model, and the values of expressions, names and things in them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Protocol

from mdlgen.backends.motionview.reader.demand import MOST_CALLS, Deeper, Demand
from mdlgen.backends.motionview.reader.expression import Compiled, compiled, literal, solver_parts
from mdlgen.backends.motionview.reader.functions import FUNCTIONS
from mdlgen.backends.motionview.reader.operators import shown, truth
from mdlgen.backends.motionview.reader.pair import Pair, Unmade
from mdlgen.backends.motionview.reader.program import Guard, Program
from mdlgen.backends.motionview.reader.report import Notes, Trouble
from mdlgen.backends.motionview.reader.scope import Declaration, Scope, Setting, Slot
from mdlgen.backends.motionview.reader.standard import AT_MODEL, HOLDER
from mdlgen.backends.motionview.reader.statement import Statement

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.things.thing import Thing

Vector = tuple[float, float, float]
Frame = tuple[Vector, tuple[Vector, Vector, Vector]]  # origin, and the axes as columns of rows

_PART = r"([^{}\[\],\"`]+)"
_PLACE_IN_AXES = re.compile(rf"(loc_rel_to\(\s*\{{{_PART},{_PART},{_PART}\}}\s*,\s*([\w.]+)\s*\))\[[012]\]")
_COORDINATES = ("[0]", "[1]", "[2]")
_MISSING = object()


class Makers(Protocol):
    """Factory of entities from declarations; see `things`."""

    def made(self, world: World, declaration: Declaration) -> Any:
        """The Thing, or the Pair of two, that a declaration makes."""
        ...

    def system_of(self, world: World, scope: Scope) -> Any:
        """The System that a scope is."""
        ...

    def members(self, found: Any) -> list[Thing]:
        """The entity itself, or the two of a pair."""
        ...


class World(Demand):
    """All scopes of a model, and the values of all that is in them."""

    def __init__(self, program: Program, notes: Notes, makers: Makers):
        super().__init__()
        self.program = program
        self.notes = notes
        self.root = Scope(self, None, "", program.model)
        self.scopes: list[Scope] = [self.root]
        self.built_ins: dict[str, Any] = {}
        self._compiled: dict[str, Compiled | Trouble] = {}
        self._at: tuple[Statement, int] | None = None
        self._on_bodies: dict[str, dict[int, list[Thing]]] = {}  # graphics and joints by their body
        self._makers = makers

    # -- expressions

    def compiled(self, text: str) -> Compiled:
        """The expression of a text; each text is read once."""
        found = self._compiled.get(text)
        if found is None:
            try:
                found = compiled(text)
            except Trouble as trouble:
                found = trouble
            self._compiled[text] = found
        if isinstance(found, Trouble):  # a new one: its place differs
            raise Trouble(found.code, found.message, found.shift, found.severity)
        return found

    def value(self, statement: Statement, index: int, scope: Scope) -> Any:
        """The value of an argument."""
        text = statement.arg(index)
        if text.isidentifier():
            try:
                return scope.value_of(text)
            except Trouble as trouble:
                if trouble.place is None:
                    trouble.place = statement.place(index)
                raise
        if text[:1] == '"' and text.count('"') == 2 and text[-1] == '"' and "\\" not in text:
            return text[1:-1]
        values = scope.values
        value = values.get(text, _MISSING)
        if value is not _MISSING:
            return value
        value = literal(text)
        if value is None:
            value = self._run(statement, index, text, scope)
        values[text] = value
        return value

    def _run(self, statement: Statement, index: int, text: str, scope: Scope) -> Any:
        calls, at = self.calls, self._at
        try:
            if text[-3:] in _COORDINATES:
                place = text[:-3]
                items = scope.shared.get(place)  # the three coordinates have it in common
                if items is None and (call := _PLACE_IN_AXES.fullmatch(text)):
                    items = scope.shared[place] = self._place_in_axes(statement, index, call, scope)
                if items is not None:
                    return items[int(text[-2])]
            expression = self.compiled(text)
            self.calls = calls + expression.depth
            self._at = (statement, index)
            return expression.run(scope)
        except Trouble as trouble:
            if trouble.place is None:
                trouble.place = statement.place(index, trouble.shift)
            raise
        finally:
            self.calls, self._at = calls, at

    def _place_in_axes(self, statement: Statement, index: int, call: re.Match[str], scope: Scope) -> Any:
        """loc_rel_to( {a, b, c}, marker ), whose parts are found once for all points that share them."""
        parts = []
        for k in (2, 3, 4, 5):
            text = call[k].strip()
            value = scope.values.get(text, _MISSING)
            if value is _MISSING:
                try:
                    value = literal(text)
                    if value is None:
                        expression = self.compiled(text)
                        self.calls += expression.depth
                        self._at = (statement, index)
                        value = expression.run(scope)
                except Trouble as trouble:
                    if trouble.place is None:
                        lead = len(call[k]) - len(call[k].lstrip())
                        trouble.place = statement.place(index, call.start(k) + lead + trouble.shift)
                    raise
                scope.values[text] = value
            parts.append(value)
        return FUNCTIONS["loc_rel_to"](scope, [tuple(parts[:3]), parts[3]], 0)

    def remark_angle(self, name: str, angle: float) -> None:
        """A sine of more than a turn: most likely of degrees."""
        if self._at is not None:
            statement, index = self._at
            message = f"{name}({shown(angle)}) is of radians; degrees need *PI/180"
            self.notes.add("warning", "angle", statement.place(index), message)

    def evaluated(self, text: str, scope: Scope, shift: int) -> Any:
        """The value of a text that was computed, for eval()."""
        calls = self.calls
        if calls > 2 * MOST_CALLS:
            raise Trouble("evaluate", "eval in eval in eval has no end", shift)
        expression = self.compiled(text)
        self.calls = calls + expression.depth + 20
        try:
            return expression.run(scope)
        finally:
            self.calls = calls

    def pasted(self, text: str, scope: Scope) -> str:
        """A solver expression with the values of its braces pasted in."""
        out = []
        for shift, part, is_value in solver_parts(text):
            if not is_value:
                out.append(part)
                continue
            try:
                out.append(shown(self.compiled(part).run(scope)))
            except Trouble as trouble:
                if trouble.place is None:
                    trouble.shift += shift + 1
                raise
        return "".join(out)

    # -- names

    def thing(self, slot: Slot) -> Any:
        """The Thing or Pair of a slot, or None where the conditions of all its statements are false."""
        declaration = self.declaration(slot)
        if declaration is None:
            return None
        if declaration.members is None:
            declaration.members = self._makers.made(self, declaration)
        return declaration.members

    def declaration(self, slot: Slot) -> Declaration | None:
        """The statement that makes the slot, under the conditions that hold."""
        for declaration in slot.declarations:
            if declaration.guard is None or self.holds(declaration.guard, slot.scope):
                return declaration
        return None

    def holds(self, guard: Guard | None, scope: Scope) -> bool:
        """True if all conditions around a statement hold; one without a value counts as false."""
        while guard is not None:
            known = scope.conditions.get(id(guard.condition))
            if known is None:
                known = scope.conditions[id(guard.condition)] = self._condition(guard.condition, scope)
            if known is not guard.wanted:
                return False
            guard = guard.outer
        return True

    def _condition(self, statement: Statement, scope: Scope) -> bool:
        scope.conditions[id(statement)] = False  # for a condition that asks for what stands under it
        try:
            if self._inside:
                return truth(self.value(statement, 0, scope))
            return self.force(lambda: truth(self.value(statement, 0, scope)))
        except Trouble as trouble:
            self.notes.add(
                "warning",
                "condition",
                statement.place(0),
                f"this condition has no value and counts as false: {trouble.message}",
            )
            return False
        except Deeper:
            del scope.conditions[id(statement)]
            raise

    def alive(self, scope: Scope | None) -> bool:
        """True if the conditions around the instance of a scope hold."""
        while scope is not None and scope.declaration is not None:
            declaration = scope.declaration
            if self.declaration(declaration.slot) is not declaration:
                return False
            active = self.program.analysis
            if active and declaration.kind == "Analysis" and active.arg(0) != declaration.slot.name:
                return False
            scope = scope.parent
        return True

    def argument(self, scope: Scope, name: str) -> Any:
        """Value that an instance was given for an argument of its definition, else the default."""
        return self.demand(self.system(scope), "argument " + name)

    def system(self, scope: Scope) -> Any:
        """The thing that a scope is."""
        return self._makers.system_of(self, scope)

    def built_in(self, name: str) -> Any:
        """Entity of the standard include, or None."""
        found = self.built_ins.get(name)
        if found is None and name.lower() in AT_MODEL and (holder := self.built_ins.get(HOLDER)) is not None:
            return holder.inner.member(name.lower()) if hasattr(holder, "inner") else holder
        return found

    def settings(self, slot: Slot, kind: str, part: str = "") -> list[Setting]:
        """The Set statements that hold for a part of a slot, the effective one last."""
        if slot.settings is None:
            return []
        found = slot.settings.get((kind, part))
        if not found:
            return []
        if len(found) == 1 and found[0].guard is None and found[0].scope.parent is None:
            return found
        return [s for s in found if self.holds(s.guard, s.scope) and self.alive(s.scope)]

    # -- values as expressions see them

    def attribute(self, owner: Any, key: str, name: str, shift: int) -> Any:
        """`owner.name`; of a pair the pair of both, until .l or .r takes one."""
        if owner.__class__ is Pair:
            if key == "l":
                return owner.l
            if key == "r":
                return owner.r
            return Pair(
                self.attribute(owner.l, key, name, shift),
                owner.r if owner.r is owner.l else self.attribute(owner.r, key, name, shift),
            )
        if owner.__class__ is Unmade:
            raise Trouble("external", f"{owner.name} is made by {owner.why}", shift, "warning")
        if isinstance(owner, tuple):
            if key in ("x", "y", "z") and len(owner) == 3:
                return owner["xyz".index(key)]
            if key in ("l", "r", "data"):
                return owner
            raise Trouble("property", f"a vector has no {name}", shift)
        if isinstance(owner, (float, str, bool)):
            if key in ("l", "r", "value"):
                return owner
            raise Trouble("property", f"{shown(owner)} has no {name}", shift)
        return owner.attribute(key, name, shift)

    def vector(self, value: Any) -> Vector:
        """Three numbers, of a vector literal, a point or a vector."""
        if value.__class__ is not tuple:
            if not hasattr(value, "attribute"):
                raise Trouble("evaluate", f"{shown(value)} is no vector")
            value = value.attribute("data", "data", 0)
        if len(value) == 3:
            x, y, z = value
            if isinstance(x, float) and isinstance(y, float) and isinstance(z, float):
                return value
        raise Trouble("evaluate", "a vector has three numbers")

    def frame(self, marker: Any, shift: int = 0) -> Frame:
        """Origin of a marker, and its axes as rows of the matrix whose columns they are."""
        if not hasattr(marker, "attribute"):
            raise Trouble("evaluate", f"{shown(marker)} is no marker", shift)
        return marker.attribute("frame", "frame", shift)

    def graphics_of(self, body: Thing) -> list[Thing]:
        """The graphics that are fixed to a body."""
        return self._of_bodies("Graphic", "body").get(id(body), [])

    def joined_to(self, body: Thing) -> list[Thing]:
        """The joints whose first body this is."""
        return self._of_bodies("Joint", "b1").get(id(body), [])

    def _of_bodies(self, kind: str, key: str) -> dict[int, list[Thing]]:
        if kind not in self._on_bodies:
            found: dict[int, list[Thing]] = {}
            for thing in self.things(kind):
                try:
                    found.setdefault(id(thing.ask(key)), []).append(thing)
                except Trouble:  # reported where the thing itself is looked at
                    continue
            self._on_bodies[kind] = found
        return self._on_bodies[kind]

    def things(self, *kinds: str) -> Iterator[Thing]:
        """All things of some kinds (of every kind, without), in the order of the text."""
        for scope in self.scopes:
            if not self.alive(scope):
                continue
            for slot in scope.slots.values():
                found = self.thing(slot)
                if found is None:
                    continue
                for thing in self._makers.members(found):
                    if not kinds or thing.kind in kinds:
                        yield thing

    def body_at(self, beam: Any, point: Any, shift: int) -> Any:
        """The body of a beam at one of its points."""
        if hasattr(beam, "at"):
            return beam.at(point)
        raise Trouble("evaluate", f"{shown(beam)} has no bodies at points", shift)
