"""Turns each value of a text's data sets, and the same value of the spec, and compares what comes of it."""

from __future__ import annotations

from collections.abc import Callable

from mdlgen.verify.inputs.subject import Read, Subject
from mdlgen.verify.outcome import Perturbed
from mdlgen.verify.perturb.perturbations import Perturbation, perturbations
from mdlgen.verify.readback.script import Script
from mdlgen.verify.readback.values import (
    ReadBack,
    Values,
    commanded,
    contact_table,
    data_table,
    gravity_of,
    gravity_table,
    run_table,
)
from mdlgen.verify.tables import Difference, Table, compare

Progress = Callable[[int, int], None]
_MOST = 3  # differences reported of one kind for one value


def perturb_all(
    subject: Subject,
    text: Read,
    numbers: Script,
    perturbed: Perturbed,
    of: str,
    progress: Progress | None,
) -> None:
    """Adds to `perturbed`; `of` is what names of values begin with: of a second text only few need it."""
    perturber = _Perturber(subject, text, numbers, perturbed)
    members = text.values["members"]
    chosen = [k for k in perturbations(subject.scene, subject.model) if k.path in perturber.known]
    if of:
        chosen = [k for k in chosen if k.path.startswith(of)]
    else:
        paths = {k.path for k in chosen}
        for path, member in members.items():
            if member["edit"] != "NO_EDIT" and path not in paths:
                what = "can be edited, and nothing in the spec is it"
                perturbed.differences.append(Difference("data", path, what))
    for done, perturbation in enumerate(chosen):
        if progress is not None:
            progress(done, len(chosen))
        if members[perturbation.path]["edit"] == "NO_EDIT":
            if not of:  # another text may use it
                perturbed.shown_only.add(perturbation.path)
        else:
            perturbed.shown_only.discard(perturbation.path)
            perturber.perturb(perturbation)


class _Perturber:
    """Turns values of one text."""

    def __init__(self, subject: Subject, text: Read, numbers: Script, perturbed: Perturbed):
        self.subject = subject
        self.text = text
        self.perturbed = perturbed
        self.script = numbers
        self.known = set(subject.said()["data"].names) & set(text.values["members"])
        self.kinds = set(subject.said()) - {"units", "masters"}
        self.commands = text.commanded
        if not text.has_numbers and not numbers.follows and not self.commands:
            self.kinds.discard("contacts")
        self.base = self._tables(text.values)

    def perturb(self, perturbation: Perturbation) -> None:
        """One value, in text and spec."""
        perturbed, path = self.perturbed, perturbation.path
        changed = self.text.changed(path, perturbation.value)
        if changed is None:
            perturbed.differences.append(Difference("data", path, "is set by no statement"))
            return
        perturbed.values += 1
        model = perturbation.model()
        tables, said = self._tables(changed), self.subject.said(model)
        for kind in self.kinds:
            compared = compare(kind, said[kind], self.base[kind].updated(tables[kind]), words=False)
            if compared.largest > perturbed.largest:
                perturbed.largest, perturbed.where = compared.largest, f"{path}: {kind} {compared.where}"
            for difference in compared.differences[:_MOST]:
                what = f"{difference.what}, with {path} changed to {perturbation.value:g}"
                perturbed.differences.append(Difference(kind, difference.name, what))

    def _tables(self, values: Values) -> dict[str, Table]:
        tables = ReadBack(self.subject.times, self.text.values["markers"]).tables(values)
        tables["data"] = data_table(values)
        contacts = values.get("contacts", {})
        changed = commanded(values) if self.commands else {}
        if changed:  # numbers of contacts none of whose statements changes
            contacts = self.text.values["contacts"] | contacts
            numbers = {name: self.commands.get(name, {}) | changed.get(name, {}) for name in contacts}
        elif self.script.follows:  # contacts of the text change with values that no statement of theirs has
            sets, contacts = dict(self.text.values["datasets"]), self.text.values["contacts"] | contacts
            for holder, members in values.get("datasets", {}).items():
                sets[holder] = {**sets.get(holder, {}), **members}
            numbers = {name: self.script.numbers(name, sets) for name in contacts}
        else:
            numbers = {n: self.script.numbers(n) | self.commands.get(n, {}) for n in contacts}
        tables["contacts"] = contact_table({**values, "contacts": contacts}, numbers)
        tables["run"] = run_table(values)
        standard = self.text.values["standard"]
        if "gravity" in standard:
            now = standard["gravity"] | values.get("standard", {}).get("gravity", {})
            tables["gravity"] = gravity_table(gravity_of({"standard": {"gravity": now}}))
        return tables
