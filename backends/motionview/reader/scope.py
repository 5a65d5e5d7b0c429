"""Scopes of names: the model, systems, data sets and compound graphics, each with its slots."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from mdlgen.backends.motionview.reader.program import Definition, Guard
from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.statement import Statement

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.world import World

CONSTANTS: dict[str, Any] = {
    "pi": math.pi,
    "rtod": 180 / math.pi,
    "dtor": math.pi / 180,
    "true": True,
    "false": False,
    "solvercr": "\n",
}


class Declaration:
    """One topology statement in one scope. In an if and its else a slot may have several."""

    __slots__ = ("child", "guard", "kind", "members", "pair", "slot", "statement")

    def __init__(self, slot: Slot, statement: Statement, kind: str, pair: bool, guard: Guard | None):
        self.slot = slot
        self.statement = statement
        self.kind = kind
        self.pair = pair
        self.guard = guard
        self.child: Scope | None = None
        self.members: Any = None  # the Thing, or the two of a pair


class Setting(NamedTuple):
    """One Set statement that is about a slot, or about a part of it such as `cm` or `bush`."""

    rank: int  # 0 where the entity is, 1 from elsewhere, 2 in a context: the highest rank counts
    statement: Statement
    scope: Scope
    guard: Guard | None
    side: str  # "", "l" or "r": written in the path of its target


class Slot:
    """A name in a scope, with what declares and what sets it."""

    __slots__ = ("declarations", "name", "scope", "settings", "used")

    def __init__(self, scope: Scope, name: str):
        self.scope = scope
        self.name = name
        self.declarations: list[Declaration] = []
        self.settings: dict[tuple[str, str], list[Setting]] | None = None  # by (kind, part)
        self.used = False


class Parameter(NamedTuple):
    """An argument of a definition: the attachment that declares it, and the value of the instance."""

    attachment: Statement | None
    instance: Statement
    at: int
    external: str = ""  # what it is called in the model that a definition is made for, where that is not here


class Scope:
    """An instance of a definition; the model is the outermost."""

    def __init__(self, world: World, parent: Scope | None, name: str, definition: Definition | None):
        self.world = world
        self.parent = parent
        self.name = name
        self.definition = definition
        self.path = f"{parent.path}{name}." if parent else ""
        self.slots: dict[str, Slot] = {}
        self.parameters: dict[str, Parameter] = {}
        self.declaration: Declaration | None = None  # of the instance itself
        self.known: dict[str, Any] = {}
        self.values: dict[str, Any] = {}  # by expression text
        self.shared: dict[Any, Any] = {}  # by the arguments that many statements have in common
        self.conditions: dict[int, bool] = {}
        self.standard = False  # made by the standard include, which holds more than is known here

    def slot(self, name: str) -> Slot:
        """The slot of a name; a new one where there is none."""
        found = self.slots.get(name)
        if found is None:
            found = self.slots[name] = Slot(self, name)
        return found

    def value_of(self, name: str) -> Any:
        """Value of a name in this scope: its own entities, its arguments, then those of the enclosing
        scopes."""
        if name in self.known:
            return self.known[name]
        value = self.known[name] = self._find(name)
        return value

    def member(self, name: str) -> Any:
        """Value of a name in this scope alone, or None."""
        slot = self.slots.get(name)
        if slot is not None:
            found = self.world.thing(slot)
            if found is not None:
                slot.used = True
                return found
        if name in self.parameters:
            return self.world.argument(self, name)
        return None

    def _find(self, name: str) -> Any:
        scope: Scope | None = self
        while scope is not None:
            found = scope.member(name)
            if found is not None:
                return found
            scope = scope.parent
        low = name.lower()
        if low in ("this", "parent", "model"):
            return self.world.system({"this": self, "parent": self.parent or self}.get(low, self.world.root))
        if low in CONSTANTS:
            return CONSTANTS[low]
        found = self.world.built_in(name)
        if found is not None:
            return found
        raise Trouble("dangling", f"there is no {name}{self._inside()}{self._meant(name)}")

    def _inside(self) -> str:
        return f" in {self.path[:-1]} or around it" if self.path else ""

    def _meant(self, name: str) -> str:
        scope: Scope | None = self
        while scope is not None:
            for other in scope.slots:
                if other != name and other.lower() == name.lower():
                    return f"; names are case sensitive: {other}?"
            scope = scope.parent
        return ""
