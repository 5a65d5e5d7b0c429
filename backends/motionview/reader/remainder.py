"""Statements that the values do not represent: their effect must be known from elsewhere, or is unknown."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from mdlgen.backends.motionview.reader.expand import Expansion
from mdlgen.backends.motionview.reader.settable import acts, harmless
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things import CLASSES

# Entities that have a record, or that make bodies with one; a system is represented by its contents.
_SHOWN = set(CLASSES) - {"ActionReactionForce", "Coupler", "SolverVariable"} | {"DataSet"}
# Blocks and heads that are represented by their contents, or in the record of the model.
_FRAMES = {
    *("beginmdl", "endmdl", "enddefine", "begincontext", "endcontext", "definedataset", "definetemplate"),
    *("standardinclude", "setcurrentsolvermode"),
}
# Statements for panels, graphics and ids.
_DECORATION = {
    *("form", "defineform", "setrowscols", "mergecells", "columnlabel", "columnwidth", "setcell", "setnote"),
    *("setgraphicattributes", "setcolormaterialreference", "setentityid", "loadpreferencefile"),
}


class Rest(NamedTuple):
    """One such statement, the definition around it, and the scope of the entity that it sets
    (`sys_note.`)."""

    statement: Statement
    definition: str
    about: str | None

    @property
    def key(self) -> tuple[str, ...]:
        """Key for comparison; it ignores blanks and the case of the statement's name."""
        return (self.definition, self.statement.key, *("".join(a.split()) for a in self.statement.args))


def remainder(expansion: Expansion) -> Iterator[Rest]:
    """The statements that the values do not represent, in the order of the file."""
    shown, about = _shown(expansion)
    definitions: list[str] = []
    for statement in expansion.program.statements:
        key = statement.key
        if key == "enddefine" and definitions:
            definitions.pop()
        inside = definitions[-1] if definitions else ""
        if key.startswith("define"):
            definitions.append(statement.arg(0))
            inside = ""  # the place of a definition has no influence
        if key in _FRAMES or key in _DECORATION or id(statement) in shown:
            continue
        yield Rest(statement, inside, about.get(id(statement)))


def _shown(expansion: Expansion) -> tuple[set[int], dict[int, str]]:
    """Ids of the statements that the values represent; and for all Set statements, the scope of their
    target."""
    shown: set[int] = set()
    about: dict[int, str] = {}
    for slot in expansion.slots():
        shown.update(id(d.statement) for d in slot.declarations if d.kind in _SHOWN)
        for (key, part), settings in (slot.settings or {}).items():
            acted = any(acts(d.kind, key, part) for d in slot.declarations)
            for setting in settings:
                about[id(setting.statement)] = slot.scope.path
                if acted or harmless(setting.statement, part):
                    shown.add(id(setting.statement))
    return shown, about
