"""A MotionView text as tests look at it: evaluated by the reader, and its statements as they stand."""

from __future__ import annotations

from typing import Any

from mdlgen.backends.motionview.reader import read
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.spec.load import load


def model_of(sample: str, *overrides: str) -> Model:
    return lower(load(samples() / sample, overrides=list(overrides)))


class Text:
    """A text that reads clean."""

    def __init__(self, text: str):
        reading = read(text)
        assert not reading.report.findings, [str(f) for f in reading.report.findings[:5]]
        self.text = text
        self.values: dict[str, dict[str, Any]] = reading.values
        self.statements = [(s.name, list(s.args)) for s in reading.program.statements]
        self.entity: dict[str, tuple[str, list[str]]] = {}  # kind and arguments behind the identifier
        self.members: dict[str, dict[str, list[str]]] = {}  # of each definition of a data set
        block = ""
        for name, args in self.statements:
            if name == "Real":
                self.members.setdefault(block, {})[args[0]] = args[1:]
            elif name.startswith("Define") or (len(args) > 1 and args[1].startswith('"')):
                assert args[0] not in self.entity, f"{args[0]} is defined twice"
                self.entity[args[0]] = (name, args[1:])
                block = args[0]

    def of_kind(self, *kinds: str) -> dict[str, list[str]]:
        """Entities of some kinds by identifier, with the arguments behind it."""
        return {k: args for k, (kind, args) in self.entity.items() if kind in kinds}

    def settings(self, name: str) -> dict[str, list[str]]:
        """Arguments of the statements `name` by what they set, each once."""
        rows = [args for kind, args in self.statements if kind == name]
        found = {args[0]: args[1:] for args in rows}
        assert len(found) == len(rows), f"{name} twice for one thing"
        return found
