"""Templates: text that MotionView evaluates as Templex and writes into a deck or its commands."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, NamedTuple

from mdlgen.backends.motionview.reader.operators import shown
from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.thing import Thing

USUAL = "%g"
"""How a number is printed where nothing else is said: an exported deck has 11111.1 for 40/3.6e-3."""

_BRACES = re.compile(r"\{([^{}]*)\}")
_NAMES = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
_PRINT = re.compile(r"(.*?),\s*(%[-+ #0]*\d*(?:\.\d+)?[idfeEgGs])\s*", re.S)
_OWN = re.compile(
    r"\s*(?:for|if|elseif|while)\s*\(|\s*(?:else|endif|endloop|endwhile)\s*\Z|'|.*(?<![=!<>])=(?!=)", re.S
)
_ASSIGNMENT = re.compile(r"([A-Za-z_]\w*)\s*=(?!=)\s*([^=]+)")
_COMMENT = re.compile(r"<!--.*?-->", re.S)
_COMMAND = re.compile(r"<(\w+)\b([^<>]*?)/?>", re.S)
_ATTRIBUTE = re.compile(r'\b(\w+)\s*=\s*"([^"]*)"')


class Template(Thing):
    """`*Template( name, label, use, definition, ... )`: text with a language of its own.

    Evaluated are `{value}`, `{value, %.15g}`, the statement `{format, %.15g}`, variables `{name = value}`;
    not loops, conditions and formulas over variables.
    """

    kind = "Template"

    def p_text(self) -> str:
        """Text that the template writes."""
        found = self.ask("pasted")
        if found is None:
            message = f"{self} has statements of its own, which are not run: its text is not known"
            raise Trouble("template", message, severity="warning")
        return found

    def p_body(self) -> str | None:
        """Text of the template in its definition."""
        definition = self.world.program.definitions.get(self.statement.arg(3))
        return None if definition is None or definition.statement is None else definition.statement.body

    def p_pasted(self) -> str | None:
        """Its text where that holds nothing but values and variables; None where it has other statements."""
        body = self.ask("body")
        cut = None if body is None else _cut(body)
        if cut is None:
            return None
        pieces, end = cut
        definition = self.world.program.definitions[self.statement.arg(3)]
        given = dict(zip(definition.parameters, self.statement.args[4:], strict=False))
        renamed = {name: actual for name, actual in given.items() if name != actual}
        variables: dict[str, Any] = {}
        printed: dict[tuple[str, str], str] = {}  # many elements have the same values
        out = []
        for before, text, form, into in pieces:
            out.append(before)
            if into is None and text in variables:
                out.append(_printed(variables[text], form))
                continue
            done = printed.get((text, form)) if into is None else None
            if done is None:
                if _OWN.match(text) or variables.keys() & set(_NAMES.findall(text)):
                    return None
                named = _NAMES.sub(lambda name: renamed.get(name[0], name[0]), text) if renamed else text
                value = self._value(named)
                if into is not None:
                    variables[into] = value
                    printed.clear()
                    continue
                done = printed[text, form] = _printed(value, form)
            out.append(done)
        return "".join([*out, end])

    def _value(self, text: str) -> Any:
        values = self.scope.values
        value = values.get(text)  # many commands have the same
        if value is None:
            value = values[text] = self.world.compiled(text).run(self.scope)
        return value

    def p_commands(self) -> tuple[dict[str, str], ...] | None:
        """The elements that it writes, each with its attributes; None where its text is not known."""
        pasted = self.ask("pasted")
        if pasted is None:
            return None
        text = _COMMENT.sub("", pasted)
        return tuple({"command": m[1], **dict(_ATTRIBUTE.findall(m[2]))} for m in _COMMAND.finditer(text))

    def record(self) -> dict[str, Any]:
        return {
            "label": self.ask("label"),
            "use": self.statement.arg(2).upper(),
            "arguments": self.statement.args[3:],
            "text": self.ask("pasted"),
        }


class _Piece(NamedTuple):
    """The text between two values, and the contents of the braces after it."""

    before: str
    text: str
    form: str
    into: str | None  # a variable that takes the value, which is not printed then


@lru_cache(maxsize=4)  # a text is read again for each value of it that is changed
def _cut(body: str) -> tuple[list[_Piece], str] | None:
    """A template at its braces, and the text behind the last of them; None where braces are in each other."""
    if "{" in (plain := _BRACES.sub("", body)) or "}" in plain:
        return None
    pieces, before, at, usual = [], "", 0, USUAL
    for match in _BRACES.finditer(body):
        before += body[at : match.start()]
        at = match.end()
        text, form = match[1].strip(), usual
        if (own := _PRINT.fullmatch(text)) is not None:
            text, form = own[1].strip(), own[2]
            if text == "format":
                usual = form
                continue
        made = _ASSIGNMENT.fullmatch(text)
        pieces.append(_Piece(before, text if made is None else made[2], form, made[1] if made else None))
        before = ""
    return pieces, before + body[at:]


def _printed(value: Any, form: str) -> str:
    """A value as it is printed."""
    if not isinstance(value, float) or form[-1] == "s":
        return shown(value)
    return form % int(value) if form[-1] in "id" else form % value
