"""How hot loops are compiled: entries, which Python calls, and their parts, in one piece of code.

A part is compiled with each entry that uses it and not by itself: called from Python it is plain
Python, which is slow. Whether a function may allocate is part of how it is compiled. One that may
not has no runtime for references: numba refuses code that allocates, and counts no references to
the arrays that it is given, which takes most of the time of small functions. It must not be given
a new array by a function that it calls either: nothing would free that.

An entry that is called in compiled code with a number that stands there is compiled for that number
alone, once more: ``int(NUMBER)`` is any number.

Division by zero is not looked for: it gives what the processor makes of it.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final, TypeVar

from numba import config, njit
from numba.core.caching import IndexDataCacheFile
from numba.extending import register_jitable

from roomba.compiled_sources import PACKAGE, Sources

_Function = TypeVar("_Function", bound=Callable[..., Any])

_ALWAYS: Final[dict[str, Any]] = {"error_model": "numpy", "no_cfunc_wrapper": True}
"""None is called by its address, from C: what would make that possible is not compiled."""
_ALLOCATES: Final[dict[str, Any]] = {**_ALWAYS, "_nrt": True}
_ALLOCATES_NOT: Final[dict[str, Any]] = {**_ALWAYS, "_nrt": False}
_ANY_ORDER: Final = {"nsz", "arcp", "contract", "reassoc"}
"""Fast math, but for what is not finite: a beam that meets nothing is infinite."""
_NUMBA: Final[Any] = config
_KNOWN: Final = "sources.json"
"""File in numba's folder: what is known of sources, by their path, until they change."""
_BLAS: Final = "scipy.linalg.cython_blas"


def _read_arrays_without_blas() -> None:
    """Let numba read what it knows of arrays, and find no BLAS meanwhile.

    It only asks whether there is one, for ``np.correlate``, and imports all of scipy's linear
    algebra to know: 0.13 s of each start. What multiplies matrices looks for it later by itself.
    """
    if _BLAS in sys.modules:
        return
    sys.modules[_BLAS] = None  # type: ignore[assignment]  # Python then says that there is none
    try:
        with contextlib.suppress(ImportError):
            importlib.import_module("numba.np.arraymath")
    finally:
        del sys.modules[_BLAS]


_read_arrays_without_blas()


def _keep_code_one_at_a_time() -> None:
    """Let processes that compile at once keep what they compiled one after the other.

    numba reads the index of a function, takes a free number in it, and writes index and code: of
    two that do so at once one entry is lost, or leads to the code of the other.
    """
    kept: Any = IndexDataCacheFile
    save = kept.save

    @functools.wraps(save)
    def save_alone(self: Any, key: Any, data: Any) -> None:
        with open(__file__, "rb") as lock:  # any file that all of them have
            with contextlib.suppress(ImportError, OSError):  # Windows and some disks have no locks
                import fcntl

                fcntl.flock(lock, fcntl.LOCK_EX)
            save(self, key, data)

    kept.save = save_alone


_keep_code_one_at_a_time()


def entry(function: _Function) -> _Function:
    """Compile a function that allocates nothing; other threads run meanwhile."""
    return _called_from_python(function, _ALLOCATES_NOT)


def allocating_entry(function: _Function) -> _Function:
    """Compile a function that may allocate; other threads run meanwhile."""
    return _called_from_python(function, _ALLOCATES)


def any_order_entry(function: _Function) -> _Function:
    """Compile a function, which may allocate, whose sums may be taken in any order."""
    return _called_from_python(function, {**_ALLOCATES, "fastmath": _ANY_ORDER})


def part(function: _Function) -> _Function:
    """Make a part that allocates nothing."""
    return _part(function, _ALLOCATES_NOT)


def inner_part(function: _Function) -> _Function:
    """Make a part, which allocates nothing, whose code stands in that of its callers.

    An array is handed over as seven arguments and more, so that a call with many of them costs more
    than a little work. It is for parts that are called in one or two places.
    """
    return _part(function, {**_ALLOCATES_NOT, "forceinline": True})


def allocating_part(function: _Function) -> _Function:
    """Make a part that may allocate."""
    return _part(function, _ALLOCATES)


def inlined_entry(function: _Function) -> _Function:
    """Compile a function that allocates nothing, whose body stands in its compiled callers."""
    return _called_from_python(function, {**_ALLOCATES_NOT, "inline": "always"})


def any_order_part(function: _Function) -> _Function:
    """Make a part of loops over beams and edges, whose sums may be taken in any order."""
    return _part(function, {**_ALLOCATES_NOT, "fastmath": _ANY_ORDER | {"afn"}})


def _called_from_python(function: _Function, options: dict[str, Any]) -> _Function:
    made: _Function = compiled(cache=True, nogil=True, **options)(function)
    return made


def compiled(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles with options of ``numba.njit``."""

    def compile_it(function: Callable[..., Any]) -> Any:
        with kept_by_sources(Path(function.__code__.co_filename)):
            return njit(**options)(function)

    return compile_it


@contextlib.contextmanager
def kept_by_sources(file: Path) -> Iterator[None]:
    """Let numba keep what is compiled meanwhile of a file in the folder for its sources.

    Without a folder that numba was told, and for what stands in no file, it keeps that where it
    likes. A file of another folder, such as a stage of planning of a user's own, counts with the
    parts of this package that it imports.
    """
    before = _NUMBA.CACHE_DIR
    if not before or not file.is_file():
        yield
        return
    sources = _sources(before)
    within = file.relative_to(PACKAGE) if PACKAGE in file.parents else Path("other", file.name)
    name = ".".join(within.with_suffix("").parts)
    _NUMBA.CACHE_DIR = os.path.join(before, f"{name}-{sources.key(file)}")
    sources.remember()
    try:
        yield
    finally:
        _NUMBA.CACHE_DIR = before


@functools.cache
def _sources(folder: str) -> Sources:
    return Sources(PACKAGE, Path(folder) / _KNOWN)


def _part(function: _Function, options: dict[str, Any]) -> _Function:
    registered: _Function = register_jitable(**options)(function)
    return registered
