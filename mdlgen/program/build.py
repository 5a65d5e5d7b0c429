"""Makes the shipped programs: `python -m mdlgen.program.build`; with `--check` it says whether they fit.

A process for each program has numba compile its entries, for the types that they have in some small scenes,
without optimisation. The texts of the entries (`inspect_llvm`) are linked into one module, and unused
functions are removed. Each entry gets a wrapper that takes its arguments as words. LLVM optimises the module
without vector instructions, because these depend on the machine that it will run on, and divides it into two
parts. Shared libraries for the targets in `emit.SHIPPED` are made of that bitcode, in the same folder.
`--libraries` makes them again of the bitcode that is there, and `--verify` compares what that gives with what
is shipped. Where comments and docstrings of kernels alone have changed, the programs still fit. But each
process takes 0.3 s to find that out: `--stamp` writes the digest of the new sources into them.

It stands above what it makes, so it knows that by name only.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib
import json
import os
import re
import subprocess
import sys
import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from mdlgen import paths
from mdlgen.program import file
from mdlgen.program.digests import sources_digest, statements_digest
from mdlgen.program.emit import SHIPPED, SMALL, Target
from mdlgen.program.file import Head, Unfit, Variant
from mdlgen.program.kernel import Kernel
from mdlgen.program.layout import described, words
from mdlgen.program.link import linked
from mdlgen.program.native import emitted
from mdlgen.program.parts import split
from mdlgen.program.ship import Program

# Functions of the operating system that a program may call.
SYSTEM = (
    *("malloc", "free", "memcpy", "memmove", "memset"),
    *("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh"),
    *("exp", "exp2", "expm1", "log", "log2", "log10", "log1p", "pow", "sqrt", "hypot", "cbrt"),
    *("floor", "ceil", "trunc", "rint", "round", "fmod", "ldexp", "frexp", "fma"),
)
# The number of parts of a program. They are made into machine code at the same time.
PARTS = 2
# numba's memory: an array is counted by those who hold it, each of which is of the same thread.
MEMORY = """
%info = type { i64, ptr, ptr, ptr, i64 }
declare ptr @malloc(i64)
declare void @free(ptr)

define ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %align) {
  %wide = zext i32 %align to i64
  %head = add i64 %wide, 40
  %all = add i64 %size, %head
  %made = call ptr @malloc(i64 %all)
  %none = icmp eq ptr %made, null
  br i1 %none, label %out, label %fill
fill:
  %begin = ptrtoint ptr %made to i64
  %high = add i64 %begin, %head
  %over = urem i64 %high, %wide
  %at = sub i64 %high, %over
  %data = inttoptr i64 %at to ptr
  store i64 1, ptr %made
  %data_at = getelementptr %info, ptr %made, i32 0, i32 3
  store ptr %data, ptr %data_at
  %size_at = getelementptr %info, ptr %made, i32 0, i32 4
  store i64 %size, ptr %size_at
  br label %out
out:
  ret ptr %made
}

define ptr @NRT_MemInfo_data_fast(ptr %info) {
  %data_at = getelementptr %info, ptr %info, i32 0, i32 3
  %data = load ptr, ptr %data_at
  ret ptr %data
}

define void @NRT_incref(ptr %info) {
  %none = icmp eq ptr %info, null
  br i1 %none, label %out, label %count
count:
  %held = load i64, ptr %info
  %more = add i64 %held, 1
  store i64 %more, ptr %info
  br label %out
out:
  ret void
}

