"""A text, its script, its deck and the script for MotionSolve against the Model: read back and compared, each
value of the text changed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.tables import Model
from mdlgen.registry import DECK, SCRIPT, emitter
from mdlgen.spec.scene import Scene
from mdlgen.verify.expected.contacts import CONTACT_NUMBERS, contact_outputs
from mdlgen.verify.expected.parts.mesh import mesh_shapes
from mdlgen.verify.expected.units import reach
from mdlgen.verify.inputs.companion import beside, chosen, of_systems, taken
from mdlgen.verify.inputs.scope import Scope
from mdlgen.verify.inputs.subject import File, Read, Subject
from mdlgen.verify.outcome import Perturbed, Verification
from mdlgen.verify.perturb.perturb import Progress, perturb_all
from mdlgen.verify.readback.script import NONE, Script
from mdlgen.verify.readback.values import (
    ReadBack,
    Values,
    contact_output_table,
    contact_table,
    data_table,
    gravity_of,
    gravity_table,
    marker_table,
    master_table,
    run_table,
    units_table,
)
from mdlgen.verify.tables import Difference, Table, compare
from mdlgen.verify.text.elements import element_differences
from mdlgen.verify.text.host_model import host_notes
from mdlgen.verify.text.objects import object_differences
from mdlgen.verify.text.statements import remarks, unaccounted
from mdlgen.verify.text.wording import wording

# Kinds that a deck has no entities for: points, vectors and data sets are the text's way to say numbers.
_NOT_IN_DECK = ("points", "vectors", "data", "mesh files")
# A script for MotionSolve has no surfaces either.
_NOT_IN_SCRIPT = (*_NOT_IN_DECK, "surfaces")
_UNSET = CONTACT_NUMBERS.index("normal_trans_vel")
_MOST_OBJECTS = 2  # number of objects relative to the own script: a file with more is not read further
_MACHINE = frozenset(("bodies", "graphics"))


def verify(
    scene: Scene,
    model: Model,
    *,
    text: Path | None = None,
    companion: Path | None = None,
    deck: Path | None = None,
    msolve: Path | None = None,
    only: str | None = None,
    perturb: bool = True,
    progress: Progress | None = None,
) -> Verification:
    """Compares text, script and deck with the Model of a scene, and the script for MotionSolve, `msolve`.

    Without `text` the texts that mdlgen writes are taken: with the contact numbers in solver commands, in the
    script, and in statements of the text. Without `companion` it is searched in the folder of `text`.
    `only="sheets"` is for the sheets alone, in a host model or by themselves; so is a scene with external
    parts. `perturb` also changes each value of the data sets.

    Raises OutputError for a file that cannot be read, SpecError for one that is none of its kind,
    RefusedError for a scene that has no text.
    """
    if only not in (None, "sheets"):
        raise SpecError(f"{only[:80]!r} cannot be verified alone; there is: sheets")
    subject = Subject(scene, model, only is not None, File.read(text, exactly=True))
    found = Verification()
    said = subject.said()
    first: Read | None = None
    for reads, numbers, of in _passes(subject, companion, bool(said["contacts"].names), found):
        first = first or reads[0]
        for read in reads:
            _text(said, subject, read, numbers, found, read.prefix if len(reads) > 1 else "")
        if perturb and not found.differences and of is not None:
            found.perturbed = found.perturbed or Perturbed()
            for read in reads:
                perturb_all(subject, read, numbers, found.perturbed, of, progress)
    assert first is not None
    if subject.only and deck is None:
        found.notes.append("no deck: it is of a whole machine")
    else:
        _deck(said, subject, first.values, File.read(deck), found)
    if not subject.only or msolve is not None:
        _script(said, subject, File.read(msolve), found)
    return found


def _passes(
    subject: Subject, companion: Path | None, contacts: bool, found: Verification
) -> Iterator[tuple[list[Read], Script, str | None]]:
    """Every way in which contacts may have their numbers: texts, their script, and what names of values to
    change begin with (empty: all, None: nothing more to change).

    The numbers of solver commands need no script, and count in place of one.
    """
    if subject.text is not None:
        reads = subject.reads(set_contact=False)
        script = _given(subject, subject.text.path, companion, reads, found)
        if reads[0].commanded:
            yield reads, NONE, ""
            if found.script is None:
                return
        yield [read.without_commands() for read in reads], script, _of_script(script, reads)
        return
    for set_contact in (False, True) if contacts else (False,):
        reads = subject.reads(set_contact)
        _lint(subject, reads[0], found)
        script = chosen(subject.script(set_contact), File.read(companion), found)
        if reads[0].commanded:
            yield reads, NONE, ""
        of = "ds_contact_" if set_contact else _of_script(script, reads)
        yield [read.without_commands() for read in reads], script, of


def _of_script(script: Script, reads: list[Read]) -> str | None:
    """The values to perturb where the script gives the numbers: after the commands only those it follows."""
    if not reads[0].commanded:
        return ""
    return f"ds_{OF_USER}." if script.follows else None


def _lint(subject: Subject, read: Read, found: Verification) -> None:
    """A text of our own has no remarks, except on entities that are external by design."""
    _ = read.values
    for finding in read.reading.report.findings:
        if not (subject.only and finding.code == "external"):
            found.differs("lint", "", str(finding))


def _given(
    subject: Subject, text: Path, companion: Path | None, reads: list[Read], found: Verification
) -> Script:
    """Compares the wording of a given MDL file and its content without values; returns its script."""
    one = reads[0]
    mine = subject.script(one.has_numbers)
    our = subject.own(one.has_numbers, like=one)
    names = frozenset(our.reading.program.definitions) if subject.only else None
    in_host = subject.only is not None and one.reading.program.begin is not None
    scope = Scope(one.reading, names, tuple(r.prefix for r in reads) if subject.only else ())
    _ = one.values
    remarks(one.reading, scope, found)
    found.differences += unaccounted(our.reading, one.reading, scope)
    given, looked = (File.read(companion), []) if companion is not None else beside(text, scope)
    if given is None and not one.commanded:
        taken(mine, looked, found)
    numbers = chosen(mine, given, found)
    if in_host:
        of_systems(mine, numbers, given, reads, found)
    leave = _MACHINE if subject.only else frozenset[str]()
    for read in reads:
        within = read.prefix if len(reads) > 1 else ""
        differences = wording(our.values, read.values, leave)
        found.differences += (d._replace(name=within + d.name) for d in differences)
        if in_host:
            found.notes += host_notes(our, read)
    return numbers


def _text(
    said: dict[str, Table], subject: Subject, read: Read, numbers: Script, found: Verification, within: str
) -> None:
    values = read.values
    tables = ReadBack(subject.times).tables(values)
    tables["data"] = data_table(values)
    names, commands = values["contacts"], read.commanded
    own = {name: numbers.numbers(name) | commands.get(name, {}) for name in names}
    tables["contacts"] = contact_table(values, own)
    tables["run"] = run_table(values)
    tables["gravity"] = gravity_table(gravity_of(values))
    tables["units"] = units_table(values)
    tables["masters"] = master_table(values)
    for kind, table in said.items():
        if kind != "masters" or commands:  # no statement of a text says it
            found.add("text", compare(kind, table, tables[kind]), within)
    recorded = contact_output_table(values)
    if recorded.names:  # asked for by an option
        found.add("text", compare("contact outputs", contact_outputs(subject.model), recorded), within)
    if numbers.follows:
        followed = contact_table(values, {n: numbers.numbers(n, values["datasets"]) for n in names})
        found.add("text", compare("contacts", said["contacts"], followed), within)
    for name in sorted(set(numbers.contacts) - set(values["contacts"])):
        found.differs("script", name, "is no contact of the text")
    for name in sorted(set(commands) - set(values["contacts"])):
        found.differs("commands", name, "is no contact of the text")


def _deck(
    said: dict[str, Table], subject: Subject, text: Values, given: File | None, found: Verification
) -> None:
    """The deck against the Model; and its markers, which a text leaves to MotionView, against the text's."""
    backend = emitter(DECK)
    try:
        own = backend.emit(subject.model)
    except RefusedError as error:
        own = None
        if given is None:
            found.notes.append(f"no deck: {error.message}")
            return
    if given is None:
        assert own is not None
        given, own = File(own, Path("<deck>")), None
    file = str(given.path)
    reading = backend.read(given.text, file)
    problems = backend.validate(given.text, file)
    found.differences += (Difference("deck", "", problem) for problem in problems)
    try:
        values = reading.values
    except SpecError as error:  # a deck that lacks something is one, and differs
        if not problems:
            found.differs("deck", "", error.message)
        return
    if own is not None:
        mine = backend.read(own, "<deck>")
        found.differences += element_differences(mine, reading, file)
    tables = ReadBack(subject.times).tables(values)
    tables["contacts"] = contact_table(values, {})
    tables["run"] = run_table(values)
    tables["gravity"] = gravity_table(values["gravity"])
    tables["units"] = units_table(values)
    tables["masters"] = master_table(values)
    for kind, table in said.items():
        if kind not in _NOT_IN_DECK:
            found.add("deck", compare(kind, table, tables[kind]))
    found.add("deck", compare("mesh shapes", mesh_shapes(subject.model), tables["mesh shapes"]))
    recorded = contact_output_table(values)
    found.add("deck", compare("contact outputs", contact_outputs(subject.model), recorded))
    found.add("deck", compare("all markers", marker_table(text, reach(subject.model)), marker_table(values)))


