"""How numba compiles kernels: each one separately and once. Machine code is made only for calls from Python.

numba itself makes machine code of every function, with a copy of all functions that it calls, and optimises
each copy. A kernel that is ten calls below another one is then optimised ten times. Here a kernel that other
kernels call is a Piece: its own LLVM code, which calls other pieces by name. A kernel that Python calls is a
Whole: all pieces below it are linked and optimised once.

The cache keeps each piece separately. A piece contains no code of the kernels that it calls. So after a
change in a kernel numba compiles its piece again, and a caller's piece only where the kernel returns another
type.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from typing import Any, Literal, cast

import llvmlite.binding as llvm
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult, Flags
from numba.core.compiler_machinery import register_pass
from numba.core.environment import lookup_environment
from numba.core.funcdesc import default_mangler
from numba.core.targetconfig import ConfigStack
from numba.core.typed_passes import NativeLowering

# LLVM names of compiled functions begin with this,
COMPILED = "_ZN"
# and those of the environments that functions keep for Python.
ENVIRONMENT = "_ZN08NumbaEnv"
# Options that a kernel inherits from its first caller where it does not set them.
INHERITED = ("nrt", "fastmath", "error_model", "forceinline")


class Piece(JITCodeLibrary):
    """LLVM code of a kernel for some types, and the pieces that it calls. It has no machine code."""

    def __init__(self, codegen: Any, name: str, signature: tuple[tuple[Any, ...], Any], flags: Any):
        super().__init__(codegen, name)
        self.types, self.result = signature[0], str(signature[1])
        self.passed_on = {option: getattr(flags, option) for option in INHERITED}
        self.calls: list[Piece] = []

    def add_linking_library(self, library: Any) -> None:
        """Notes a piece that this one calls. A function of numba is linked into this piece."""
        if isinstance(library, Piece):
            self.calls.append(library)
        else:
            super().add_linking_library(library)

    def finalize(self) -> None:
        """Links and shortens the code. Nothing can be added after that."""
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        for thing in self._final_module.functions:
            # the names of numba's own functions have numbers that differ between processes: keep them inside
            if thing.linkage == llvm.Linkage.linkonce_odr and not thing.name.startswith("NRT_"):
                thing.linkage = "internal"
        _shorten(self._final_module, self._codegen._tm)
        self._final_module.verify()
        self._finalize_dynamic_globals()
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        # unchanged: LLVM drops a linkonce function if no function that is linked before it calls it
        return self._final_module

    def below(self) -> Iterator[Piece]:
        """This piece and all pieces below it, each once."""
        found: dict[Piece, None] = {}
        todo = [self]
        while todo:
            one = todo.pop()
            if one not in found:
                found[one] = None
                todo += one.calls
        return iter(found)


def _shorten(module: Any, target: Any) -> None:
    """Removes unused code, which is most of a module. It contains addresses of this process, so that numba
    would not cache the module."""
    manager = llvm.create_new_module_pass_manager()
    manager.add_sroa_pass()
    manager.add_instruction_combine_pass()
    manager.add_simplify_cfg_pass()
    manager.add_dead_code_elimination_pass()
    manager.add_global_dead_code_eliminate_pass()
    manager.run(module, llvm.create_pass_builder(target, llvm.create_pipeline_tuning_options()))


class Whole(JITCodeLibrary):
    """Machine code of a kernel that Python calls, with all pieces below it."""

    def __init__(self, codegen: Any, name: str):
        super().__init__(codegen, name)
        self.pieces: dict[Piece, None] = {}

    def add_linking_library(self, library: Any) -> None:
        """Adds a library; of a piece also all pieces below it."""
        for part in library.below() if isinstance(library, Piece) else (library,):
            if isinstance(part, Piece):
                self.pieces[part] = None
            super().add_linking_library(part)

    def _optimize_final_module(self) -> None:
        # LLVM may remove a piece after it has inlined all calls of it
        for piece in self.pieces:
            for one in piece.get_defined_functions():
                if one.linkage == llvm.Linkage.external:
                    self._final_module.get_function(one.name).linkage = "linkonce_odr"
        super()._optimize_final_module()

    def _verify_declare_only_symbols(self) -> None:
        super()._verify_declare_only_symbols()
        # LLVM gives no error for a missing function: the code would call address 0
        missing = [one.name for one in self._final_module.functions if one.is_declaration]
        missing = [name for name in missing if name.startswith(COMPILED)]
        assert not missing, f"{self.name} lacks {missing}"


@register_pass(mutates_CFG=True, analysis_only=False)
class _Lowered(NativeLowering):
    """Lowers a kernel to LLVM code, in a Piece, or to machine code, in a Whole."""

    _name = "mdlgen_lowered"

    def run_pass(self, state: Any) -> Literal[True]:
        pipeline, codegen, name = state.pipeline, state.targetctx.codegen(), state.pipeline.kernel
        state.flags.no_cfunc_wrapper = True
        if not pipeline.whole:
            state.flags.no_cpython_wrapper = True
            signature = tuple(state.args), state.return_type
            state.library = Piece(codegen, name, signature, state.flags)
            state.flags.no_compile = True
            super().run_pass(state)
            state.library._ensure_finalized()
            made = state["cr"]._replace(cfunc=_stand_in())
            state["cr"] = made
            state.targetctx.insert_user_function(made.cfunc, made.fndesc, [state.library])
            return True
        state.library = Whole(codegen, name)
        state.library.enable_object_caching()
        super().run_pass(state)
        for thing in state.library._final_module.global_variables:
            if thing.name.startswith(ENVIRONMENT) and (found := lookup_environment(thing.name)) is not None:
                codegen.set_env(thing.name, found)
        return True


def _stand_in() -> Any:
    """An object in place of machine code. It is a key for numba, which never calls it."""
    return [].append


class _Compiler(Compiler):
    """numba's compiler with the pass above. A function gets its name from the kernel and its types, so that
    the name is the same in each process."""

    kernel: str
    whole: bool

    def define_pipelines(self) -> Any:
        identity = self.state.func_id
        known = hashlib.sha256(f"{self.kernel}({', '.join(map(str, self.state.args))})".encode())
        identity.unique_id = known.hexdigest()[:16]
        identity.unique_name = f"{identity.func_qualname}${identity.unique_id}"
        self.state.targetctx = self.state.targetctx.subtarget(mangler=_mangled)
        managers = super().define_pipelines()
        for manager in managers:
            manager.passes = [
                (_Lowered, text) if each is NativeLowering else (each, text) for each, text in manager.passes
            ]
            manager.finalize()
        return managers


def _mangled(name: str, types: Any, *, abi_tags: Any = (), uid: Any = None) -> str:
    """The name with `uid`, without types and options. numba writes types as numbers that differ between
    processes, and a kernel inherits options from its first caller."""
    return default_mangler(name, (), uid=uid)


def compiler_of(kernel: str, whole: bool) -> Any:
    """numba's pipeline_class for the kernel of that name: a Whole, or a Piece."""
    return type("Compiler", (_Compiler,), {"kernel": kernel, "whole": whole})


