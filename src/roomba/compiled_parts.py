"""Parts of compiled functions: made into machine code with the entries that call them, not before.

numba makes machine code of each function that a compiled one calls, with all that this one calls
in turn, though it is never run: the code that is run stands in the entry. So a part that is six
calls deep was optimised, and made into machine code, seven times. Here a part stops at what numba
hands on to the callers.

numba also compiles such a function once for each set of options that its callers are compiled
with. A part is compiled once for each kind of arguments.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import llvmlite.binding as llvm
from numba import njit, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.datamodel.models import OpaqueModel
from numba.core.typing.templates import infer_global
from numba.extending import register_model

_ENVIRONMENT: Final = "_ZN08NumbaEnv"
"""How names of the places begin where a function's objects of Python are found."""


class PartCompiler(Compiler):
    """Compiles a part: pass it to ``numba.njit`` as ``pipeline_class``."""

    def __init__(self, typing: Any, target: Any, library: Any, *rest: Any) -> None:
        """Take what numba hands over, with a library for parts."""
        kept = _PartLibrary(target.codegen(), "part") if library is None else library
        super().__init__(typing, target, kept, *rest)


class _PartLibrary(JITCodeLibrary):
    """Code of a part, to be linked into that of entries."""

    def _optimize_final_module(self) -> None:
        """Leave that to the entries, which know what is called with what."""

    def _finalize_final_module(self) -> None:
        """Make no machine code, but places for objects of Python, which numba fills in."""
        self._finalize_dynamic_globals()
        places = [
            str(each)
            for each in self._final_module.global_variables
            if each.name.startswith(_ENVIRONMENT)
        ]
        module = llvm.parse_assembly("\n".join(places))
        module.triple = self._final_module.triple
        module.data_layout = self._final_module.data_layout
        self._codegen._add_module(module)
        self._codegen._engine.finalize_object()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return 0: nothing here can be called."""
        self._ensure_finalized()
        return 0


class _PartType(types.Dispatcher):
    """The type of a part: it is compiled for any number, not for one that stands in the source."""

    def __init__(self, dispatcher: Any) -> None:
        """Keep what compiles it, to which numba's own type only points weakly."""
        self._kept = dispatcher
        super().__init__(dispatcher)

    def augment(self, other: Any) -> Any:
        """Return what counts of a function that is made a part once more: the newest."""
        return other

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Return the signature with types of arguments alone, not values."""
        any_kws = {name: types.unliteral(each) for name, each in dict(kws).items()}
        return super().get_call_type(
            context, tuple(types.unliteral(each) for each in args), any_kws
        )


register_model(_PartType)(OpaqueModel)


def register_part(function: Callable[..., Any], options: dict[str, Any]) -> None:
    """Let compiled functions call this one, compiled with options of ``numba.njit``."""
    options = {**options, "pipeline_class": PartCompiler, "no_cpython_wrapper": True}
    made = njit(**options)(function)
    infer_global(function, _PartType(made))
