"""Values that a user sets: reals, integers, texts, options, and the data sets and tables that hold them."""

from __future__ import annotations

from typing import Any

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.thing import Thing

_DEFAULTS: dict[str, Any] = {"Real": 0.0, "Integer": 0.0, "String": "", "Boolean": False, "Filename": ""}


class Value(Thing):
    """A real, integer, text or truth value."""

    kind = "Value"
    complete = True
    setters = ("setreal", "setinteger", "setstring", "setboolean", "setfilename", "setval")

    def p_value(self) -> Any:
        """As it was set; 0 or an empty text where it was not."""
        found = [s for kind in self.setters for s in (*self.settings(kind), *self.settings(kind, "value"))]
        if not found:
            return _DEFAULTS.get(self.declaration.kind, 0.0)
        setting = max(enumerate(found), key=lambda item: (item[1].rank, item[0]))[1]
        value = self.world.value(setting.statement, 1, setting.scope)
        due = str if self.declaration.kind in ("String", "Filename") else (float, bool)
        if not isinstance(value, due) and not isinstance(value, str):
            raise self.wrong(setting.statement, 1, "a value", value)
        return value

    def p_base(self) -> str:
        """A file name without its folders and ending."""
        return str(self.ask("value")).replace("\\", "/").rpartition("/")[2].rpartition(".")[0]


class Option(Thing):
    """`*Option( name, label, n, text_1, ..., text_n, number_1, ..., key_1, ..., EDIT )`."""

    kind = "Option"
    complete = True

    def p_labels(self) -> tuple[Any, ...]:
        count = max(0, min(int(self.number(2)), len(self.statement.args)))
        return tuple(self.given(3 + k) for k in range(count))

    def p_current_index(self) -> float:
        """Index of the chosen option, from 0; the first where none is chosen."""
        found = self.settings("setoption")
        if not found:
            return 0.0
        setting = found[-1]
        wanted = self.world.value(setting.statement, 1, setting.scope)
        labels = self.ask("labels")
        if wanted in labels:
            return float(labels.index(wanted))
        trouble = Trouble("option", f"{self} has no choice {wanted!r}; it has {', '.join(map(repr, labels))}")
        trouble.place = setting.statement.place(1)
        raise trouble

    def p_value(self) -> Any:
        """The text of the choice."""
        labels = self.ask("labels")
        if not labels:
            raise Trouble("option", f"{self} has no choices")
        return labels[int(self.ask("current_index"))]

    def p_ival(self) -> float:
        """The number of the choice; where the statement has none, its place from 1."""
        index, count = int(self.ask("current_index")), len(self.ask("labels"))
        at = 3 + count + index
        if len(self.statement.args) >= 3 + 2 * count and count:
            return self.number(at)
        return index + 1.0


class StandardOption(Option):
    """An option of the standard include, `*StandardOption( name, label, text, EDIT )`, choices unknown."""

    def p_value(self) -> Any:
        """As it was set, else the text of its statement."""
        found = self.settings("setoption")
        return self.world.value(found[-1].statement, 1, found[-1].scope) if found else self.given(2)


class BuiltInOption(Thing):
    """Op_Compliant of the standard include: Yes, as in the exports that do not set it."""

    kind = "Option"

    def p_value(self) -> Any:
        found = self.settings("setoption")
        return self.world.value(found[-1].statement, 1, found[-1].scope) if found else "Yes"

    def p_label(self) -> str:
        return "Compliant"


class Table(Thing):
    """`*Table( name, label, record, n )`: rows of a record; columns by name, cells by name and row."""

    kind = "Table"

    def p_numrecs(self) -> float:
        found = self.settings("set", "numrecs")
        if found:
            return float(self.world.value(found[-1].statement, 1, found[-1].scope))
        return self.number(3)

    def attribute(self, key: str, name: str, shift: int) -> Any:
        if key in ("numrecs", "label") or self._definition() is None:
            return super().attribute(key, name, shift)
        if name in self.columns():
            return Column(self, name)
        return super().attribute(key, name, shift)

    def _definition(self) -> Any:
        return self.world.program.definitions.get(self.statement.arg(2))

    def columns(self) -> list[str]:
        """Names of the columns."""
        definition = self._definition()
        return [item.statement.arg(0) for item in definition.items] if definition else []

    def cells(self, column: str) -> tuple[Any, ...]:
        """A column; 0 where a cell is not set."""
        found = []
        for row in range(min(int(self.ask("numrecs")), 10_000)):
            settings = [s for kind in Value.setters for s in self.settings(kind, f"{column}[{row}]")]
            last = max(enumerate(settings), key=lambda i: (i[1].rank, i[0]))[1] if settings else None
            found.append(self.world.value(last.statement, 1, last.scope) if last else 0.0)
        return tuple(found)


class Column:
    """A column of a table; `.value` is all of it."""

    def __init__(self, table: Table, name: str):
        self.table = table
        self.column = name

    def __str__(self) -> str:
        return f"column {self.column} of {self.table}"

    def attribute(self, key: str, name: str, shift: int) -> Any:
        """`table.column.value`."""
        if key in ("value", "data"):
            return self.table.cells(self.column)
        raise Trouble("property", f"{self} has no {name}", shift)
