"""Program -> World: one scope for each instance, its slots, and the Set statements of each slot."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from mdlgen.backends.motionview.reader import things
from mdlgen.backends.motionview.reader.pair import Unmade
from mdlgen.backends.motionview.reader.program import Definition, Guard, Item, Program
from mdlgen.backends.motionview.reader.report import Notes
from mdlgen.backends.motionview.reader.scope import Declaration, Parameter, Scope, Setting, Slot
from mdlgen.backends.motionview.reader.standard import AT_MODEL, HOLDER, standard
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things import BUILT_INS, CLASSES
from mdlgen.backends.motionview.reader.world import World
from mdlgen.errors import SpecError

# Most statements after expansion, as a number and relative to those of the file: nested definitions multiply.
MOST_STATEMENTS = 100_000
MOST_TIMES = 20
STANDARD = ("sys_misc", "Solver_Filename", "DS_MotionSolve_Simopts", "SolverMode")
_NAME = re.compile(r"[A-Za-z_]\w*\Z")
_PATH = re.compile(r"[A-Za-z_]\w*(?:\s*\[\s*\d+\s*\])?(?:\s*\.\s*[A-Za-z_]\w*(?:\s*\[\s*\d+\s*\])?)*\s*\.?\Z")
_RELATIVE = ("model", "this", "parent")  # words that a path may begin with
_NO_ENTITY = {"attachment", "setrowscols", "mergecells", "columnlabel", "columnwidth", "setcell"}


class Lost(NamedTuple):
    """A Set statement whose target is in no scope."""

    statement: Statement
    scope: Scope
    external: str  # reason why its values are unknown, or an empty text


class Expansion:
    """The World while it is built."""

    def __init__(self, program: Program, notes: Notes):
        self.program = program
        self.notes = notes
        self.world = World(program, notes, things)
        self.standard = Scope(self.world, None, "", None)  # what the standard include makes
        self.standard.standard = True
        self._standard: dict[str, Definition] = {}
        self.sets: list[tuple[Statement, Scope, Guard | None, int]] = []
        self.lost: list[Lost] = []
        self.standing: list[tuple[Statement, Scope, Guard | None]] = []  # all statements in a living scope
        self._count = 0

    def run(self) -> World:
        """Builds the World. Raises SpecError for a file with too many statements after expansion."""
        made = self._built_ins()
        most = MOST_STATEMENTS + MOST_TIMES * len(self.program.statements)
        tasks = [(self.world.root, self.program.model)]
        tasks += [(self._alone(definition), definition) for definition in self.program.alone()]
        tasks += made
        contexts: list[Item] = []
        while tasks:
            scope, definition = tasks.pop()
            inner: list[tuple[Scope, Definition]] = []
            for item in definition.items:
                self._count += 1
                if self._count > most:
                    message = f"the definitions of this text make more than {most} statements of it"
                    raise SpecError(message, place=item.statement.place())
                if item.contexts:
                    contexts.append(item)
                else:
                    self._place(item.statement, item.guard, scope, 0, inner)
            tasks += reversed(inner)
        if self.program.begin is None:
            self._declared()
        self._contexts(contexts)
        for statement, scope, guard, rank in self.sets:
            self._set(statement, scope, guard, rank)
        return self.world

    # -- statements

    def _place(
        self,
        statement: Statement,
        guard: Guard | None,
        scope: Scope,
        rank: int,
        inner: list[tuple[Scope, Definition]],
    ) -> None:
        key = statement.key
        if key in _NO_ENTITY:
            return
        self.standing.append((statement, scope, guard))
        if key.startswith("set"):
            self.sets.append((statement, scope, guard, rank))
            return
        name = statement.arg(0)
        if not _NAME.match(name) or len(statement.args) < 2:
            return
        kind, pair = _kind(statement.name)
        slot = scope.slot(name)
        declaration = Declaration(slot, statement, kind, pair, guard)
        slot.declarations.append(declaration)
        if kind in ("System", "Analysis", "DataSet", "Graphic"):
            self._instance(declaration, scope, inner)

    def _instance(
        self, declaration: Declaration, scope: Scope, inner: list[tuple[Scope, Definition]]
    ) -> None:
        statement, name = declaration.statement, declaration.slot.name
        wanted = statement.arg(2)
        definition = self.program.definitions.get(wanted)
        if definition is None and scope.standard:
            definition = self._standard.get(wanted)
        if definition is None or definition.kind != declaration.kind.lower():
            if declaration.kind != "Graphic":
                self._undefined(declaration)
            return
        definition.used = True
        above: Scope | None = scope
        while above is not None:
            if above.definition is definition:
                message = f"{definition.name} holds an instance of itself"
                self.notes.add("error", "cycle", statement.place(2), message)
                return
            above = above.parent
        child = Scope(self.world, scope, name, definition)
        child.standard = scope.standard
        child.declaration = declaration
        declaration.child = child
        self.world.scopes.append(child)
        attachments = definition.attachments()
        for k, parameter in enumerate(definition.parameters):
            child.parameters[parameter] = Parameter(attachments.get(parameter), statement, 3 + k)
        inner.append((child, definition))

    def _alone(self, definition: Definition) -> Scope:
        """An instance of a definition whose attachments are in the model that it is made for."""
        made_by = definition.statement
        assert made_by is not None
        root, name = self.world.root, definition.name.removeprefix("def_")
        if name in root.slots:
            name = definition.name
        definition.used = True
        slot = root.slot(name)
        declaration = Declaration(slot, made_by, "System", False, None)
        slot.declarations.append(declaration)
        child = declaration.child = Scope(self.world, root, name, definition)
        child.declaration = declaration
        self.world.scopes.append(child)
        attachments = definition.attachments()
        for parameter in definition.parameters:
            attachment = attachments.get(parameter)
            default = attachment.arg(4) if attachment is not None else ""
            external = "" if default and self.find(root, default) is not None else default or parameter
            child.parameters[parameter] = Parameter(attachment, made_by, len(made_by.args), external)
        return child

    def _declared(self) -> None:
        """For a part of a model: declares the entities of attachments by the names in the instance."""
        for scope in self.world.scopes:
            for name, parameter in scope.parameters.items():
                given, attachment = parameter.instance.arg(parameter.at), parameter.attachment
                declared = attachment is not None and given and attachment.arg(4) == given
                if declared and not parameter.external and self.find(scope.parent, given) is None:
                    scope.parameters[name] = parameter._replace(external=given)

    def _undefined(self, declaration: Declaration) -> None:
        statement = declaration.statement
        wanted = statement.arg(2)
        if self.program.includes and any(s.key != "standardinclude" for s in self.program.includes):
            message = f"{wanted} is defined in no text that was read; a missing include may define it"
            self.notes.add("warning", "external", statement.place(2), message)
        else:
            message = f"there is no definition {wanted or 'given'} of a {declaration.kind}"
            self.notes.add("error", "dangling", statement.place(2), message)

    # -- contexts

    def _contexts(self, items: list[Item]) -> None:
        inner: list[tuple[Scope, Definition]] = []
        for item in items:
            scope: Scope | None = self.world.root
            for context in item.contexts:
                found = self.find(scope, context.arg(0)) if scope is not None else None
                declaration = found[0].declarations[0] if found and found[0].declarations else None
                scope = declaration.child if declaration else None
                if scope is None:
                    self._no_context(context, declaration)
                    break
            if scope is not None:
                self._place(item.statement, item.guard, scope, 2, inner)
        for scope, definition in inner:  # entities that a context adds: no deeper ones are known
            for item in definition.items:
                self._place(item.statement, item.guard, scope, 0, [])

    def _no_context(self, context: Statement, declaration: Declaration | None) -> None:
        if declaration is not None or self._has_unknown_definitions():
            message = f"nothing is known of what is in {context.arg(0)}; the statements in this context wait"
            self.notes.add("warning", "external", context.place(0), message)
        else:
            self.notes.add("error", "dangling", context.place(0), f"there is no {context.arg(0)} here")

    def _has_unknown_definitions(self) -> bool:
        return any(s.key not in ("standardinclude", "loadpreferencefile") for s in self.program.includes)

    # -- settings

    def _set(self, statement: Statement, scope: Scope, guard: Guard | None, rank: int) -> None:
        target = statement.arg(0)
        if not _PATH.match(target):
            return
        found = self.find(scope, target)
        if found is None:
            if target.partition(".")[0].strip() not in STANDARD:
                self.lost.append(Lost(statement, scope, self._why_unknown(scope, target)))
            return
        slot, rest = found
        if rest and slot.declarations[:1] and slot.declarations[0].child is not None and slot.scope.standard:
            return  # of the standard include, and not known
        side = ""
        if rest:
            for word in ("l", "r"):
                if word in rest:
                    side = word
                    rest.remove(word)
        key = statement.key
        part = ".".join(rest)
        owner = slot.scope
        if rank == 0 and owner is not scope and owner.parent is not scope:
            rank = 1
        if slot.settings is None:
            slot.settings = {}
        settings = slot.settings.setdefault((key, part), [])
        settings.append(Setting(rank, statement, scope, guard, side))
        if len(settings) > 1 and settings[-2].rank > rank:
            settings.sort(key=lambda s: s.rank)

    def find(self, scope: Scope | None, path: str) -> tuple[Slot, list[str]] | None:
        """The slot to which a path leads, with the rest of the path; conditions are not evaluated."""
        if scope is not None and path.isidentifier() and path.lower() not in _RELATIVE:
            own = scope.slots.get(path)
            if own is not None:  # the most frequent case
                return own, []
        words = [w.strip().replace(" ", "") for w in path.split(".") if w.strip()]
        if words and words[0].lower() in AT_MODEL and words[0] not in self.world.root.slots:
            words = [HOLDER, words[0].lower(), *words[1:]]
        at: Scope | None = scope
        while words and words[0].lower() in _RELATIVE and at is not None:
            low = words.pop(0).lower()
            at = self.world.root if low == "model" else at.parent if low == "parent" else at
        if not words or at is None:
            return None
        slot: Slot | None = None
        while at is not None:
            slot = at.slots.get(words[0])
            if slot is not None or words[0] in at.parameters:
                break
            at = at.parent
        if slot is None and at is None:
            slot = self.standard.slots.get(words[0])
            if slot is None:
                return None
        if slot is None:
            assert at is not None
            parameter = at.parameters[words[0]]
            if parameter.external:
                return None
            actual = parameter.instance.arg(parameter.at) or (
                parameter.attachment.arg(4) if parameter.attachment else ""
            )
            if not _PATH.match(actual) or at.parent is None:
                return None
            return self.find(at.parent, ".".join((actual, *words[1:])))
        rest = words[1:]
        while rest:
            child = next((d.child for d in slot.declarations if d.child is not None), None)
            below = child.slots.get(rest[0]) if child else None
            if below is None:
                break
            slot = below
            rest.pop(0)
        holds = slot.declarations and slot.declarations[0].kind in ("System", "Analysis", "DataSet")
        if holds and rest and rest[0] not in ("l", "r", "cm") and slot.declarations[0].child is None:
            return None
        return slot, rest

    def slots(self) -> Iterator[Slot]:
        """All names of all scopes, including those of the standard include."""
        for scope in (self.standard, *self.world.scopes):
            yield from scope.slots.values()

    def _why_unknown(self, scope: Scope, target: str) -> str:
        first = target.split(".")[0].strip()
        if first.lower() == "model" or scope.standard:
            return "the standard include"
        around: Scope | None = scope
        while around is not None and first not in around.parameters:
            around = around.parent
        if around is not None and around.parameters[first].external:
            return "the model that this text is made for"
        found = self.find(scope, first)
        if found and found[0].declarations and found[0].declarations[0].child is None:
            return f"an instance of {found[0].declarations[0].statement.arg(2)}"
        return ""

    # -- what the standard include makes

    def _built_ins(self) -> list[tuple[Scope, Definition]]:
        """Makes the entities of the standard include; returns the systems among them that are still empty."""
        world = self.world
        begin = self.program.begin
        if begin is None and self.program.statements:  # a part of a model, which has these all the same
            begin = Statement(self.program.statements[0].source, "BeginMDL", ("",), 0, 0)
        inner: list[tuple[Scope, Definition]] = []
        if begin is None:
            return inner
        holder = self.standard
        for name, made_by in BUILT_INS.items():
            declaration = Declaration(holder.slot(name), begin, name, False, None)
            declaration.members = made_by(world, declaration, "")
            world.built_ins[name] = declaration.members
        for name in STANDARD:
            world.built_ins[name] = Unmade(name, "the standard include")
        if self.program.begin is not None and any(s.key == "standardinclude" for s in self.program.includes):
            self._standard_systems(inner)
        world.built_ins["SolverMode"] = self.program.mode
        if begin.arg(0):
            world.built_ins.setdefault(begin.arg(0), world.system(world.root))
        return inner

    def _standard_systems(self, inner: list[tuple[Scope, Definition]]) -> None:
        """Makes gravity and units: the entities of the standard include that a file may set."""
        made = standard()
        self._standard = made.definitions
        for item in made.model.items:
            self._place(item.statement, None, self.standard, 0, inner)
        for scope, _ in inner:
            scope.parent = self.world.root
            self.world.built_ins[HOLDER] = self.world.system(scope)


# The usual spelling of statements, which are not case sensitive.
_KINDS = {name.lower(): name for name in (*CLASSES, "System", "Analysis", "DataSet")}


@lru_cache(256)
def _kind(name: str) -> tuple[str, bool]:
    """Kind of entity that a statement makes, and true if it makes a pair."""
    pair = name.lower().endswith("pair")
    name = name[:-4] if pair else name
    return _KINDS.get(name.lower(), name), pair


def expand(program: Program, notes: Notes) -> Expansion:
    """The World of a program, with the Set statements whose target is in no scope."""
    made = Expansion(program, notes)
    made.run()
    return made