define void @NRT_decref(ptr %info) {
  %none = icmp eq ptr %info, null
  br i1 %none, label %out, label %count
count:
  %held = load i64, ptr %info
  %less = sub i64 %held, 1
  store i64 %less, ptr %info
  %last = icmp eq i64 %less, 0
  br i1 %last, label %drop, label %out
drop:
  call void @free(ptr %info)
  br label %out
out:
  ret void
}
"""


def main() -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(prog="python -m mdlgen.program.build", description=__doc__)
    parser.add_argument("--check", action="store_true", help="say whether the programs fit; make none")
    parser.add_argument("--stamp", action="store_true", help="take over new comments and docstrings")
    parser.add_argument("--libraries", action="store_true", help="make the libraries again of the bitcode")
    parser.add_argument(
        "--verify", action="store_true", help="say whether that gives the same; write nothing"
    )
    wanted = parser.parse_args()
    if wanted.check or wanted.stamp:
        sys.exit(_check(wanted.stamp))
    if wanted.libraries or wanted.verify:
        sys.exit(_libraries(wanted.verify))
    surroundings = {
        **os.environ,
        "MDLGEN_NUMBA": "1",
        # keeps pieces for the next time
        "MDLGEN_CACHE": str(paths.cache("made")),
        "NUMBA_OPT": "0",
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
    }
    code = "from mdlgen.program import build; build.make({!r})"
    made = [
        subprocess.Popen([sys.executable, "-c", code.format(name)], env=surroundings) for name in _shipped()
    ]
    codes = [one.wait() for one in made]  # negative where a signal ended it
    sys.exit(any(codes))


def _shipped() -> dict[str, Any]:
    """The `mdlgen.backend.Shipped` of each solver that has a program, by the solver's name."""
    registry = importlib.import_module("mdlgen.registry")
    found = {name: registry.solver(name).shipped for name in registry.AUTO}
    return {name: shipped for name, shipped in found.items() if shipped is not None}


def programs() -> list[Program]:
    """All programs of this installation."""
    return [importlib.import_module(shipped.module).PROGRAM for shipped in _shipped().values()]


def _check(stamp: bool) -> int:
    """Says whether the programs fit; `stamp`: writes the digest of sources into those that do."""
    wrong = 0
    for program in programs():
        name = program.path.name
        try:
            head, digest = program.head(), sources_digest(program.rooms)
            if head.digest == digest:
                print(f"{name} fits the kernels")
            elif stamp:
                _, parts = file.read(program.path)
                file.write(program.path, replace(head, digest=digest), file.pack(parts)[0])
                print(f"{name} fits the kernels, and has their digest now")
            else:
                print(f"{name} fits the kernels, whose comments are new; --stamp writes their digest into it")
                wrong = 1
        except Unfit as error:
            print(f"{error}; python -m mdlgen.program.build rebuilds it")
            wrong = 1
    return wrong


def _libraries(verify: bool) -> int:
    """Makes the libraries of all programs again of their bitcode; `verify`: compares them alone."""
    wrong = 0
    for program in programs():
        path = program.path
        try:
            head, parts = file.read(path)
            if not verify:
                size = write_libraries(path, head, file.pack(parts)[0], parts)
                print(f"{path.name} and its libraries: {size / 1e6:.2f} MB")
                continue
            for target in SHIPPED:
                there = file.library(path, target.name)
                same = there.exists() and there.read_bytes() == library(target, head, path.stem, parts)
                print(f"{there.name}: {'the same' if same else 'DIFFERS'}")
                wrong |= not same
        except Unfit as error:
            print(f"{error}; python -m mdlgen.program.build rebuilds it")
            wrong = 1
    return wrong


def make(name: str) -> None:
    """Makes the program of a solver, in a process in which numba optimises nothing."""
    warnings.simplefilter("ignore")  # what is not optimised numba would not keep
    shipped = _shipped()[name]
    program: Program = importlib.import_module(shipped.module).PROGRAM
    types = watched(program)
    for kernel in program.entries:
        kernel.dispatcher._cache.disable()  # numba has no text of cached code
    _play(name, shipped.scenes)
    if missing := [entry for entry, found in types.items() if not found]:
        sys.exit(f"{program.path.name}: no scene calls {', '.join(missing)}")
    size = write(program, types)
    print(f"{program.path.name}: {size / 1e6:.2f} MB, {len(types)} entries")


# The types of an entry's arguments as JSON, with numba's signature and the kernel; by the entry's name.
Types = dict[str, dict[str, tuple[Any, Kernel]]]


def watched(program: Program) -> Types:
    """The types with which the entries of a program are called from now on."""
    typeof = importlib.import_module("numba").typeof
    found: Types = {kernel.__name__: {} for kernel in program.entries}
    for kernel in program.entries:
        kernel.watch(_watcher(found[kernel.__name__], kernel, typeof))
    return found


