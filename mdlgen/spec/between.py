"""Which pairs of parts the contacts of a scene are between, and what is wrong where one cannot be."""

from __future__ import annotations

import math
import re
from collections.abc import Collection
from fnmatch import fnmatchcase
from itertools import product
from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from mdlgen.errors import did_you_mean
from mdlgen.spec.strict import fail

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene

# Tables of parts of the machine, in the order of their bodies.
MACHINE = ("rollers", "planes", "guides", "meshes")
MOST_ERRORS = 100  # that are looked for in contacts: more are not shown


def find_pairs(scene: Scene) -> tuple[list[tuple[int, str, str]], list[PydanticCustomError]]:
    """The pairs, and what is wrong with each contact that has none or may not have them."""
    machine = [name for kind in (*MACHINE, "parts") for name in getattr(scene, kind)]
    rank = {n: i for i, n in enumerate([*scene.sheets, *machine])}
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
            _take_pairs(scene, index, rank, taken)
        except PydanticCustomError as error:
            errors.append(error)
        if len(errors) > MOST_ERRORS:
            break
    return [(index, *pair) for pair, index in taken.items()], errors


def _take_pairs(scene: Scene, index: int, rank: dict[str, int], taken: dict[tuple[str, str], int]) -> None:
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
        _modelled(scene, a, b, path)
        if message := scene.limits.exceeded("contacts", len(taken) + 1, "pairs of parts in contact"):
            raise fail(message, path)
        taken[a, b] = index
        found = True
    if not found:
        raise fail("between names one part only; a contact needs two", path)


def _modelled(scene: Scene, a: str, b: str, path: tuple[str | int, ...]) -> None:
    if a in scene.sheets:
        if b in scene.meshes:
            _meshed(scene, b, path)
        return
    if b in scene.parts:
        raise fail(
            f"contact between {a} and {b} is not modelled: both are of the machine; give it where {b} is",
            path,
        )
    if b not in scene.rollers:
        _on_part(scene, a, b, path)
        return
    one, two = scene.rollers[a].axis, scene.rollers[b].axis
    if abs(abs(sum(p * q for p, q in zip(one, two, strict=True))) - 1.0) > 1e-9:
        raise fail(f"the rollers {a} and {b} are in contact but their axes are not parallel", path)
    if scene.rollers[a].rim is not None and scene.rollers[b].rim is not None:
        raise fail(f"contact between {a} and {b} is not modelled: both have a rim of sectors", path)


def _on_part(scene: Scene, a: str, b: str, path: tuple[str | int, ...]) -> None:
    """Raises the error for a contact between two parts of the machine, the second no roller, that is not
    modelled."""
    kind = "guide" if b in scene.guides else "mesh" if b in scene.meshes else "plane"
    message = f"contact between {a} and {b} is not modelled: "
    if a not in scene.rollers:
        raise fail(f"{message}a {kind} touches sheets and rollers only", path)
    roller, sectors = scene.rollers[a], scene.rollers[a].rim is not None
    if b in scene.meshes:
        if scene.meshes[b].on is not None:
            raise fail(f"{message}{b} is on a roller, and such a mesh touches sheets only", path)
        if sectors:
            raise fail(f"{message}the rim of {a} is in sectors, and a mesh meets round rollers only", path)
        return
    guide = scene.guides.get(b)
    arc = guide.arc if guide is not None else None
    if arc is not None:
        if abs(abs(_cosine(roller.axis, arc.axis)) - 1.0) > 1e-9:
            raise fail(f"{message}the roller's axis is not parallel to that of the arc", path)
        if sectors:
            raise fail(f"{message}the rim of {a} is in sectors, and an arc meets round rollers only", path)
        return
    normal = scene.planes[b].normal if guide is None else guide.normal
    steep = abs(_cosine(roller.axis, normal))
    if steep > 0.5:
        raise fail(
            f"{message}the roller stands on its end, its axis {math.degrees(math.acos(steep)):.3g} deg "
            "off the normal of the face; allowed: 60 deg or more",
            path,
        )


def _meshed(scene: Scene, name: str, path: tuple[str | int, ...]) -> None:
    if scene.contacts[int(path[1])].share == "pair":
        raise fail(
            f"share: pair is not modelled with the mesh {name}: boxes share it by the area they cover",
            (*path[:-1], "share"),
        )


def known(name: str, table: Collection[str], kind: str, path: tuple[str | int, ...]) -> None:
    """Raises the error for a name that is not in a table."""
    if name not in table:
        close = did_you_mean(name, table)
        raise fail(f"there is no {kind} {name!r}{close or ';'} there are: {', '.join(table) or 'none'}", path)


def _cosine(one: tuple[float, float, float], two: tuple[float, float, float]) -> float:
    return max(-1.0, min(1.0, sum(p * q for p, q in zip(one, two, strict=True))))


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
