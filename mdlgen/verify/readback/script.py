"""The companion script of a text, read without running it: its numbers, and that the rest is as written."""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from mdlgen.altair.literals import literal, name_of, without_notes, wrong
from mdlgen.errors import Place, SpecError

DEFAULT_SMOOTHING = 1.0  # of a contact that nothing gives one [mm/s]
# Property of the script -> column of the contacts.
PROPERTIES = {
    "penalty": "penalty",
    "rest_coeff": "restitution",
    "mu_static": "mu_static",
    "mu_dynamic": "mu_dynamic",
    "stiction_trans_vel": "stiction_velocity",
    "friction_trans_vel": "friction_velocity",
    "normal_trans_vel": "normal_trans_vel",
}
_DATA = ("CONTACTS", "SYSTEM")


class Followed(NamedTuple):
    """A number that is so many times a value of the model."""

    written: float
    path: str  # of the value: ds_contact_2.real_k
    times: float


class Script(NamedTuple):
    """The numbers that a script sets, by contact."""

    contacts: dict[str, dict[str, float | Followed]]
    rest: str  # its statements without the data, in a normal form
    system: str | None = None  # path of the system in the model that the contacts are in

    def numbers(self, contact: str, model: Mapping[str, Mapping[str, Any]] | None = None) -> dict[str, float]:
        """Numbers of one contact, with what MotionView takes where nothing is said; of what follows values of
        the model, as those are in its data sets, nan where they are not. Without them as written."""
        found = {"normal_trans_vel": DEFAULT_SMOOTHING}
        for column, given in self.contacts.get(contact, {}).items():
            if isinstance(given, Followed):
                holder, _, member = given.path.partition(".")
                now = given.written if model is None else math.nan
                if model is not None and member in model.get(holder, {}):
                    now = given.times * float(model[holder][member])
                found[column] = now
            else:
                found[column] = given
        return found

    @property
    def follows(self) -> bool:
        """True if some number follows a value of the model."""
        return any(isinstance(v, Followed) for numbers in self.contacts.values() for v in numbers.values())


NONE = Script({}, "")


def read(text: str, file: str = "<script>") -> Script:
    """Raises SpecError with the place of a statement that differs from the companion's form."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        place = Place(file, getattr(error, "lineno", None) or 1, getattr(error, "offset", None) or 1)
        raise SpecError(f"this is no Python: {error}", place=place) from None
    data: dict[str, Any] = {}
    rest: list[ast.stmt] = []
    for statement in tree.body:
        name = name_of(statement)
        if name not in _DATA:
            rest.append(statement)
            continue
        assert isinstance(statement, ast.Assign)
        if name in data:
            raise wrong(f"{name} is given twice", statement, file)
        data[name] = literal(statement, file)
    try:
        contacts = _contacts(data.get("CONTACTS", []))
    except ValueError as error:
        raise wrong(str(error), tree.body[0], file) from None
    system = data.get("SYSTEM")
    if not isinstance(system, str | None):
        raise wrong("SYSTEM is a text", tree.body[0], file)
    return Script(contacts, ast.dump(ast.Module(without_notes(rest), [])), system)


def _contacts(value: Any) -> dict[str, dict[str, float | Followed]]:
    found: dict[str, dict[str, float | Followed]] = {}
    if not isinstance(value, list):
        raise ValueError("CONTACTS is a list")
    for item in value:
        if not (isinstance(item, tuple) and len(item) == 2 and isinstance(item[0], dict)):
            raise ValueError("an item of CONTACTS is a pair of numbers and names")
        given, names = item
        unknown = [k for k in given if k not in PROPERTIES]
        if unknown or not isinstance(names, list) or not all(isinstance(n, str) for n in names):
            raise ValueError(
                f"CONTACTS: {unknown[0]!r} is no property" if unknown else "CONTACTS: names are due"
            )
        numbers = {PROPERTIES[k]: _given(v) for k, v in given.items()}
        for name in names:
            if name in found:
                raise ValueError(f"CONTACTS: {name} is there twice")
            found[name] = numbers
    return found


def _given(value: Any) -> float | Followed:
    if not isinstance(value, tuple):
        return _number(value)
    if len(value) != 3 or not isinstance(value[1], str) or value[1].count(".") != 1:
        raise ValueError(f"{value!r} is not (number, value of the model, times)"[:200])
    return Followed(_number(value[0]), value[1], _number(value[2]))


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f"{value!r} is no number")
    return float(value)