def _play(solver: str, scenes: tuple[tuple[str, tuple[str, ...]], ...]) -> None:
    """Runs the scenes of a solver (sample, values)."""
    load, lower = (importlib.import_module(f"mdlgen.{name}") for name in ("spec.load", "model.lower"))
    samples = importlib.import_module("mdlgen.paths").samples()
    solve = importlib.import_module("mdlgen.registry").solve
    for sample, sets in scenes:
        solve(lower.lower(load.load(samples / sample, sets)), solver)


def write(program: Program, types: Types) -> int:
    """Writes a program for some types; its size. Ends the process where kernels call what it may not."""
    import llvmlite
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_triple(llvm.get_process_triple()).create_target_machine(opt=3, reloc="pic")
    whole, entries = link(types)
    external = shrink(whole, target)
    if strange := sorted(set(external) - set(SYSTEM)):
        sys.exit(f"{program.path.name}: kernels call what no program may: {', '.join(strange)}")
    parts = split(whole, PARTS)
    packed, code = file.pack(parts)
    versions = {
        "python": sys.version.split()[0],
        "llvmlite": llvmlite.__version__,
        "llvm": ".".join(map(str, llvm.llvm_version_info)),
        "numba": importlib.import_module("numba").__version__,
    }
    sizes = tuple(map(len, parts))
    digest, statements = sources_digest(program.rooms), statements_digest(program.rooms)
    head = Head(digest, statements, code, versions, entries, tuple(external), sizes, {})
    return write_libraries(program.path, head, packed, parts)


def write_libraries(path: Path, head: Head, packed: bytes, parts: Sequence[bytes]) -> int:
    """Writes a program, of which `packed` is the compressed bitcode of its `parts`, and its libraries.
    Returns how many bytes they have."""
    made = {target.name: library(target, head, path.stem, parts) for target in SHIPPED}
    for name, code in made.items():
        file.library(path, name).write_bytes(code)
    digests = {name: hashlib.sha256(code).hexdigest() for name, code in made.items()}
    file.write(path, replace(head, libraries=digests), packed)
    return path.stat().st_size + sum(map(len, made.values()))


def library(target: Target, head: Head, name: str, parts: Sequence[bytes]) -> bytes:
    """The shared library for a target from the bitcode of a program: the same bytes on every machine with the
    same llvmlite and ziglang."""
    codes = emitted(target, parts, range(len(parts)))
    return linked(target, codes, name, [v.symbol for variants in head.entries.values() for v in variants])


def _watcher(found: dict[str, tuple[Any, Kernel]], kernel: Kernel, typeof: Any) -> Any:
    def watch(args: tuple[Any, ...]) -> None:
        types_of = json.dumps([described(arg) for arg in args])
        if types_of not in found:
            found[types_of] = tuple(typeof(arg) for arg in args), kernel

    return watch


def link(types: Types) -> tuple[Any, dict[str, tuple[Variant, ...]]]:
    """One module of LLVM with all entries, and what they are."""
    import llvmlite.binding as llvm

    whole = llvm.parse_assembly(MEMORY)
    entries: dict[str, tuple[Variant, ...]] = {}
    for name, variants in types.items():
        made: list[Variant] = []
        for types_of, (signature, kernel) in variants.items():
            symbol = f"{name}_{len(made)}"
            overload = kernel.dispatcher.overloads[signature]
            inner = overload.fndesc.llvm_func_name
            arguments = json.loads(types_of)
            text = _stripped(kernel.dispatcher.inspect_llvm(signature), inner)
            module = llvm.parse_assembly(text + _wrapper(text, inner, symbol, sum(map(words, arguments))))
            module.triple, module.data_layout = whole.triple, whole.data_layout
            whole.link_in(module)
            made.append(Variant(symbol, tuple(arguments), _result(overload.signature.return_type)))
        entries[name] = tuple(made)
    # a function that several entries call has one name, and occurs once
    open_to_all = {variant.symbol for variants in entries.values() for variant in variants}
    for thing in (*whole.functions, *whole.global_variables):
        if not thing.is_declaration and thing.name not in open_to_all:
            thing.linkage = "internal"
    return whole, entries