class WholeCache(FunctionCache):
    """Keeps the machine code of a kernel. The name of its folder has the digest of its sources, so that the
    date of the file and the line of the kernel do not count."""

    def __init__(self, function: Callable[..., Any]):
        super().__init__(function)
        self._cache_file = IndexDataCacheFile(self._cache_path, function.__name__, source_stamp="")


class PieceCache(WholeCache):
    """Keeps the pieces of a kernel. `called` returns numba's dispatcher for the name of a kernel that they
    call, or None."""

    def __init__(self, function: Callable[..., Any], called: Callable[[str], Any]):
        self._impl_class = lambda function: _Kept(function, called)
        super().__init__(function)

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        """numba's key, and the options that the kernel inherits from its caller."""
        top = ConfigStack.top_or_none()
        inherited = [str(getattr(top, option)) for option in INHERITED] if top is not None else []
        return super()._index_key(sig, codegen), tuple(inherited)


class _Kept(CompileResultCacheImpl):
    def __init__(self, function: Callable[..., Any], called: Callable[[str], Any]):
        super().__init__(function)
        self._called = called

    def reduce(self, cres: Any) -> Any:
        """The parts of a piece that the cache keeps."""
        piece = cast("Piece", cres.library)
        calls = [(one.name, one.types, one.result) for one in piece.calls]
        code = piece._final_module.as_bitcode()
        cres.fndesc.typemap = cres.fndesc.calltypes = None
        known = cres.fndesc, cres.environment, cres.signature, cres.reload_init
        return piece.name, piece.passed_on, code, calls, *known

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """The piece with all pieces below it; None if a kernel that it calls now returns another type."""
        name, passed_on, code, calls, fndesc, environment, signature, reload_init = payload
        for again in reload_init:
            again()
        flags = Flags()
        for option, value in passed_on.items():
            setattr(flags, option, value)
        piece = Piece(target_context.codegen(), name, (signature.args, signature.return_type), flags)
        for one, types, result in calls:
            if (dispatcher := self._called(one)) is None:
                return None
            with ConfigStack().enter(flags):
                dispatcher.compile(types)
            piece.calls.append(dispatcher.overloads[types].library)
            if piece.calls[-1].result != result:
                return None
        piece._final_module = llvm.parse_bitcode(code)
        piece._finalize_dynamic_globals()
        piece._finalized = True
        return CompileResult(
            target_context=target_context,
            typing_context=target_context.typing_context,
            library=piece,
            environment=environment,
            entry_point=_stand_in(),
            fndesc=fndesc,
            type_annotation="",
            signature=signature,
            objectmode=False,
            lifted=(),
            typing_error=None,
            call_helper=None,
            metadata=None,
            reload_init=reload_init,
            referenced_envs=(),
        )
