"""Streams: sheets that come in one after another, said once."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import ConfigDict, Field, model_validator

from mdlgen.spec.fields import Name, Position, TimeOrZero, Velocity
from mdlgen.spec.nip import merged
from mdlgen.spec.out import FORMS, Outs
from mdlgen.spec.pile import Path, turned, value_of
from mdlgen.spec.quantities import default, quantity
from mdlgen.spec.strict import Strict, fail

MOST = 1000


def _when(schema: dict[str, Any]) -> None:
    """For the JSON schema: exactly one of the ways to say when sheets come in."""
    schema["oneOf"] = [{"required": [name]} for name in ("every", "times", "by_rule")]


class Stream(Strict):
    """Sheets that come in one after another: NAME_1, NAME_2 and so on, with as many digits as the last one.

    They are sheets as all others. A contact, and a nip, means all of them by the name of the stream, or of
    the sheet that they are of; by their own names it means some. Sheets of a stream touch each other only
    where a contact says so, as `between: [NAME, NAME]`.
    """

    model_config = ConfigDict(json_schema_extra=_when)

    of: Name = Field(
        description="the sheet, under sheets, that all are like; the first takes its place, and no sheet has "
        "its name any more"
    )
    every: Annotated[float, quantity("ms", 0.0, open_low=True)] | None = Field(
        default=None, description="from one to the next"
    )
    count: Annotated[int, Field(ge=1, le=MOST)] | None = Field(
        default=None, description=f"how many there are, 1 to {MOST}; with times it follows from these"
    )
    first: TimeOrZero = Field(
        default=default("0 ms"), alias="from", description="when the first one comes in; with every"
    )
    times: Annotated[tuple[TimeOrZero, ...], Field(min_length=1, max_length=MOST)] | None = Field(
        default=None, strict=False, description="when each one comes in, in place of every and count"
    )
    by_rule: bool = Field(
        default=False, description="each comes in when a rule says so, in place of every and times"
    )
    at: Position | None = Field(
        default=None, description="where the middle of each is as it comes in; that of the sheet if left out"
    )
    velocity: Velocity | None = Field(
        default=None, description="with which each comes in; that of the sheet if left out"
    )
    jitter: TimeOrZero = Field(
        default=default("0 ms"), description="each but the first comes earlier or later by up to this"
    )
    skew: Annotated[float, quantity("deg", 0.0)] = Field(
        default=default("0 deg"), description="each is turned in its plane by up to this, either way"
    )
    seed: Annotated[int, Field(ge=0)] = Field(
        default=1, description="the same seed gives the same times and turns"
    )
    out: Outs | None = Field(
        default=None,
        description=f"where sheets leave, after which they are not there any more: {FORMS}. Beyond a plane: "
        "all of a sheet is on the other side of it than where it came in",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Stream:
        given = [name for name in ("every", "times") if getattr(self, name) is not None]
        given += ["by_rule"] if self.by_rule else []
        if len(given) != 1:
            asked = "when do they come in? give every and count, times, or by_rule: true"
            raise fail(f"{' and '.join(given)} are given; give one of them" if given else asked)
        if self.times is None and self.count is None:
            raise fail(f"how many are there? give count, as count: 20, with {given[0]}")
        if self.times is not None and self.count not in (None, len(self.times)):
            raise fail(
                f"count is {self.count}, and there are {len(self.times)} times; leave count out",
                within=("count",),
            )
        if self.every is None and self.first != 0.0:
            raise fail("from goes with every; leave it out", within=("from",))
        return self


def names_of(name: str, stream: Any) -> list[str]:
    """The names of the sheets of a stream, from the first; one where how many there are is not known."""
    given = stream if isinstance(stream, dict) else {}
    times, count = given.get("times"), given.get("count")
    count = len(times) if isinstance(times, (list, tuple)) else count
    good = count if type(count) is int and 1 <= count <= MOST else 1
    return [f"{name}_{k + 1:0{len(str(good))}d}" for k in range(good)]


def written(data: dict[str, Any], origins: dict[Path, Path]) -> None:
    """Puts the sheets of streams in the place of those that they are of, and names them in contacts where
    these name the stream. Data of a wrong form are left for validation."""
    streams, sheets = data.get("streams"), data.get("sheets")
    if not isinstance(streams, dict) or not isinstance(sheets, dict):
        return
    good = {
        name: stream
        for name, stream in streams.items()
        if isinstance(stream, dict) and isinstance(sheets.get(str(stream.get("of"))), dict)
    }
    members = {name: names_of(name, stream) for name, stream in good.items()}
    every = {member for names in members.values() for member in names}
    made: dict[Any, Any] = {}
    for sheet, keys in sheets.items():
        own = {name: stream for name, stream in good.items() if stream["of"] == sheet}
        if not own and sheet not in every:
            made[sheet] = keys
        for name, stream in own.items():
            for member, place in zip(members[name], _each(keys, stream, len(members[name])), strict=True):
                # a value given under sheets counts there: --set sheets.infeed_03.mass=..
                made[member] = merged({**keys, **place}, given := sheets.get(member, {}))
                origins["sheets", member] = ("sheets", sheet)
                for key in place:
                    origins["sheets", member, key] = ("streams", name, _SAID.get(key, key))
                for key in given if isinstance(given, dict) else ():
                    origins["sheets", member, key] = ("sheets", member, key)
    data["sheets"] = made
    if isinstance(data.get("contacts"), (list, tuple)):
        of: dict[str, list[str]] = {}
        for name, stream in good.items():
            of.setdefault(stream["of"], []).extend(members[name])
        data["contacts"] = [_contact(item, members, of) for item in data["contacts"]]


# Key of a stream that takes the place of a key of its sheets.
_SAID = {"center": "at", "enters": "every", "turn": "skew", "rotation": "skew"}


def _contact(item: Any, members: dict[str, list[str]], of: dict[str, list[str]]) -> Any:
    """A contact with sheets in the place of the name of their stream, or of the sheet that all are like."""
    sides = item.get("between") if isinstance(item, dict) else None
    if not isinstance(sides, (list, tuple)):
        return item
    found = []
    for side in sides:
        words = [side] if isinstance(side, str) else side
        if not isinstance(words, (list, tuple)):
            return item
        own = [member for word in words for member in _meant(word, members, of)]
        found.append(side if own == list(words) else own)
    return {**item, "between": found}


def _meant(word: Any, members: dict[str, list[str]], of: dict[str, list[str]]) -> list[Any]:
    """The names that a word of a contact stands for."""
    if not isinstance(word, str):
        return [word]
    return members.get(word) or of.get(word) or [word]


def _each(sheet: dict[str, Any], stream: dict[str, Any], count: int) -> Iterator[dict[str, Any]]:
    """When each sheet of a stream comes in, and what it has otherwise than the sheet that it is of."""
    first, every, times = stream.get("from", "0 ms"), stream.get("every"), stream.get("times")
    jitter, skew = value_of(stream.get("jitter", "0 ms"), "ms"), value_of(stream.get("skew", "0 deg"), "deg")
    seed = stream.get("seed", 1)
    draw = random.Random(seed if type(seed) is int else 1)
    key = "turn" if sheet.get("rotation") is None else "rotation"
    angles = sheet["rotation"] if key == "rotation" else ["0 deg", "0 deg", sheet.get("turn") or "0 deg"]
    for k in range(count):
        # both are drawn for each sheet, so that neither depends on the range of the other
        later, swung = draw.uniform(-1.0, 1.0) * jitter, draw.uniform(-1.0, 1.0) * skew
        place: dict[str, Any] = {}
        if stream.get("by_rule") is True:
            place["by_rule"] = True
        elif isinstance(times, (list, tuple)):
            place["enters"] = _later(times[k], later if k else 0.0)
        elif every is not None:
            place["enters"] = _later(f"({first}) + {k}*({every})" if k else first, later if k else 0.0)
        for given, own in (("at", "center"), ("velocity", "velocity"), ("out", "out")):
            if stream.get(given) is not None:
                place[own] = stream[given]
        if skew and math.isfinite(swung) and isinstance(angles, (list, tuple)) and len(angles) == 3:
            place |= turned(key, angles, swung)
        yield place


def _later(text: Any, by: float) -> Any:
    """A time, and by how much later [ms]."""
    return text if by == 0.0 or not isinstance(text, str) else f"({text}) + ({by!r} ms)"
