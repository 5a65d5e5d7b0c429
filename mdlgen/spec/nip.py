"""Nips: two rollers with a sheet between them, placed in balance, with their contacts."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Annotated, Any

from pydantic import Field
from pydantic_core import PydanticCustomError

from mdlgen.spec import nip_cover
from mdlgen.spec.alternatives import others
from mdlgen.spec.fields import Direction, Name, Position, read_direction
from mdlgen.spec.parameter import Computed
from mdlgen.spec.quantities import of_text, quantity
from mdlgen.spec.rows import ZERO, Mirror, Repeat
from mdlgen.spec.strict import Strict
from mdlgen.units import exact_quantity

Path = tuple[str | int, ...]
Fill = Callable[[Any, str], Any]
SIDES = ("lower", "upper")
_WEIGHT = ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]
_ATOM = re.compile(r"[A-Za-z_]\w*|[0-9.]+(?:e[-+]?[0-9]+)? *[A-Za-z][\w/*^.]*|[0-9.]+")


class Nip(Strict):
    """Two rollers that grip a sheet: both are placed so that each presses it with `force`, and each has its
    contact with it. One of them may have a press, whose preload follows, or both have fixed axes."""

    at: Position = Field(description="where the middle plane of the sheet passes, between the two rollers")
    normal: Direction = Field(
        default=(0.0, 0.0, 1.0), description="from the lower to the upper roller; z where left out"
    )
    axis: Direction = Field(default=(0.0, 1.0, 0.0), description="axis of both rollers; y where left out")
    sheet: Name | None = Field(
        default=None,
        description="the sheet, or stream, between them; may be left out where there is one sheet only",
    )
    force: Annotated[float, quantity("N", 0.0, open_low=True)] = Field(
        description="force with which each roller presses the sheet, at rest"
    )
    lower: dict[str, Any] = Field(
        description="keys of the roller on the side that the normal comes from, but center and axis; `name`, "
        "NIP_lower where left out; `contact`, keys of its contact with the sheet"
    )
    upper: dict[str, Any] = Field(description="the same of the roller on the other side; NIP_upper")
    contact: dict[str, Any] | None = Field(
        default=None,
        description="keys of the contact of the two rollers, which they meet in while no sheet is between "
        "them; none where left out",
    )
    repeat: Repeat | None = Field(default=None, description="a row of such nips")
    mirror: Mirror | None = Field(default=None, description="a second one, its mirror image")


def names_of(name: str, nip: Any) -> list[str]:
    """The names of the two rollers of a nip."""
    sides = [nip.get(side) if isinstance(nip, dict) else None for side in SIDES]
    return [
        str(given["name"]) if isinstance(given, dict) and "name" in given else f"{name}_{side}"
        for given, side in zip(sides, SIDES, strict=True)
    ]


def contacts_of(name: str) -> dict[str, Path]:
    """Names of the contacts of a nip, and where each stands in it."""
    return {name: ("contact",), **{f"{name}_{side}": (side, "contact") for side in SIDES}}


def take_contacts(data: dict[str, Any], origins: dict[Path, Path]) -> None:
    """Puts what stands under the contacts of nips, by their names, into the nips, where it counts:
    --set contacts.entry_lower.friction=.. A contact that says between what it is, is one of its own."""
    contacts, nips = data.get("contacts"), data.get("nips")
    if not isinstance(contacts, dict) or not isinstance(nips, dict):
        return
    contacts, nips = dict(contacts), dict(nips)
    for name, nip in nips.items():
        for called, (*side, last) in contacts_of(name).items():
            given = contacts.get(called)
            owner = nips[name].get(side[0]) if side and isinstance(nips[name], dict) else nips[name]
            if not isinstance(given, dict) or "between" in given or not isinstance(owner, dict):
                continue
            if not side and not isinstance(nip.get(last), dict):
                continue  # the two rollers have none
            owner = {**owner, last: merged(owner.get(last, {}), given)}
            nips[name] = {**nips[name], side[0]: owner} if side else owner
            for key in given:
                origins["nips", name, *side, last, key] = ("contacts", called, key)
            del contacts[called]
    data["contacts"], data["nips"] = contacts, nips


def written(data: dict[str, Any], origins: dict[Path, Path], fill: Fill) -> None:
    """Adds the rollers and contacts of nips to `data`, whose contacts are a list; `fill` gives a part its
    defaults. A nip that is not of the right form is left for validation."""
    nips = data.get("nips")
    if not isinstance(nips, dict):
        return
    rollers = dict(data["rollers"]) if isinstance(data.get("rollers"), dict) else {}
    contacts = list(data["contacts"]) if isinstance(data.get("contacts"), (list, tuple)) else []
    filled: dict[str, Any] = {}
    for name, nip in nips.items():
        if not isinstance(nip, dict) or not all(isinstance(nip.get(side), dict) for side in SIDES):
            continue
        own = dict(zip(SIDES, names_of(name, nip), strict=True))
        # a value given under rollers counts there: --set rollers.entry_upper.mass=..
        given = {side: rollers.get(roller) for side, roller in own.items()}
        nip = nip | {side: merged(nip[side], g) for side, g in given.items() if isinstance(g, dict)}
        made = _Written(data, name, nip, fill)
        for side, roller in own.items():
            said = given[side]
            for key in ("", *nip[side]):
                tail = (key,) if key else ()
                inner = said.get(key) if isinstance(said, dict) else None
                if not isinstance(said, dict) or (key and key not in said):
                    origins["rollers", roller, *tail] = ("nips", name, side, *tail)
                elif isinstance(inner, dict):  # both have a part of it: the whole stands in the nip
                    origins["rollers", roller, key] = ("nips", name, side, key)
                    own_paths = [("rollers", roller, key, last) for last in inner]
                    origins.update(zip(own_paths, own_paths, strict=True))
            for key, path in (("center", ("at",)), ("axis", ("axis",)), ("press.preload", ("force",))):
                origins["rollers", roller, *key.split(".")] = ("nips", name, *path)
            rollers[roller] = made.roller(side)
        for path, contact in made.contacts(names_of(name, nip)):
            origins["contacts", len(contacts)] = path
            contacts.append(contact)
        filled[name] = made.filled()
    data["rollers"], data["contacts"], data["nips"] = rollers, contacts, nips | filled


def merged(one: Any, other: Any) -> Any:
    """A mapping with what another one says in its place, key by key; what says the same otherwise goes."""
    if not isinstance(one, dict) or not isinstance(other, dict):
        return other
    gone = {old for key in other for old in others(key)} - set(other)
    one = {key: value for key, value in one.items() if key not in gone}
    return {**one, **{key: merged(one[key], v) if key in one else v for key, v in other.items()}}


class _Written:
    """One nip; all values are texts."""

    def __init__(self, data: dict[str, Any], name: str, nip: dict[str, Any], fill: Fill):
        self.data, self.name, self.nip, self.fill = data, name, nip, fill
        self.sides = {side: fill(nip[side], "rollers") for side in SIDES}
        self.ways = {side: fill(self.sides[side].get("contact", {}), "contacts") for side in SIDES}
        given = data.get("sheets")
        sheets = given if isinstance(given, dict) else {}
        only = next(iter(sheets)) if len(sheets) == 1 else None
        self.sheet = only if nip.get("sheet") is None else nip["sheet"]
        streams = data.get("streams")
        stream = streams.get(self.sheet) if isinstance(streams, dict) else None
        of = stream.get("of") if isinstance(stream, dict) else self.sheet
        sheet = sheets.get(of) if isinstance(of, str) else None
        thickness = sheet.get("thickness") if isinstance(sheet, dict) else None
        self.thickness = _good(thickness, "mm")
        self.force = _good(nip.get("force"), "N")
        try:
            self.normal = read_direction(nip.get("normal", "z"))
        except PydanticCustomError:
            self.normal = (0.0, 0.0, 1.0)

    def contacts(self, names: list[str]) -> list[tuple[Path, Any]]:
        """Contacts of the rollers with each other, and of each with the sheet; where each stands."""
        found: list[tuple[Path, Any]] = []
        base = ("nips", self.name)
        if isinstance(self.nip.get("contact"), dict):
            between = {"between": list(names), "name": self.name}
            found.append(((*base, "contact"), {**self.nip["contact"], **between}))
        for side, own in zip(SIDES, names, strict=True):
            if isinstance(self.ways[side], dict) and isinstance(self.sheet, str):
                given = self.sides[side].get("contact", {})
                between = {"between": [self.sheet, own], "name": f"{self.name}_{side}"}
                found.append(((*base, side, "contact"), {**given, **between}))
        return found

    def filled(self) -> dict[str, Any]:
        """The nip with its defaults, and with what stands under rollers."""
        sides = {
            side: {**self.sides[side], **({"contact": way} if isinstance(way, dict) else {})}
            for side, way in self.ways.items()
        }
        for side, made in sides.items():  # of the defaults: the nip's own follows from its force
            press, own = made.get("press"), self.nip[side].get("press")
            if isinstance(press, dict) and "preload" not in (own if isinstance(own, dict) else ()):
                made["press"] = {key: value for key, value in press.items() if key != "preload"}
        between = self.nip.get("contact")
        met = {"contact": self.fill(between, "contacts")} if isinstance(between, dict) else {}
        return {**self.nip, **sides, **met}

    def roller(self, side: str) -> dict[str, Any]:
        """A roller without its nip's own keys, in its place, its press with the preload."""
        given = {k: v for k, v in self.nip[side].items() if k not in ("name", "contact")}
        given = {"axis": self.nip.get("axis", "y"), "center": self._center(side)} | given
        given = nip_cover.with_force(given, self.nip.get("force"))
        press = self.sides[side].get("press")
        if isinstance(press, dict):
            down = [-v if side == "upper" else v for v in self.normal]
            own = {"direction": [v + 0.0 for v in down], **press}
            preload = self._preload_of(side, own, down)
            given["press"] = {**own, "preload": preload} if preload else own
        return given

    def _center(self, side: str) -> Any:
        at, away = self.nip.get("at"), self._away(side)
        if away is None or not isinstance(at, (list, tuple)) or len(at) != 3:
            return at
        found = []
        for place, n in zip(at, self.normal, strict=True):
            n = n if side == "upper" else -n
            if n == 0.0 or not isinstance(place, str):
                found.append(place)
                continue
            size = f"({away})" if abs(n) == 1.0 else f"{abs(n)!r}*({away})"
            sign = "-" if n < 0.0 else "+"
            zero = ZERO.fullmatch(place)
            found.append(f"{sign if n < 0.0 else ''}{size}" if zero else f"{_part(place)} {sign} {size}")
        return found

    def _away(self, side: str) -> str | None:
        """Distance from the middle plane of the sheet to the axis: R + s/2 - d."""
        radius, depth = self._radius(side), self._depth(side)
        if radius is None or depth is None or self.thickness is None:
            return None
        return f"{radius} + {self.thickness}/2 - {depth}"

    def _radius(self, side: str) -> str | None:
        given = self.sides[side]
        diameter = _good(given.get("diameter"), "mm")
        return f"{diameter}/2" if diameter else _good(given.get("radius"), "mm")

    def _depth(self, side: str) -> str | None:
        """Depth of the roller in the sheet: F = k d^1.5 (Eq. 10)."""
        way = self.ways[side]
        given = way.get("stiffness") if isinstance(way, dict) else None
        if given is None and isinstance(way, dict):
            one, other = (self.sides[name] for name in (side, *(s for s in SIDES if s != side)))
            given = nip_cover.stiffness(one, other, self.nip.get("force"))
        stiffness = _good(given, "N/mm^1.5")
        return f"({self.force}/{stiffness})^(2/3)" if self.force and stiffness else None

    def _preload_of(self, side: str, press: dict[str, Any], down: list[float]) -> str | None:
        """The formula of `press.preload`: the spring force where the rollers just touch [N].

        This is not `force`, which each roller has on the sheet: from that the weight is taken, and what the
        spring gains on the way from there to the sheet's place between them. From here on, in Scene, Model,
        texts and solvers, only the preload is known.
        """
        found, between = self.force, self._between()
        if found is None:
            return None
        meeting = self.fill(self.nip.get("contact"), "contacts")
        if between and isinstance(meeting, dict):
            if meeting.get("stiffness") is None:
                low, high = (self.sides[side] for side in SIDES)
                follows = nip_cover.stiffness(low, high, self.nip.get("force"), both=True)
                meeting = {**meeting, "stiffness": follows}
            stiffness, own = (_good(given.get("stiffness"), unit) for given, unit in
                              ((press, "N/mm"), (meeting, "N/mm^1.5")))  # fmt: skip
            if stiffness is None or own is None:
                return None
            # they may meet through the sheet
            found += f" - {stiffness}*({between}) + {own}*max(0 mm, -({between}))^1.5"
        return found + self._weight(side, press, down)

    def _between(self) -> str | None:
        """Formula of the sheet's thickness between the two rollers, less both depths."""
        low, high = (self._depth(side) for side in SIDES)
        return f"{self.thickness} - {low} - {high}" if self.thickness and low and high else None

    def _weight(self, side: str, press: dict[str, Any], down: list[float]) -> str:
        """Less the weight of roller and carrier along the press."""
        mass, carrier = _good(self.sides[side].get("mass"), "g"), press.get("carrier_mass")
        gravity = self.data.get("gravity", _WEIGHT)
        pulls = gravity if isinstance(gravity, (list, tuple)) and len(gravity) == 3 else []
        heavy = f"1.001*{mass}" if carrier is None else f"({mass} + {_good(carrier, 'g')})"
        if mass is None or "None" in heavy:
            return ""
        found = ""
        for way, pull in zip(down, pulls, strict=False):
            text = _good(pull, "m/s^2")
            if way == 0.0 or text is None or ZERO.fullmatch(str(pull)):
                continue
            factor = "" if abs(way) == 1.0 else f"*{abs(way)!r}"
            found += f" {'-' if way > 0.0 else '+'} {heavy}*{text}{factor}"
        return found


def _good(text: Any, unit: str) -> str | None:
    """A value as a part of a formula, in the unit of its key where it is a number; None where it is no value
    of such a unit: its own field reports it."""
    try:
        value = of_text(text, unit)
    except ValueError:
        return None
    return _part(text if isinstance(value, Computed) else exact_quantity(value, unit))


def _part(text: str) -> str:
    return text if _ATOM.fullmatch(text) else f"({text})"
