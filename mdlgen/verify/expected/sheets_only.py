"""The sheets alone, in a model of the user's own: what of the Model is there, and by which names."""

from __future__ import annotations

from dataclasses import replace

from mdlgen.altair.rims import meetings
from mdlgen.formulas import names
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.tables import Model
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.tables import ANY, Table

MACHINE_KINDS = ("springs", "cylinders", "motions", "run", "gravity", "units", "masters")


def of_sheets(said: dict[str, Table], model: Model, own_machine: bool) -> dict[str, Table]:
    """The expected tables of the sheets; with `own_machine` the parts they touch may have any name."""
    machine, unused = _machine(model), _unused(model)
    kept = {
        kind: table.only(lambda name: name.partition(".")[0] not in machine and name not in unused)
        for kind, table in said.items()
        if kind not in MACHINE_KINDS
    }
    if own_machine and "contacts" in kept:
        kept["contacts"] = replace(kept["contacts"], words=_any_machine(kept["contacts"], model))
    return kept


def _machine(model: Model) -> set[str]:
    """Names of the text that belong to the machine."""
    names = {"ds_run"}
    for part in model.machine:
        kind = kind_of(part)
        names |= kind.names(part) | {name for name, _ in kind.vectors(model, part)}
    table = model.contacts
    of, bodies = model.pairs.contact, model.bodies.name
    for met in meetings(model):
        if table.of_machine[of[met.pair]]:
            a, b = (bodies[int(side[met.pair])] for side in (model.pairs.a, model.pairs.b))
            names.add(f"con_{a}_{b}{met.suffix}")
    of_sheets = {int(table.entry[r]) for r in range(len(table)) if not table.of_machine[r]}
    names |= {f"ds_contact_{e}" for e in set(table.entry.tolist()) - of_sheets}
    return names


def _unused(model: Model) -> set[str]:
    """The user's parameters that nothing of the sheets follows from."""
    own = {p.member: p.formula for p in model.parameters if p.data_set == OF_USER}
    machine = _machine(model)
    texts = [p.formula for p in model.parameters if f"ds_{p.data_set}" not in machine | {f"ds_{OF_USER}"}]
    texts += [text for anchor in (*model.probes, *model.supports) for text in anchor.formulas]
    used: set[str] = set()
    while texts:
        text = texts.pop()
        fresh = set(names(text)) - used if text else set()
        used |= fresh
        texts += [own[name] for name in fresh]
    return {f"ds_{OF_USER}.real_{name}" for name in own if name not in used}


def _any_machine(table: Table, model: Model) -> tuple[tuple[str, ...], ...]:
    """The words of contacts with the parts that this scene has a shape of left open."""
    ours = {f"b_{part.name}" for part in model.machine}
    return tuple((*w[:3], ANY, w[4], *(ANY for _ in w[5:])) if w[3] in ours else w for w in table.words)
