"""A text, its script and its deck against the Model: read back, compared, turned value by value."""

from __future__ import annotations

from pathlib import Path

from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.tables import Model
from mdlgen.registry import emitter, reader, validator
from mdlgen.spec.scene import Scene
from mdlgen.verify import script
from mdlgen.verify.expected import reach
from mdlgen.verify.found import (
    Found,
    Values,
    contact_table,
    data_table,
    gravity_table,
    marker_table,
    run_table,
)
from mdlgen.verify.outcome import Verification
from mdlgen.verify.subject import File, Read, Subject
from mdlgen.verify.tables import Table, compare
from mdlgen.verify.turning import Progress, turn_all
from mdlgen.verify.wording import wording

# Kinds that a deck has no entities for: points, vectors and data sets are the text's way to say numbers.
_NOT_IN_DECK = ("points", "vectors", "data")
_MACHINE = frozenset(("bodies", "graphics"))


def verify(
    scene: Scene,
    model: Model,
    *,
    text: Path | None = None,
    companion: Path | None = None,
    deck: Path | None = None,
    only: str | None = None,
    turn: bool = True,
    progress: Progress | None = None,
) -> Verification:
    """Compares text, script and deck with the Model of a scene.

    Without `text` the texts that mdlgen writes are taken: with the contact numbers in the script, and with
    them in the text. `companion` is looked for beside `text` where it is left out. `only="sheets"` is for
    the sheets alone, in a host model or by themselves; so is a scene with external parts. `turn` also turns
    each value of the data sets.

    Raises OutputError for a file that cannot be read, SpecError for one that is none of its kind,
    RefusedError for a scene that has no text.
    """
    if only not in (None, "sheets"):
        raise SpecError(f"{only[:80]!r} cannot be verified alone; there is: sheets")
    if companion is None and text is not None:
        beside = text.with_name(f"{text.stem}_mview.py")
        companion = beside if beside.is_file() else None
    subject = Subject(scene, model, only is not None, File.read(text), File.read(companion))
    found = Verification()
    said = subject.said()
    first: Read | None = None
    for set_contact in (
        (False, True) if text is None and "contacts" in said and said["contacts"].names else (False,)
    ):
        read = subject.read(set_contact)
        _lint(subject, read, found)
        numbers, as_written = subject.script(read.has_numbers)
        if not as_written:
            what = "its statements are not those that mdlgen writes; only its numbers may differ"
            found.differs("script", "", f"{companion}: {what}")
        _text(said, subject, read.values, numbers, found)
        if text is not None:
            own = subject.own(read.has_numbers).values
            leave = _MACHINE if subject.only else frozenset[str]()
            found.differences += wording(own, read.values, leave)
        if turn and not found.differences:
            found.turned = turn_all(subject, read, numbers, found.turned, progress)
        first = first or read
    assert first is not None
    if subject.only and deck is None:
        found.notes.append("no deck: it is of a whole machine")
    else:
        _deck(said, subject, first.values, File.read(deck), found)
    return found


def _lint(subject: Subject, read: Read, found: Verification) -> None:
    """A text of our own has nothing to remark, but for what is external by design."""
    _ = read.values
    report = read.reading.report
    own = subject.text is None
    for finding in report.findings if own else report.errors:
        if not (subject.only and finding.code == "external"):
            found.differs("lint", "", str(finding))


def _text(
    said: dict[str, Table], subject: Subject, values: Values, numbers: script.Script, found: Verification
) -> None:
    tables = Found(subject.times).tables(values)
    tables["data"] = data_table(values)
    tables["contacts"] = contact_table(values, {n: numbers.numbers(n) for n in values["contacts"]})
    tables["run"] = run_table(values)
    tables["gravity"] = gravity_table(numbers.gravity or script.DEFAULT_GRAVITY)
    for kind, table in said.items():
        found.add("text", compare(kind, table, tables[kind]))
    for name in sorted(set(numbers.contacts) - set(values["contacts"])):
        found.differs("script", name, "is no contact of the text")


def _deck(
    said: dict[str, Table], subject: Subject, text: Values, given: File | None, found: Verification
) -> None:
    """The deck against the Model; and its markers, which a text leaves to MotionView, against the text's."""
    if given is None:
        try:
            given = File(emitter("motionsolve").emit(subject.model), Path("<deck>"))
        except RefusedError as error:
            found.notes.append(f"no deck: {error.message}")
            return
    values = reader("motionsolve").read(given.text, str(given.path)).values
    for problem in validator("motionsolve").validate(given.text, str(given.path)):
        found.differs("deck", "", problem)
    tables = Found(subject.times).tables(values)
    tables["contacts"] = contact_table(values, {})
    tables["run"] = run_table(values)
    tables["gravity"] = gravity_table(values["gravity"])
    for kind, table in said.items():
        if kind not in _NOT_IN_DECK:
            found.add("deck", compare(kind, table, tables[kind]))
    found.add("deck", compare("all markers", marker_table(text, reach(subject.model)), marker_table(values)))
