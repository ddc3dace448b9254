"""How the engine is compiled: one entry, and its parts, which become one piece of machine code."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, TypeVar

from numba import njit
from numba.extending import register_jitable

_Function = TypeVar("_Function", bound=Callable[..., Any])

_OPTIONS: Final[dict[str, Any]] = {
    "error_model": "numpy",
    # No runtime for references: numba refuses code that allocates, and counts no references.
    "_nrt": False,
}
_FAST: Final = {"nsz", "arcp", "contract", "afn", "reassoc"}
"""Fast math, but for infinities: a beam that meets nothing has one."""


def entry(function: _Function) -> _Function:
    """Compile a function that is called from Python; it lets other threads run meanwhile."""
    compiled: _Function = njit(cache=True, nogil=True, **_OPTIONS)(function)
    return compiled


def part(function: _Function) -> _Function:
    """Make a function that compiled ones can call; called from Python it is plain Python.

    As a part it is compiled with its callers and not also by itself, which halves the time.
    """
    registered: _Function = register_jitable(**_OPTIONS)(function)
    return registered


def scan_part(function: _Function) -> _Function:
    """Make a part of loops over beams and edges, whose sums may be taken in any order."""
    registered: _Function = register_jitable(fastmath=_FAST, **_OPTIONS)(function)
    return registered
