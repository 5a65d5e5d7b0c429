"""Statements of which the values say nothing: what they do must be known from elsewhere, or is not known."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from mdlgen.backends.motionview.reader.expand import Expansion
from mdlgen.backends.motionview.reader.settable import acts, harmless
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things import CLASSES

# Things that have a record, or that make bodies that have one; a system shows by what is in it.
_SHOWN = set(CLASSES) - {"ActionReactionForce", "Coupler", "SolverVariable"} | {"DataSet"}
# Blocks and heads that show by what is in them, or in the record of the model.
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
    """One such statement, the definition that it stands in, and the scope of what it sets (`sys_note.`)."""

    statement: Statement
    definition: str
    about: str | None

    @property
    def key(self) -> tuple[str, ...]:
        """The same for statements that differ in blanks and in the case of their name only."""
        return (self.definition, self.statement.key, *("".join(a.split()) for a in self.statement.args))


def remainder(expansion: Expansion) -> Iterator[Rest]:
    """In the order of the text."""
    shown, about = _shown(expansion)
    definitions: list[str] = []
    for statement in expansion.program.statements:
        key = statement.key
        if key == "enddefine" and definitions:
            definitions.pop()
        inside = definitions[-1] if definitions else ""
        if key.startswith("define"):
            definitions.append(statement.arg(0))
            inside = ""  # where a definition stands changes nothing
        if key in _FRAMES or key in _DECORATION or id(statement) in shown:
            continue
        yield Rest(statement, inside, about.get(id(statement)))


def _shown(expansion: Expansion) -> tuple[set[int], dict[int, str]]:
    """Ids of the statements that the values show; for all that set something, where that is."""
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