def _script(said: dict[str, Table], subject: Subject, given: File | None, found: Verification) -> None:
    """The script for MotionSolve against the Model. It has the markers of probes, and no keyword for
    normal_trans_vel."""
    backend, model = emitter(SCRIPT), subject.model
    try:
        own = backend.emit(model)
    except RefusedError as error:
        if given is None:
            found.notes.append(f"no script: {error.message}")
            return
        raise
    path = Path("<msolve>") if given is None else given.path
    mine = backend.read(own, "<msolve>")
    reading = mine if given is None else backend.read(given.text, str(path))
    if given is not None:
        reading.most = _MOST_OBJECTS * len(mine.made.things)
    values = reading.values
    if given is not None:
        found.differences += object_differences(mine, reading, str(path))
    tables = ReadBack(subject.times).tables(values)
    tables["contacts"] = contact_table(values, {}).without(_UNSET)
    tables["run"] = run_table(values)
    tables["gravity"] = gravity_table(values["gravity"])
    tables["units"] = units_table(values)
    tables["masters"] = master_table(values)
    tables["contact outputs"] = contact_output_table(values)
    of_probes = {f"m_probe_{probe.name}" for probe in model.probes}

    def probed(name: str) -> bool:
        head, _, end = name.rpartition("_")
        return name in of_probes or (head in of_probes and end.isdigit())

    due = {kind: table for kind, table in said.items() if kind not in _NOT_IN_SCRIPT}
    due["contacts"] = due["contacts"].without(_UNSET)
    due["markers"] = due["markers"].only(probed)
    tables["markers"] = tables["markers"].only(probed)
    due |= {"contact outputs": contact_outputs(model), "mesh shapes": mesh_shapes(model)}
    for kind, table in due.items():
        found.add("msolve", compare(kind, table, tables[kind]))
