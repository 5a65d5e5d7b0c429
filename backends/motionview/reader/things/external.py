"""Entities of the model that a definition is made for: only their names and kinds are known."""

from __future__ import annotations

from typing import Any

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.scope import Parameter
from mdlgen.backends.motionview.reader.things.thing import Identifier

_NAMES = ("id", "idstring", "full_varname", "varname")
# Keywords of *Attachment, in any case, and the kinds of thing that they are.
_KINDS = {
    **{kind.lower(): kind for kind in ("Body", "Graphic", "Point", "Vector", "Marker", "Joint", "Motion")},
    **{kind.lower(): kind for kind in ("Contact", "Output", "Force", "System", "DataSet", "Bush")},
    "bushing": "Bush",
}


class External:
    """An attachment whose entity no text that was read makes."""

    def __init__(self, parameter: Parameter, name: str, side: str = ""):
        word = parameter.attachment.arg(2) if parameter.attachment is not None else ""
        word = word[:-4] if word.lower().endswith("pair") else word
        self.kind = _KINDS.get(word.lower(), word)
        self.parameter = parameter
        self.given = name
        self.side = side
        self.memo: dict[str, Any] = {}

    @property
    def name(self) -> str:
        return f"{self.given}.{self.side}" if self.side else self.given

    def __str__(self) -> str:
        return self.name

    def trouble(self) -> Trouble:
        """The warning for this attachment; the same object for every value that needs more than its name."""
        attachment = self.parameter.attachment
        kind = f"the {self.kind} " if self.kind else ""
        message = f"{kind}{self.given} is external: it stands in the model that this text is made for"
        trouble = Trouble("external", message, severity="warning")
        trouble.place = (attachment or self.parameter.instance).place()
        return trouble

    def ask(self, key: str) -> Any:
        """A property: none is known."""
        raise self.trouble()

    def attribute(self, key: str, name: str, shift: int) -> Any:
        """`external.name` in an expression."""
        if key in _NAMES:
            return Identifier(self.name)
        if key == "state":
            return True
        if key in ("l", "r"):
            return self
        raise self.trouble()
