"""Machine code of bitcode, for this machine or for one that programs are shipped for.

Run as a script with the words of a Target, it emits what it reads, in a process of its own: llvmlite works
for one thread of a process at a time, so the parts of a program are emitted by several. This file imports
nothing of mdlgen, which takes longer to import than llvmlite.
"""

from __future__ import annotations

import platform
import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

# Functions up to this size (in LLVM's own measure, whose default is 225) are opened where they are called;
# kernels say themselves which others are to be. More is twice the time to prepare, and no faster.
SMALL = 25
# Prefix of functions that are called only by others of the same program.
INNER = "kernel."


class Target(NamedTuple):
    """A target for machine code. All fields are words, which a process of its own is called with.

    `form`: LIBRARY, of which a linker makes a shared library; APART or JOINED, for this process, in several
    object files of one program or in one.
    """

    name: str
    triple: str
    cpu: str
    features: str
    form: str


LIBRARY, APART, JOINED = "library", "apart", "joined"
# Libraries for these are shipped. The first takes the instructions that processors have since 2013 (Intel)
# or 2015 (AMD): code for the host's own is up to 4 % faster (transport_4x4), or no faster (feeder_one).
X86, ARM = "x86-64-v3", "aarch64"
SHIPPED = (
    Target(X86, "x86_64-unknown-linux-gnu", "x86-64-v3", "", LIBRARY),
    Target(ARM, "aarch64-unknown-linux-gnu", "generic", "", LIBRARY),
)
# Features of an x86-64-v3 processor, in Linux's words.
V3 = frozenset(("avx", "avx2", "bmi1", "bmi2", "cx16", "f16c", "fma", "abm", "movbe", "popcnt", "sse4_2"))
# How much of /proc/cpuinfo is read: its first processor takes some 1500 bytes.
FIRST = 8192


def shipped() -> str | None:
    """The name of the shipped target that this machine can run; None: there is none."""
    if sys.platform != "linux":
        return None
    if platform.machine() == "x86_64":
        return X86 if set(processor("flags").split()) >= V3 else None
    return ARM if platform.machine() == "aarch64" else None


def processor(what: str) -> str:
    """The entry of /proc/cpuinfo for the first processor under a name such as "flags"; empty elsewhere."""
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as stream:
            lines = stream.read(FIRST).splitlines()
    except OSError:
        return ""
    return next((line.partition(":")[2].strip() for line in lines if line.startswith(what)), "")


def host() -> Target:
    """This machine, with all that its processor has."""
    import llvmlite.binding as llvm

    # LLVM's older loader, which llvmlite has, mixes up the tables through which one object file finds what
    # is in another (GOT), and does without them on some machines only
    apart = sys.platform == "linux" and platform.machine() == "x86_64"
    features = llvm.get_host_cpu_features().flatten()
    form = APART if apart else JOINED
    return Target(
        llvm.get_host_cpu_name(), llvm.get_process_triple(), llvm.get_host_cpu_name(), features, form
    )


def units(target: Target, parts: Sequence[bytes]) -> list[bytes]:
    """Bitcode of the object files of a program on a target: its parts, or all of them in one. Raises
    RuntimeError."""
    if target.form != JOINED or len(parts) == 1:
        return list(parts)
    return [joined(parts)]


def joined(parts: Sequence[bytes]) -> bytes:
    """The bitcode of one module from that of its parts. Raises RuntimeError."""
    import llvmlite.binding as llvm

    whole = llvm.parse_bitcode(parts[0])
    for part in parts[1:]:
        whole.link_in(llvm.parse_bitcode(part))
    for function in whole.functions:
        if not function.is_declaration and function.name.startswith(INNER):
            function.linkage = "internal"
    return whole.as_bitcode()


def machine(target: Target) -> Any:
    """llvmlite's target machine."""
    import llvmlite.binding as llvm

    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    library = target.form == LIBRARY
    return llvm.Target.from_triple(target.triple).create_target_machine(
        cpu=target.cpu,
        features=target.features,
        opt=3,
        reloc="static" if target.form == APART else "pic",
        codemodel="small" if library else "jitdefault",
        jit=not library,
    )


def emit(machine: Any, bitcode: bytes) -> bytes:
    """Optimises bitcode for a target machine of llvmlite; an object file. Raises RuntimeError."""
    import llvmlite.binding as llvm

    module = llvm.parse_bitcode(bitcode)
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_vectorization, tuning.slp_vectorization = True, False
    tuning.inlining_threshold = SMALL
    builder = llvm.create_pass_builder(machine, tuning)
    builder.getModulePassManager().run(module, builder)
    return machine.emit_object(module)


if __name__ == "__main__":
    sys.stdout.buffer.write(emit(machine(Target(*sys.argv[1:])), sys.stdin.buffer.read()))
