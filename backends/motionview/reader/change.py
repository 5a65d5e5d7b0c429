"""Changes one value of an MDL file that was read: values that depend on it are evaluated again, others are
not.

Dependences follow from the words of the statements, which is more than the values that were used. An entity
whose statements do not name another one, directly or through others, cannot depend on it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from mdlgen.backends.motionview.reader.expand import Expansion
from mdlgen.backends.motionview.reader.program import Guard
from mdlgen.backends.motionview.reader.report import Notes
from mdlgen.backends.motionview.reader.scope import Scope, Slot
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things import members
from mdlgen.backends.motionview.reader.values import values_of

_PATH = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")
_BRACES = re.compile(r"\{([^{}]*)\}")
_SETTERS = ("setreal", "setinteger", "setval")
# Words by which a thing depends on more than its statements name.
_FAR = ("inertia_props_from_graphic", "eval(", "@")


class Changes:
    """Changes values of one text, each for itself."""

    def __init__(self, expansion: Expansion):
        self.expansion = expansion
        self.world = expansion.world
        self._found: dict[tuple[int, str], frozenset[Slot]] = {}
        self._users = self._graph()
        self._far = any(
            word in argument
            for statement in self.expansion.program.statements
            for argument in statement.args
            for word in _FAR
            if argument[:1] != '"'
        )

    def values(self, path: str, text: str, without: tuple[str, ...] = ()) -> dict[str, dict[str, Any]] | None:
        """Values of all that may depend on the number at `path` (`ds_note.real_L_x`), were it `text`.

        Without the markers that MotionView makes, which are where their owners are, and without things of
        the kinds `without`. None where the text sets no such number.
        """
        statement = self._setting(path)
        if statement is None:
            return None
        found = self.expansion.find(self.world.root, path)
        assert found is not None
        slots = self._dependents(found[0])
        given = statement.args
        try:
            statement.args = (given[0], text, *given[2:])
            self._forget(slots)
            things = [t for slot in slots for t in self._things(slot) if t.kind not in without]
            return values_of(things, self.world, Notes(), made_markers=False)
        finally:
            statement.args = given
            self._forget(slots)

    def _setting(self, path: str) -> Statement | None:
        """The statement that sets a number."""
        found = self.expansion.find(self.world.root, path)
        if found is None or found[1] not in ([], ["value"]):
            return None
        slot = found[0]
        settings = [
            s for kind in _SETTERS for part in ("", "value") for s in self.world.settings(slot, kind, part)
        ]
        return max(settings, key=lambda s: s.rank).statement if settings else None

    def _things(self, slot: Slot) -> list[Any]:
        thing = self.world.thing(slot)
        return members(thing) if thing is not None and self.world.alive(slot.scope) else []

    def _forget(self, slots: Iterable[Slot]) -> None:
        for scope in self.world.scopes:
            scope.values.clear()
            scope.shared.clear()
            scope.conditions.clear()
        for slot in slots:
            for declaration in slot.declarations:
                if declaration.members is not None:
                    for thing in members(declaration.members):
                        thing.memo.clear()

    # -- what depends on what

    def _graph(self) -> dict[Slot, set[Slot]]:
        """For each slot the slots whose statements name it."""
        users: dict[Slot, set[Slot]] = {}
        for scope in self.world.scopes:
            for slot in scope.slots.values():
                for used in self._named(slot):
                    users.setdefault(used, set()).add(slot)
                holder = scope.declaration.slot if scope.declaration else None
                if holder is not None:  # a data set given as a whole includes all its members
                    users.setdefault(slot, set()).add(holder)
        return users

    def _named(self, slot: Slot) -> set[Slot]:
        named: set[Slot] = set()
        for declaration in slot.declarations:
            named |= self._in_statement(declaration.statement, slot.scope)
            named |= self._in_guard(declaration.guard, slot.scope)
            if declaration.kind == "Template":
                named |= self._in_template(declaration.statement, slot.scope)
        for settings in (slot.settings or {}).values():
            for setting in settings:
                named |= self._in_statement(setting.statement, setting.scope)
                named |= self._in_guard(setting.guard, setting.scope)
        return named

    def _in_statement(self, statement: Statement, scope: Scope) -> set[Slot]:
        named: set[Slot] = set()
        for argument in statement.args[1:]:
            if argument and argument[0] != '"':
                named |= self._in_text(argument, scope)
        return named

    def _in_template(self, statement: Statement, scope: Scope) -> set[Slot]:
        definition = self.expansion.program.definitions.get(statement.arg(3))
        named: set[Slot] = set()
        if definition is not None and definition.statement is not None:
            for text in set(_BRACES.findall(definition.statement.body)):
                named |= self._in_text(text, scope)
        return named

    def _in_guard(self, guard: Guard | None, scope: Scope) -> set[Slot]:
        named: set[Slot] = set()
        while guard is not None:
            named |= self._in_text(guard.condition.arg(0), scope)
            guard = guard.outer
        return named

    def _in_text(self, text: str, scope: Scope) -> frozenset[Slot]:
        key = (id(scope), text)
        found = self._found.get(key)
        if found is None:
            slots = (self.expansion.find(scope, path) for path in set(_PATH.findall(text)))
            found = self._found[key] = frozenset(slot[0] for slot in slots if slot is not None)
        return found

    def _dependents(self, slot: Slot) -> list[Slot]:
        """The slot and all that depend on it, in the order of the text."""
        if self._far:
            return [slot for scope in self.world.scopes for slot in scope.slots.values()]
        reached, waiting = {slot}, [slot]
        while waiting:
            for user in self._users.get(waiting.pop(), ()):
                if user not in reached:
                    reached.add(user)
                    waiting.append(user)
        return [s for scope in self.world.scopes for s in scope.slots.values() if s in reached]
