"""A module of LLVM in parts that become machine code apart from each other, at the same time.

Functions go to the parts by size, and what a part calls of another one is declared there, with all that is
known of it. Small functions, which may be opened where they are called, and constants stand in each part.
"""

from __future__ import annotations

import re
from typing import Any

from mdlgen.program.emit import INNER

# Instructions of a module that is worth a second processor, and of a function that each part has for itself.
WORTH, OWN = 20_000, 60
_NAME = re.compile(r'@("?)([\w.]+)\1')


def split(whole: Any, count: int) -> list[bytes]:
    """Bitcode of `count` parts of a module of llvmlite, or of all of it in one where it is small."""
    functions = [function for function in whole.functions if not function.is_declaration]
    sizes: dict[str, int] = {}
    for k, function in enumerate(functions):
        if not function.name:
            function.name = f"{INNER}{k}"
        sizes[function.name] = sum(1 for block in function.blocks for _ in block.instructions)
    if sum(sizes.values()) < WORTH:
        return [whole.as_bitcode()]
    rest, bodies = _bodies(str(whole))
    inside = {name for name, body in bodies.items() if body.startswith("define internal ")}
    own = {name for name in inside if sizes[name] < OWN}
    loads, part_of = [0] * count, dict.fromkeys(own, -1)
    for name in sorted(sizes.keys() - own, key=lambda name: (-sizes[name], name)):
        part_of[name] = loads.index(min(loads))
        loads[part_of[name]] += sizes[name]
    return [_part(rest, bodies, part_of, inside, k) for k in range(count)]


def _bodies(text: str) -> tuple[list[str], dict[str, str]]:
    """Lines of a module outside of functions, and its functions by name."""
    rest: list[str] = []
    bodies: dict[str, str] = {}
    lines = iter(text.splitlines())
    for line in lines:
        if not line.startswith("define "):
            rest.append(line)
            continue
        body = [line]
        while body[-1] != "}":
            body.append(next(lines))
        found = _NAME.search(line)
        assert found is not None
        bodies[found.group(2)] = "\n".join(body)
    return rest, bodies


def _part(
    rest: list[str], bodies: dict[str, str], part_of: dict[str, int], inside: set[str], part: int
) -> bytes:
    import llvmlite.binding as llvm

    called = {
        name: {found.group(2) for found in _NAME.finditer(body)} & bodies.keys() - {name}
        for name, body in bodies.items()
    }
    abroad = set[str]().union(*(called[name] for name in bodies if part_of[name] != part))
    needed = set[str]().union(*(called[name] for name in bodies if part_of[name] in (part, -1)))
    text = list(rest)
    for name, body in bodies.items():
        if part_of[name] == -1 or (part_of[name] == part and not (name in inside and name in abroad)):
            text.append(body)
        elif part_of[name] == part:
            text.append(body.replace("define internal ", "define ", 1))
        elif name in needed:
            line, _, _ = body.partition("\n")
            text.append(line.replace("define internal ", "declare ", 1).removesuffix(" {"))
    module = llvm.parse_assembly("\n".join(text) + "\n")
    llvm.initialize_native_target()
    target = llvm.Target.from_triple(llvm.get_process_triple()).create_target_machine()
    manager = llvm.create_new_module_pass_manager()
    manager.add_global_dead_code_eliminate_pass()
    manager.run(module, llvm.create_pass_builder(target, llvm.create_pipeline_tuning_options()))
    return module.as_bitcode()