def _result(kind: Any) -> Any:
    """numba's type of a result as layout has it."""
    types = importlib.import_module("numba").types
    plain = {types.none: "none", types.float64: "f8", types.int64: "i8", types.boolean: "b1"}
    if isinstance(kind, types.BaseTuple):
        return ["tuple", [_result(item) for item in kind]]
    return plain[kind]


def _stripped(text: str, inner: str) -> str:
    """A module without numba's memory and without what Python calls."""
    kept: list[str] = []
    inside = False
    for line in text.splitlines():
        if line.startswith("define ") and (found := re.search(r'@("?)([^"(]+)\1\(', line)):
            name = found.group(2)
            if name.startswith(("NRT_", "nrt_")):
                inside = True
                continue
            inside = "7cpython" in name[:14] or name.startswith(("cfunc.", "_ZN7cfunc"))
        if not inside:
            kept.append(line)
        elif line == "}":
            inside = False
    # exceptions as pickles: nobody reads them, and they name files of the machine that they were made on
    pickles = r'(= internal constant \[\d+ x i8\]) c"\\80\\04\\95[^"\n]*"'
    text = re.sub(pickles, r"\1 zeroinitializer", "\n".join(kept))
    for name, shape in (
        ("NRT_MemInfo_alloc_aligned", "ptr @{}(i64, i32)"),
        ("NRT_MemInfo_data_fast", "ptr @{}(ptr)"),
        ("NRT_incref", "void @{}(ptr)"),
        ("NRT_decref", "void @{}(ptr)"),
    ):
        if f"@{name}(" in text and not re.search(rf"^declare [^\n]*@{name}\(", text, re.MULTILINE):
            text += f"\ndeclare {shape.format(name)}"
    return text + "\n"


def _wrapper(text: str, inner: str, symbol: str, size: int) -> str:
    """A function that takes the address of words: that of the result, of the error, and the arguments."""
    quoted = f'@"{inner}"' if f'@"{inner}"(' in text else f"@{inner}"
    line = next(line for line in text.splitlines() if line.startswith("define ") and f"{quoted}(" in line)
    inside = line[line.index(f"{quoted}(") + len(quoted) + 1 : line.rindex(")")]
    kinds = [argument.split()[0] for argument in inside.split(",")]
    if len(kinds) != size + 2:
        sys.exit(f"{symbol}: numba passes {len(kinds) - 2} words for {size}")
    body = [f"define i32 @{symbol}(ptr %words) {{"]
    for k, kind in enumerate(kinds):
        body.append(f"  %p{k} = getelementptr i64, ptr %words, i64 {k}")
        body.append(f"  %a{k} = load {kind}, ptr %p{k}")
    passed = ", ".join(f"{kind} %a{k}" for k, kind in enumerate(kinds))
    body += [f"  %r = call i32 {quoted}({passed})", "  ret i32 %r", "}"]
    return "\n".join(body) + "\n"


def shrink(whole: Any, target: Any) -> list[str]:
    """Optimises a module for all machines alike; returns what it calls of the system."""
    import llvmlite.binding as llvm

    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_vectorization = tuning.slp_vectorization = False
    # loops are opened for the machine, too
    tuning.loop_unrolling, tuning.inlining_threshold = False, SMALL
    builder = llvm.create_pass_builder(target, tuning)
    builder.getModulePassManager().run(whole, builder)
    # names inside say nothing to anybody, and are half of the file
    manager = llvm.create_new_module_pass_manager()
    manager.add_strip_symbols_pass()
    manager.run(whole, builder)
    named = {f.name for f in whole.functions if f.is_declaration}
    inner = {name.split(".")[1] for name in named if name.startswith("llvm.")}
    # LLVM compiles its own intrinsics to calls of the system on most machines
    return sorted({name for name in named if not name.startswith("llvm.")} | (inner & set(SYSTEM)))


if __name__ == "__main__":
    main()
