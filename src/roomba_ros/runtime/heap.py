"""Returns free memory of the C library's heap to the operating system."""

from __future__ import annotations

import ctypes


def give_back() -> None:
    """Give free pages of the heap back to the system, wherever they lie.

    By itself the C library gives back those at the heap's end alone, and a small object that
    stays there keeps all below it. It takes some milliseconds. C libraries other than glibc have
    no such function: there it does nothing.
    """
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
