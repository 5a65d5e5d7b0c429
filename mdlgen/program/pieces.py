"""How numba compiles kernels: each by itself once, and machine code only for those that Python calls.

numba makes machine code of every function, with a copy of all that it calls, and optimises each of these
copies: a kernel ten calls below another one is optimised ten times. Here a kernel that others call is a
Piece, LLVM's code of its own with the names of what it calls. What Python calls is a Whole: all pieces below
it are put together and optimised once.

Pieces are kept on disk one by one. A piece names what it calls, and has nothing else of that. So after a
change in a kernel only its own piece is compiled again, and those of its callers where it returns another
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

# LLVM's names of what numba compiles begin so,
COMPILED = "_ZN"
# and those of what a function keeps for Python.
ENVIRONMENT = "_ZN08NumbaEnv"
# Options that a kernel which does not set them has from the kernel that calls it first.
INHERITED = ("nrt", "fastmath", "error_model", "forceinline")


class Piece(JITCodeLibrary):
    """LLVM's code of a kernel for some types, and the pieces that it calls; no machine code."""

    def __init__(self, codegen: Any, name: str, signature: tuple[tuple[Any, ...], Any], flags: Any):
        super().__init__(codegen, name)
        self.types, self.result = signature[0], str(signature[1])
        self.passed_on = {option: getattr(flags, option) for option in INHERITED}
        self.calls: list[Piece] = []

    def add_linking_library(self, library: Any) -> None:
        """A piece stays where it is; what numba has of its own is put into this one."""
        if isinstance(library, Piece):
            self.calls.append(library)
        else:
            super().add_linking_library(library)

    def finalize(self) -> None:
        """After this nothing is added."""
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        for thing in self._final_module.functions:
            # numba numbers its own functions, and types, in each process anew: they stay in their piece
            if thing.linkage == llvm.Linkage.linkonce_odr and not thing.name.startswith("NRT_"):
                thing.linkage = "internal"
        _shorten(self._final_module, self._codegen._tm)
        self._final_module.verify()
        self._finalize_dynamic_globals()
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        # as it is: what LLVM may leave out is left out where nothing that is linked so far calls it
        return self._final_module

    def below(self) -> Iterator[Piece]:
        """This piece and all that it calls, each once."""
        found: dict[Piece, None] = {}
        todo = [self]
        while todo:
            one = todo.pop()
            if one not in found:
                found[one] = None
                todo += one.calls
        return iter(found)


def _shorten(module: Any, target: Any) -> None:
    """Removes what numba writes of a function and nothing reads, most of a module; it also holds addresses
    of this process, which no disk can keep."""
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
        """With what it calls."""
        for part in library.below() if isinstance(library, Piece) else (library,):
            if isinstance(part, Piece):
                self.pieces[part] = None
            super().add_linking_library(part)

    def _optimize_final_module(self) -> None:
        # a piece need not stay where it is put into all of its callers
        for piece in self.pieces:
            for one in piece.get_defined_functions():
                if one.linkage == llvm.Linkage.external:
                    self._final_module.get_function(one.name).linkage = "linkonce_odr"
        super()._optimize_final_module()

    def _verify_declare_only_symbols(self) -> None:
        super()._verify_declare_only_symbols()
        # LLVM would call address 0 without a word
        missing = [one.name for one in self._final_module.functions if one.is_declaration]
        missing = [name for name in missing if name.startswith(COMPILED)]
        assert not missing, f"{self.name} lacks {missing}"


@register_pass(mutates_CFG=True, analysis_only=False)
class _Lowered(NativeLowering):
    """To LLVM's code, in a Piece; or to machine code."""

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
    """What numba knows a piece by, where it has the address of machine code otherwise: never called."""
    return [].append


class _Compiler(Compiler):
    """numba's, with the pass above. It names a function by the kernel and its types, so that it has the same
    name in each process."""

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
    """A name with `uid` in place of types, which numba knows by numbers that differ in each process, and
    without options, some of which a kernel has from the one that calls it first."""
    return default_mangler(name, (), uid=uid)


def compiler_of(kernel: str, whole: bool) -> Any:
    """numba's pipeline_class for the kernel of that name: a Whole, or a Piece."""
    return type("Compiler", (_Compiler,), {"kernel": kernel, "whole": whole})


class WholeCache(FunctionCache):
    """Keeps machine code of a kernel in a folder for exactly what that is compiled from; where it stands in
    which version of a file says no more."""

    def __init__(self, function: Callable[..., Any]):
        super().__init__(function)
        self._cache_file = IndexDataCacheFile(self._cache_path, function.__name__, source_stamp="")


class PieceCache(WholeCache):
    """Keeps the pieces of a kernel; `called` finds numba's dispatcher of what they call by its name, or
    None."""

    def __init__(self, function: Callable[..., Any], called: Callable[[str], Any]):
        self._impl_class = lambda function: _Kept(function, called)
        super().__init__(function)

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        """With the options that it inherits here."""
        top = ConfigStack.top_or_none()
        inherited = [str(getattr(top, option)) for option in INHERITED] if top is not None else []
        return super()._index_key(sig, codegen), tuple(inherited)


class _Kept(CompileResultCacheImpl):
    def __init__(self, function: Callable[..., Any], called: Callable[[str], Any]):
        super().__init__(function)
        self._called = called

    def reduce(self, cres: Any) -> Any:
        """A piece for the disk."""
        piece = cast("Piece", cres.library)
        calls = [(one.name, one.types, one.result) for one in piece.calls]
        code = piece._final_module.as_bitcode()
        cres.fndesc.typemap = cres.fndesc.calltypes = None
        known = cres.fndesc, cres.environment, cres.signature, cres.reload_init
        return piece.name, piece.passed_on, code, calls, *known

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """The piece, with all that it calls; None where one of these returns another type than it did."""
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
