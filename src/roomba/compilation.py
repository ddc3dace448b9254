"""How hot loops are compiled: entries, which Python calls, and their parts, in one piece of code.

A part is compiled into each entry that uses it, never by itself: called from Python, a part runs as
plain Python, which is slow. Each decorator says whether its function may allocate memory. If it may
not, numba compiles it without reference counting: numba then refuses code that allocates, and saves
the counting of references to array arguments, which takes most of the time of small functions. Such
a function must not call one that returns a new array either: nothing would free that array.

An entry that compiled code calls with a literal number is compiled once more, for that number
alone. Pass ``int(NUMBER)`` instead: it counts as any number.

Division by zero raises nothing: the result is what the processor gives.
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
"""No C code calls these functions by their address, so numba compiles no C wrapper for them."""
_ALLOCATES: Final[dict[str, Any]] = {**_ALWAYS, "_nrt": True}
_ALLOCATES_NOT: Final[dict[str, Any]] = {**_ALWAYS, "_nrt": False}
_ANY_ORDER: Final = {"nsz", "arcp", "contract", "reassoc"}
"""Fast math that keeps infinities right: the range of a beam that meets nothing is infinite."""
_NUMBA: Final[Any] = config
_KNOWN: Final = "sources.json"
"""File in numba's folder that remembers the state of each source file until it changes."""
_BLAS: Final = "scipy.linalg.cython_blas"


def _read_arrays_without_blas() -> None:
    """Import numba's support of arrays, and hide BLAS from numba meanwhile.

    numba only asks whether there is a BLAS, for ``np.correlate``, but imports all of scipy's linear
    algebra to find out: 0.13 s of each start. Code that multiplies matrices looks for BLAS later.
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
    """Make processes that compile at the same time write into numba's cache one by one.

    To cache a function, numba reads its index, takes a free number from it, and writes index and
    code. If two processes do so at once, one entry is lost or points to the code of the other.
    """
    kept: Any = IndexDataCacheFile
    save = kept.save

    @functools.wraps(save)
    def save_alone(self: Any, key: Any, data: Any) -> None:
        with open(__file__, "rb") as lock:  # any file that all processes have
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
    """Compile a function that may allocate and whose sums may be taken in any order."""
    return _called_from_python(function, {**_ALLOCATES, "fastmath": _ANY_ORDER})


def part(function: _Function) -> _Function:
    """Make a part that allocates nothing."""
    return _part(function, _ALLOCATES_NOT)


def inner_part(function: _Function) -> _Function:
    """Make a part that allocates nothing and is inlined into its callers.

    Each array is passed as seven arguments or more, so a call with many arrays can cost more than
    the work of a short part. Use it for parts that are called in one or two places.
    """
    return _part(function, {**_ALLOCATES_NOT, "forceinline": True})


def allocating_part(function: _Function) -> _Function:
    """Make a part that may allocate."""
    return _part(function, _ALLOCATES)


def inlined_entry(function: _Function) -> _Function:
    """Compile a function that allocates nothing and is inlined into its compiled callers."""
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
    """Let numba cache what is compiled meanwhile from ``file`` in the folder of the file's sources.

    If numba was told no cache folder, or the code stands in no file, numba chooses the place. The
    sources of a file outside this package, such as a user's own planning stage, are this file and
    the modules of this package that it imports.
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
