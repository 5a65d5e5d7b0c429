"""Machine code of bitcode, for this machine; run as a script, of what it reads, in a process of its own.

llvmlite works for one thread of a process at a time, so the parts of a program are emitted by several. This
file imports nothing of mdlgen, which takes longer to import than llvmlite.
"""

from __future__ import annotations

import platform
import sys
from collections.abc import Sequence
from typing import Any

# Functions up to this size (in LLVM's own measure, whose default is 225) are opened where they are called;
# kernels say themselves which others are to be. More is twice the time to prepare, and no faster.
SMALL = 25
# What names of functions begin with that are called by none but those of the same program.
INNER = "kernel."


def apart() -> bool:
    """Whether several object files of one program are loaded here: LLVM's older loader, which llvmlite has,
    mixes up the tables through which one of them finds what is in another (GOT), and does without them on
    some machines only."""
    return sys.platform == "linux" and platform.machine() == "x86_64"


def units(parts: Sequence[bytes]) -> list[bytes]:
    """Bitcode of the object files of a program on this machine: its parts, or all of them in one. Raises
    RuntimeError."""
    if apart() or len(parts) == 1:
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


def host() -> Any:
    """llvmlite's target machine of this processor."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_triple(llvm.get_process_triple()).create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=3,
        reloc="static" if apart() else "pic",
        codemodel="jitdefault",
        jit=True,
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
    sys.stdout.buffer.write(emit(host(), sys.stdin.buffer.read()))
