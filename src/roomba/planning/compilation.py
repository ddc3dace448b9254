"""How the inner loops of coverage planning are compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, TypeVar

from numba import njit

_Function = TypeVar("_Function", bound=Callable[..., Any])

_OPTIONS: Final[dict[str, Any]] = {"cache": True, "nogil": True, "_nrt": False}


def part(function: _Function) -> _Function:
    """Compile a function that allocates nothing.

    It has no runtime for references: numba refuses code that allocates, and counts no
    references to the arrays that it is given, which takes most of the time of small functions.
    """
    compiled: _Function = njit(**_OPTIONS)(function)
    return compiled
