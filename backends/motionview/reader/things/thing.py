"""Base class of all entities: a name, a label, a place, and properties that are evaluated on demand.

A property `x` is a method `p_x`; the World caches its value.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar

from mdlgen.backends.motionview.reader.operators import named
from mdlgen.backends.motionview.reader.pair import Pair, Unmade
from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.world import Vector

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.scope import Declaration, Scope, Setting
    from mdlgen.backends.motionview.reader.world import World

SIDES = {"LEFT": "l", "RIGHT": "r"}
SIDE_LABELS = {"": "", "l": "-left", "r": "-right"}


class Identifier(str):
    """The id of an entity, which only MotionView knows; here it is the full name."""


class Thing:
    """An entity, or one of the two of a pair (`side` l or r)."""

    kind: ClassVar[str] = "entity"
    complete: ClassVar[bool] = False  # all its properties are known, so that another one is an error

    def __init__(self, world: World, declaration: Declaration, side: str):
        self.world = world
        self.declaration = declaration
        self.statement: Statement = declaration.statement
        self.scope: Scope = declaration.slot.scope
        self.side = side
        self.memo: dict[str, Any] = {}
        self.call(self.scope.path + declaration.slot.name)

    # -- names

    def call(self, base: str) -> None:
        """Full name as in the solver deck, without MODEL: `sys_a.b_wheel.l`; `base` is without the side."""
        self.base = base
        self.name = f"{base}.{self.side}" if self.side else base

    def __str__(self) -> str:
        return f"{self.kind} {self.name}"

    def p_label(self) -> str:
        """With -left or -right, as MotionView has it."""
        label = self.world.value(self.statement, 1, self.scope) if self.statement.arg(1) else ""
        return (label if isinstance(label, str) else str(label)) + SIDE_LABELS[self.side]

    # -- properties

    def ask(self, key: str) -> Any:
        """A property, from the cache if it is known."""
        return self.world.demand(self, key)

    def compute(self, key: str) -> Any:
        """Finds a property; the World calls this once."""
        try:
            return getattr(self, "p_" + key)()
        except Trouble as trouble:
            if trouble.place is None:
                trouble.place = self.statement.place()
            raise

    def attribute(self, key: str, name: str, shift: int) -> Any:
        """`thing.name` in an expression."""
        if hasattr(self, "p_" + key):
            return self.ask(key)
        if key in ("l", "r"):  # a single entity in place of a pair is both
            return self
        if key in ("id", "idstring"):
            return Identifier(self.name)
        if key in ("full_varname", "varname"):
            return f"MODEL.{self.name}" if key[0] == "f" else self.declaration.slot.name
        if key == "state":
            return True
        found = self.world.settings(self.declaration.slot, "set", key)
        if found:
            return self.world.value(found[-1].statement, 1, found[-1].scope)
        severity = "error" if self.complete else "warning"
        raise Trouble("property", f"{self} has no property {name} that is known", shift, severity)

    # -- arguments

    def twin(self) -> Thing:
        """The entity on the other side."""
        members = self.declaration.members
        return members.r if self.side == "l" else members.l

    def own(self, value: Any) -> Any:
        """The value of this side, where it is a pair."""
        if value.__class__ is not Pair:
            return value
        if not self.side:
            raise Trouble("pair", f"{value} stands where one is due; add .l or .r")
        return value.r if self.side == "r" else value.l

    def given(self, index: int, statement: Statement | None = None, scope: Scope | None = None) -> Any:
        """The value of an argument, of this side."""
        statement = statement or self.statement
        try:
            value = self.world.value(statement, index, scope or self.scope)
            return value if value.__class__ is not Pair else self.own(value)
        except Trouble as trouble:
            if trouble.place is None:
                trouble.place = statement.place(index)
            raise

    def number(self, index: int, statement: Statement | None = None, scope: Scope | None = None) -> float:
        """A number; 0 where the argument is empty."""
        statement = statement or self.statement
        if not statement.arg(index):
            return 0.0
        value = self.given(index, statement, scope)
        if isinstance(value, (float, bool)):
            return float(value)
        raise self.wrong(statement, index, "a number", value)

    def position(self, index: int, statement: Statement | None = None, scope: Scope | None = None) -> Vector:
        """Where a point is."""
        value = self.given(index, statement, scope)
        if value.__class__ is tuple:
            return self.world.vector(value)
        if getattr(value, "kind", "") == "Point":
            return value.ask("data")
        raise self.wrong(statement or self.statement, index, "a point", value)

    def related(self, index: int, *kinds: str) -> Any:
        """An entity of one of the kinds."""
        value = self.given(index)
        if getattr(value, "kind", "") in kinds:
            return value
        if isinstance(value, Unmade):
            message = f"{value.name} is made by {value.why}"
            raise Trouble("external", message, severity="warning")
        raise self.wrong(self.statement, index, "a " + " or a ".join(kinds), value)

    def wrong(self, statement: Statement, index: int, due: str, value: Any) -> Trouble:
        """The error for an argument of another kind than is due."""
        message = f"argument {index + 1} of *{statement.name} is {named(value)}; {due} is due"
        trouble = Trouble("kind", message)
        if isinstance(value, Unmade):
            trouble.severity = "warning"
            trouble.code = "external"
        trouble.place = statement.place(index)
        return trouble

    # -- settings

    def settings(self, kind: str, part: str = "") -> list[Setting]:
        """The Set statements of this entity, the effective one last."""
        return self.world.settings(self.declaration.slot, kind, part)

    def chosen(self, kind: str, part: str = "", symmetric: bool = False) -> Chosen | None:
        """The Set statement that counts for this side; of a symmetric pair the left one leads."""
        found = self.world.settings(self.declaration.slot, kind, part)
        if not found:
            return None
        if not self.side:
            return Chosen(found[-1], 1, "", False)
        sides = [(s, _side(s)) for s in found]
        order = ("l", "r") if symmetric else (self.side, "r" if self.side == "l" else "l")
        for wanted in order:
            for setting, side in reversed(sides):
                if side in (wanted, "both"):
                    if side == "both":
                        return Chosen(setting, 2, self.side, False)
                    first = 1 if setting.side else 2
                    return Chosen(setting, first, side, side != self.side)
        return None

    def shared(self, scope: Scope, key: tuple[Any, ...], find: Callable[[], Any]) -> Any:
        """A value that depends only on some arguments: computed once for all statements with the same
        ones."""
        whole = (self.side, key)
        found = scope.shared.get(whole, self)
        if found is self:
            found = scope.shared[whole] = find()
        return found

    def flag(self, name: str) -> bool:
        """A truth value that *Set( entity.name, true ) gave."""
        found = self.settings("set", name)
        return bool(found) and self.world.value(found[-1].statement, 1, found[-1].scope) is True

    def record(self) -> dict[str, Any]:
        """Record of the entity in the list of values."""
        return {}

    def markers(self) -> list[Any]:
        """The markers that MotionView makes for it."""
        return []

    def marker_records(self) -> list[tuple[str, dict[str, Any]]]:
        """Their names and their records in the list of values."""
        return [(m.name, m.record()) for m in self.markers()]


class Chosen:
    """A Set statement, where its numbers begin, for which side they are, and whether to mirror them."""

    __slots__ = ("first", "mirrored", "scope", "side", "statement")

    def __init__(self, setting: Setting, first: int, side: str, mirrored: bool):
        self.statement = setting.statement
        self.scope = setting.scope
        self.first = first
        self.side = side
        self.mirrored = mirrored


def _side(setting: Setting) -> str:
    if setting.side:
        return setting.side
    word = setting.statement.arg(1)
    return SIDES.get(word.upper(), "both")


def mirrored(v: Vector) -> Vector:
    """About the XZ plane."""
    return (v[0], -v[1] + 0.0, v[2])
