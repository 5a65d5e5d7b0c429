"""Lints of an MDL file: numbers of arguments, names, expressions, and known pitfalls."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from mdlgen.backends.motionview.reader import arity
from mdlgen.backends.motionview.reader.expand import Lost
from mdlgen.backends.motionview.reader.report import Notes, Trouble
from mdlgen.backends.motionview.reader.scope import Scope
from mdlgen.backends.motionview.reader.settable import ACTED, NOT_SHOWN, acts, harmless
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things.external import External
from mdlgen.backends.motionview.reader.traps import traps

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.reading import Reading

# Statements whose arguments were all evaluated for the values.
_SEEN = {
    *("point", "pointpair", "vector", "vectorpair", "marker", "markerpair", "polybeam", "template"),
    *("bush", "bushpair", "coilspring", "coilspringpair", "motion", "contact", "graphic", "graphicpair"),
    *("real", "integer", "string", "boolean", "filename", "option", "table"),
    *("setpoint", "setvector", "setorientation", "setbodyinertia", "setbody", "setbodyic", "setbodyicflag"),
    *(
        "setbush",
        "setcoilspring",
        "setcurve",
        "setmotion",
        "setcontact",
        "setcoupler",
        "setpolybeamprops",
        "set",
    ),
    *("setreal", "setinteger", "setstring", "setboolean", "setoption", "setfilename", "setval"),
}
# Statements whose arguments are words for panels and ids, not values of the model.
_WORDS = {
    *("form", "setrowscols", "mergecells", "columnlabel", "columnwidth", "setcell", "report", "setnote"),
    *("attachment", "attachmentcandidate", "setattachmentcandidatetag", "setsystem", "curve"),
    *("setgraphicattributes", "setcolormaterialreference", "setentityid"),
    *("setlocaluserdllflag", "setlocaluserfunction"),
}
_UNUSED = {"Point", "PointPair", "Vector", "VectorPair", "Curve", "Real", "Integer", "String", "Option"}
_KEYWORD = re.compile(r"[A-Z][A-Z0-9_]*\Z|\d[A-Z]\w*\Z")
_WORD = re.compile(r"[A-Za-z_]\w*")
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f]")
_NO_CONTROL = bytes(k for k in range(256) if not _CONTROL.match(chr(k)))


def lint(reading: Reading) -> None:
    """Adds to the notes of a reading whose values were found."""
    notes = reading.notes
    _bytes(reading)
    _arity(reading)
    _includes(reading)
    _standard(reading)
    _duplicates(reading)
    _lost(reading.expansion.lost, notes)
    _unread(reading)
    _references(reading)
    traps(reading.world, notes)
    _unused(reading)


def _bytes(reading: Reading) -> None:
    for source in reading.includes.sources:
        if not source.text.isascii():
            at = next(k for k, c in enumerate(source.text) if ord(c) > 127)
            message = "MotionView writes plain ASCII; this character may not be read"
            reading.notes.add("warning", "ascii", source.place(at), message)
        if source.returns >= 0:
            message = "MotionView ends lines with LF, not CR LF"
            reading.notes.add("warning", "ascii", source.place(source.returns), message)
        if source.marked:
            message = "MotionView writes plain ASCII; here stands a byte order mark"
            reading.notes.add("warning", "ascii", source.place(0), message)
        suspect = source.text.encode(errors="ignore").translate(None, _NO_CONTROL)  # quicker than a search
        if suspect and (control := _CONTROL.search(source.text)) is not None:
            message = f"a control character ({ord(control[0])}); it may end the reading of the file"
            reading.notes.add("warning", "control", source.place(control.start()), message)


def _arity(reading: Reading) -> None:
    for statement in reading.program.statements:
        if not arity.known(statement):
            message = f"*{statement.name} is not a statement that is known; it is left as it is"
            reading.notes.add("warning", "unknown", statement.place(), message + arity.meant(statement))
            continue
        complaint = arity.complaint(statement)
        if complaint:
            reading.notes.add("error", "arity", statement.place(), complaint)


def _includes(reading: Reading) -> None:
    for statement in reading.program.includes:
        if statement.key in ("include", "definitioninclude"):
            reason = reading.includes.reasons.get(id(statement))
            why = f" ({reason})" if reason else ""
            message = f"{statement.arg(0)} is not read{why}; what it makes is not known here"
            reading.notes.add("warning", "include", statement.place(), message)


def _standard(reading: Reading) -> None:
    program = reading.program
    if program.begin is not None and not any(s.key == "standardinclude" for s in program.includes):
        message = "this model has no *StandardInclude(FILE), which makes units, gravity and ground"
        reading.notes.add("warning", "standard", program.begin.place(), message)


def _unread(reading: Reading) -> None:
    """Reports Set statements without effect: of an unknown property, or of an entity of another kind."""
    world = reading.world
    for slot in reading.expansion.slots():
        for (key, part), settings in (slot.settings or {}).items():
            kinds = [d.kind for d in slot.declarations]
            if key not in ACTED or any(acts(kind, key, part) for kind in kinds):
                continue
            if any((kind, key) in NOT_SHOWN for kind in kinds):
                continue
            for setting in settings:
                statement = setting.statement
                stands = world.holds(setting.guard, setting.scope) and world.alive(setting.scope)
                if harmless(statement, part) or not stands:
                    continue
                message = f"what *{statement.name} of {statement.arg(0)} does is not known; no value shows it"
                reading.notes.add("warning", "unread", statement.place(), message)


def _duplicates(reading: Reading) -> None:
    world = reading.world
    for scope in world.scopes:
        for slot in scope.slots.values():
            if len(slot.declarations) < 2:
                continue
            standing = [d for d in slot.declarations if world.holds(d.guard, scope)]
            for declaration in standing[1:]:
                here = declaration.statement.place(0)
                first = standing[0].statement.place().seen_from(here.file)
                message = f"{scope.path}{slot.name} is there already, from {first}"
                reading.notes.add("error", "duplicate", here, message)


def _lost(lost: list[Lost], notes: Notes) -> None:
    for statement, scope, external in lost:
        target = statement.arg(0)
        if external:
            message = f"{target} is made by {external}; what is set here cannot be checked"
            notes.add("warning", "external", statement.place(0), message)
        else:
            inside = f" in {scope.path[:-1]}" if scope.path else ""
            notes.add("error", "dangling", statement.place(0), f"there is no {target}{inside} to set")


def _references(reading: Reading) -> None:
    """Evaluates statements that the values did not need: outputs, forces, variables, arguments of
    instances."""
    world = reading.world
    externals = _externals(reading)
    for statement, scope, guard in reading.expansion.standing:
        key = statement.key
        if key in _WORDS or not arity.known(statement):
            continue
        first = _first_value(reading, statement)
        if first is None:
            continue
        if world.holds(guard, scope) and world.alive(scope):
            for k in range(first, len(statement.args)):
                if (id(statement), k) in externals:
                    continue
                _argument(reading, statement, k, scope)
    for scope in world.scopes:
        if scope.declaration is not None and world.alive(scope):
            _parameters(reading, scope)


def _externals(reading: Reading) -> set[tuple[int, int]]:
    """Reports the attachments in another model; returns the arguments (statement, index) that name them."""
    found = set()
    for scope in reading.world.scopes:
        for parameter in scope.parameters.values():
            if parameter.external and reading.world.alive(scope):
                trouble = External(parameter, parameter.external).trouble()
                reading.notes.add_trouble(trouble, parameter.instance.place())
                found.add((id(parameter.instance), parameter.at))
    return found


def _first_value(reading: Reading, statement: Statement) -> int | None:
    """The first argument that must be checked; None where the values have used them all."""
    key = statement.key
    if key in ("system", "analysis", "dataset"):
        return 3
    if key in ("graphic", "graphicpair") and statement.arg(2) in reading.program.definitions:
        return 3
    if key in ("body", "bodypair"):
        return 3 if any(statement.args[3:]) else None
    if key in _SEEN:
        return None
    return 1 if key.startswith("set") else 2


def _argument(reading: Reading, statement: Statement, index: int, scope: Scope) -> None:
    text = statement.args[index]
    if not text or text[0] == '"' or _KEYWORD.match(text):
        return
    try:
        reading.world.force(lambda: reading.world.value(statement, index, scope))
    except Trouble as trouble:
        reading.notes.add_trouble(trouble, statement.place(index))
    except RecursionError:
        reading.notes.add("error", "evaluate", statement.place(index), "this depends on too many others")


def _parameters(reading: Reading, scope: Scope) -> None:
    assert scope.declaration is not None
    if scope.declaration.statement.key != scope.declaration.kind.lower():  # of a definition that stands alone
        return
    given = len(scope.declaration.statement.args) - 3
    if scope.declaration.kind == "System" and given < len(scope.parameters):
        left = ", ".join(list(scope.parameters)[given:])
        message = f"{scope.path[:-1]} is given no {left}; the defaults of these attachments count"
        reading.notes.add("warning", "attachment", scope.declaration.statement.place(), message)
    if scope.declaration.kind != "Graphic" and given > len(scope.parameters) and scope.definition is not None:
        message = f"{scope.definition.name} takes {len(scope.parameters)} attachments, not {given}"
        reading.notes.add("error", "arity", scope.declaration.statement.place(), message)


def _unused(reading: Reading) -> None:
    words: set[str] = set()
    for definition in reading.program.definitions.values():
        if definition.statement is not None and definition.statement.body:
            words |= set(_WORD.findall(definition.statement.body))
        if definition.kind in ("form", "tableform", "report"):
            for item in definition.items:
                words |= {word for arg in item.statement.args for word in _WORD.findall(arg)}
    world = reading.world
    for scope in world.scopes:
        if scope.standard or not world.alive(scope):
            continue
        for slot in scope.slots.values():
            if slot.used or slot.name in words:
                continue
            declaration = world.declaration(slot)
            if declaration is None or declaration.statement.name not in _UNUSED:
                continue
            if declaration.statement.args[-1].upper() == "NO_EDIT":  # made to be looked at
                continue
            message = f"{scope.path}{slot.name} is used by nothing"
            reading.notes.add("warning", "unused", declaration.statement.place(0), message)
    used = {s.arg(k) for s in reading.program.statements for k in (2, 3) if s.key in _USERS}
    for name, definition in reading.program.definitions.items():
        if not definition.used and name not in used and definition.statement is not None:
            message = f"the definition {name} is used by nothing"
            reading.notes.add("warning", "unused", definition.statement.place(0), message)


_USERS = {"form", "template", "report", "table", "setcell", "analysis", "system", "dataset", "graphic"}
