"""Single changes of a text, but for its notes: a number, a name or a sign at random; a statement left out."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from typing import NamedTuple

_TOKEN = re.compile(r"\d+\.?\d*(?:[eE][-+]?\d+)?|[A-Za-z_]\w*|[-+*/^<>!?:.,(){}\[\]]")
_SIGNS = ("+", "-", "*", "/", ",", "(", ")", "")


_STATEMENT = re.compile(r"^[ \t]*\*(\w+)[ \t]*\(.*?\)[ \t]*\n(?=[ \t]*(?:\*|\n|<|\Z))", re.M | re.S)


class Mutation(NamedTuple):
    text: str
    old: str
    new: str
    where: str  # the line, for messages


def mutations(text: str, seed: int, count: int, begin: str = "*BeginMDL") -> Iterator[Mutation]:
    """`count` changed texts; a name becomes another one of the text, of its kind if there is one."""
    rng = random.Random(seed)
    tokens = list(_TOKEN.finditer(text, text.index(begin)))
    names = sorted({t[0] for t in tokens if t[0][0].isalpha() or t[0][0] == "_"})
    for _ in range(count):
        token = rng.choice(tokens)
        old = token[0]
        if old[0].isdigit():
            longer = f"{old}1" if len(old) < 10 else f"1{old}"  # a seventeenth digit may be no other number
            new = rng.choice(
                [
                    repr(float(old) * 1.5 + 1),
                    "0" if float(old) else "7",
                    f"-{old if float(old) else 7}",
                    longer,
                ]
            )
        elif old in _SIGNS or not (old[0].isalpha() or old[0] == "_"):
            new = rng.choice([s for s in _SIGNS if s != old])
        else:
            alike = [n for n in names if n != old and n.split("_")[0] == old.split("_")[0]]
            new = rng.choice([*(alike or names), f"{old}x"])
        line = text[text.rfind("\n", 0, token.start()) + 1 : text.find("\n", token.end())]
        yield Mutation(text[: token.start()] + new + text[token.end() :], old, new, line.strip())


def omissions(text: str, seed: int, begin: str = "*BeginMDL") -> Iterator[Mutation]:
    """One statement of each name left out."""
    rng = random.Random(seed)
    kinds: dict[str, list[re.Match[str]]] = {}
    for statement in _STATEMENT.finditer(text, text.index(begin)):
        kinds.setdefault(statement[1], []).append(statement)
    for statement in (rng.choice(found) for found in kinds.values()):
        where = " ".join(statement[0].split())
        yield Mutation(text[: statement.start()] + text[statement.end() :], where, "", where)
