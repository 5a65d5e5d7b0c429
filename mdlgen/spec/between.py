"""The pairs of parts that the contacts of a scene name, and the errors for pairs that cannot touch."""

from __future__ import annotations

import re
from collections.abc import Collection
from fnmatch import fnmatchcase
from itertools import product
from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from mdlgen.errors import did_you_mean
from mdlgen.spec.machine_part import MachinePart, not_modelled
from mdlgen.spec.measured import unlike_measured
from mdlgen.spec.strict import fail

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene

MOST_ERRORS = 100  # that are looked for in contacts: more are not shown


def find_pairs(scene: Scene) -> tuple[list[tuple[int, str, str]], list[PydanticCustomError]]:
    """The pairs, and the error of each contact that has none or may not have them."""
    machine = scene.machine
    rank = {n: i for i, n in enumerate([*scene.sheets, *machine, *scene.parts])}
    taken: dict[tuple[str, str], int] = {}
    errors: list[PydanticCustomError] = []
    looked = 0
    for index, contact in enumerate(scene.contacts):
        path = ("contacts", index, "between")
        patterns = [p for side in contact.between for p in ((side,) if isinstance(side, str) else side)]
        looked += len(rank) * sum(not pattern.isidentifier() for pattern in patterns)
        looked += len(patterns)
        if message := scene.limits.exceeded("contacts", looked / 100, "hundreds of names that patterns meet"):
            return [], [*errors, fail(message, path)]
        try:
            _take_pairs(scene, index, machine, rank, taken)
        except PydanticCustomError as error:
            errors.append(error)
        if len(errors) > MOST_ERRORS:
            break
    return [(index, *pair) for pair, index in taken.items()], errors


def _take_pairs(
    scene: Scene,
    index: int,
    machine: dict[str, MachinePart],
    rank: dict[str, int],
    taken: dict[tuple[str, str], int],
) -> None:
    """Adds the pairs of one contact to those that are taken."""
    path = ("contacts", index, "between")
    sides = [_side(p, rank, (*path, i)) for i, p in enumerate(scene.contacts[index].between)]
    found = False
    for one, two in product(*sides):
        if one == two:
            continue
        a, b = sorted((one, two), key=rank.__getitem__)
        if (a, b) in taken:
            if taken[a, b] == index:
                continue
            other = scene.contacts[taken[a, b]].name or taken[a, b]
            raise fail(f"the pair {a} / {b} already has contacts.{other}; give it one", path)
        _modelled(scene, index, (a, b), machine.get(b))
        if message := scene.limits.exceeded("contacts", len(taken) + 1, "pairs of parts in contact"):
            raise fail(message, path)
        taken[a, b] = index
        found = True
    if not found:
        raise fail("between names one part only; a contact needs two", path)


def _modelled(scene: Scene, index: int, names: tuple[str, str], part: MachinePart | None) -> None:
    """Raises the error where a contact between two parts, those of an entry, is not modelled; `part` is the
    second one."""
    path, (a, b) = ("contacts", index, "between"), names
    if scene.contacts[index].air is not None and (message := _without_air(scene, names)):
        raise fail(message, ("contacts", index, "air"))
    if (unlike := unlike_measured(scene, index, names)) is not None:
        raise fail(unlike[1], ("contacts", index, "friction", unlike[0]))
    if a in scene.sheets:
        wrong = part.unlike_sheets(b, scene.contacts[index]) if part is not None else None
        if wrong is not None:
            raise fail(wrong[1], (*path[:-1], wrong[0]))
        return
    if part is None:
        raise fail(f"{not_modelled(names)}both are of the machine; give it where {b} is", path)
    roller = scene.rollers.get(a)
    message = part.unlike_others(names) if roller is None else part.unlike_roller(names, roller)
    if message is not None:
        raise fail(message, path)


def _without_air(scene: Scene, names: tuple[str, str]) -> str | None:
    """Why there is no air between two parts; None: there can be."""
    a, b = names
    plane = scene.planes.get(b)
    if a in scene.sheets and (b in scene.sheets or (plane is not None and plane.press is None)):
        return None
    return f"air between {a} and {b} is not modelled: it is between two sheets, or a sheet and a fixed plane"


def known(name: str, table: Collection[str], kind: str, path: tuple[str | int, ...]) -> None:
    """Raises the error for a name that is not in a table."""
    if name not in table:
        close = did_you_mean(name, table)
        raise fail(f"there is no {kind} {name!r}{close or ';'} there are: {', '.join(table) or 'none'}", path)


def _side(side: str | tuple[str, ...], parts: Collection[str], path: tuple[str | int, ...]) -> list[str]:
    """The parts of one side of a contact, each once."""
    if isinstance(side, str):
        return matching(side, parts, path)
    found = [name for k, pattern in enumerate(side) for name in matching(pattern, parts, (*path, k))]
    return list(dict.fromkeys(found))


def matching(pattern: str, parts: Collection[str], path: tuple[str | int, ...]) -> list[str]:
    """The parts that a name or a pattern means; raises the error where there is none."""
    if not re.fullmatch(r"[A-Za-z0-9_*?]{1,64}", pattern):
        raise fail(f"{pattern[:80]!r} is not a name or a pattern of letters, digits, _, * and ?", path)
    if pattern.isidentifier():
        found = [pattern] if pattern in parts else []
    else:
        found = [name for name in parts if fnmatchcase(name, pattern)]
    if not found:
        close = did_you_mean(pattern, parts)
        raise fail(f"there is no part {pattern!r}{close or ';'} there are: {', '.join(parts)}", path)
    return found
