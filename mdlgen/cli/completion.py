"""Completions of options in a shell: names that the code knows, and paths of the scene that the line names.

Bash takes `=` as the end of a word. It passes `--set`, `run.analysis`, `=`, `st`, and replaces the last word
by the completion. `mend_bash` joins such words again, and stores the text before the last `=`.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from mdlgen.errors import MdlgenError


def _of(names: Iterable[str], incomplete: str) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def solvers(incomplete: str) -> list[str]:
    from mdlgen.registry import AUTO

    return _of(("auto", *AUTO), incomplete)


def every_solver(incomplete: str) -> list[str]:
    from mdlgen.registry import AUTO

    return _of(AUTO, incomplete)


def sample_names(incomplete: str) -> list[str]:
    from mdlgen.paths import samples

    root = samples()
    return _of(
        (p.relative_to(root).with_suffix("").as_posix() for p in sorted(root.rglob("*.yaml"))), incomplete
    )


def fits(incomplete: str) -> list[str]:
    from mdlgen.calibrate.value import FITS

    return _of(FITS, incomplete)


def codes(incomplete: str) -> list[str]:
    from mdlgen.explain import SCENE, TEXT

    return _of((*SCENE, *TEXT), incomplete)


def suites(incomplete: str) -> list[str]:
    from mdlgen.bench.suites import SUITES

    return _of((*SUITES, "campaign", "tuning"), incomplete)


def methods(incomplete: str) -> list[str]:
    return _of(("auto", "brent", "cobyqa", "optuna"), incomplete)


def limits(incomplete: str) -> list[str]:
    from mdlgen.spec.limits import Limits

    return _of((f"{name}=" for name in Limits._fields), incomplete)


def sheets_only(incomplete: str) -> list[str]:
    return _of(("sheets",), incomplete)


# The part of the completed word that bash has removed, up to its last `=`, for the rest of this process.
BEFORE = "_MDLGEN_COMPLETE_BEFORE"


def mend_bash() -> None:
    """Before the command line looks at them: the words that bash gives, as they were typed."""
    try:
        words, at = shlex.split(os.environ["COMP_WORDS"]), int(os.environ["COMP_CWORD"])
    except (KeyError, ValueError):  # not called by bash, or a quote is open
        return
    typed = whole(words[: at + 1])
    option, sign, value = typed[-1].partition("=") if typed[-1].startswith("--") else ("", "", typed[-1])
    before = value[: value.rfind("=") + 1]
    os.environ[BEFORE] = before
    os.environ["COMP_WORDS"] = shlex.join([*typed[:-1], option + sign + value[len(before) :]])
    os.environ["COMP_CWORD"] = str(len(typed) - 1)


def whole(words: list[str]) -> list[str]:
    """Words put together again where `=` has cut them."""
    found: list[str] = []
    for k, word in enumerate(words):
        if found and (word == "=" or words[k - 1] == "="):
            found[-1] += word
        else:
            found.append(word)
    return found


def scene_paths(ctx: Any, incomplete: str) -> list[str]:
    """Completions of `--set` and similar options: the next part of a path, or behind `=` the allowed
    values."""
    before = os.environ.get(BEFORE, "")
    offered = paths(_scene(ctx.params.get("spec")), before + incomplete)
    return [text[len(before) :] for text in offered]


def paths(scene: Any, incomplete: str) -> list[str]:
    """Completions of `incomplete`, `sheets.no` or `run.analysis=`, for a scene as it was read."""
    from mdlgen.spec.schema import keys, model_at

    path, sign, _ = incomplete.partition("=")
    *before, _ = path.split(".")
    node = scene
    for word in before:
        node = _child(node, word)
    model = model_at(tuple(before))
    if sign:
        own = keys(model) if model is not None else {}
        key = path.rpartition(".")[2]
        return _of((f"{path}={choice}" for choice in _choices(own, key)), incomplete)
    head = ".".join([*before, ""]) if before else ""
    if model is not None:
        names = {
            name: model_at((*before, name)) is not None or _is_table(f) for name, f in keys(model).items()
        }
    else:  # names of the scene's own, or indices of a list
        held = node if isinstance(node, dict) else range(len(node)) if isinstance(node, list) else ()
        names = {str(name): True for name in held}
    return _of((f"{head}{name}{'.' if inner else '='}" for name, inner in names.items()), incomplete)


def _child(node: Any, word: str) -> Any:
    if isinstance(node, dict):
        return node.get(word)
    if isinstance(node, list) and word.isdigit() and int(word) < len(node):
        return node[int(word)]
    return None


def _is_table(field: Any) -> bool:
    """True if a key holds parts by name, or a list of them."""
    from pydantic import BaseModel

    def held(annotation: Any) -> bool:
        return isinstance(annotation, type) and issubclass(annotation, BaseModel)

    annotation = field.annotation
    return get_origin(annotation) in (dict, tuple) and any(held(part) for part in get_args(annotation))


def _choices(fields: dict[str, Any], key: str) -> list[str]:
    """Values of an enumeration, or of a switch."""
    if key not in fields:
        return []
    annotation = fields[key].annotation
    parts = get_args(annotation) if get_origin(annotation) is not Literal else (annotation,)
    for part in (annotation, *parts):
        if get_origin(part) is Literal:
            return [str(value) for value in get_args(part)]
        if part is bool:
            return ["true", "false"]
    return []


def _scene(spec: Any) -> Any:
    """A scene file as plain mappings and lists; nothing where it cannot be read."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    from mdlgen.paths import read_at_most

    if spec is None:
        return {}
    try:
        return YAML(typ="safe").load(read_at_most(Path(spec), 10_000_000, named=True))
    except (YAMLError, MdlgenError, OSError, ValueError, RecursionError):
        return {}
