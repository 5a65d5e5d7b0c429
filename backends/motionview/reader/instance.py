"""An instance of a definition, seen from outside: its attachments, and the statements that act on it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from mdlgen.backends.motionview.reader.expand import Expansion
from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.scope import Scope
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things.joints import JOINTS

_PATH = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")
# Statements that only read an entity, or pass it on.
_LOOKING = {
    *("point", "pointpair", "vector", "vectorpair", "marker", "markerpair", "body", "bodypair", "graphic"),
    *("graphicpair", "output", "system", "analysis", "dataset", "template", "form", "report", "attachment"),
    *("solvervariable", "solverstring", "solverarray"),
}
_MOVED = {"Body", "Marker", "Bush", "Motion", "Contact", "DeformableSurface", *JOINTS}


class Attached(NamedTuple):
    """An attachment: its name inside, kind and default, and the entity of the instance (None: unknown)."""

    name: str
    kind: str
    default: str
    given: str | None


def attachments(expansion: Expansion, path: str) -> list[Attached]:
    """Attachments of the instance whose entities have names that begin with `path` (`sys_note.`)."""
    found = []
    for scope in _scopes(expansion, path):
        for name, parameter in scope.parameters.items():
            declared = parameter.attachment
            kind, default = (declared.arg(2), declared.arg(4)) if declared is not None else ("", "")
            found.append(Attached(name, kind, default, _given(expansion, scope, name)))
    return found


def _scopes(expansion: Expansion, path: str) -> Iterator[Scope]:
    return (scope for scope in expansion.world.scopes if scope.path == path)


def _given(expansion: Expansion, scope: Scope, name: str) -> str | None:
    world = expansion.world
    try:
        return str(getattr(world.force(lambda: world.argument(scope, name)), "name", "")) or None
    except Trouble:  # reported where the values are found
        return None


def acting_on(expansion: Expansion, path: str) -> list[Statement]:
    """Statements around an instance that name its bodies, or their owners, and may move or stop them."""
    found = []
    for statement, scope, guard in expansion.standing:
        key = statement.key
        if key in _LOOKING or key.startswith("set") or scope.path.startswith(path):
            continue
        words = {w for a in statement.args if a[:1] != '"' for w in _PATH.findall(a)}
        if not any(_inside(expansion, scope, word, path) for word in words):
            continue
        if expansion.world.holds(guard, scope) and expansion.world.alive(scope):
            found.append(statement)
    return found


def _inside(expansion: Expansion, scope: Scope, word: str, path: str) -> bool:
    found = expansion.find(scope, word)
    if found is None or not found[0].scope.path.startswith(path):
        return False
    return any(d.kind in _MOVED for d in found[0].declarations)
