"""The C library's heap: what is free in it goes back to the system."""

from __future__ import annotations

import ctypes
from typing import Final

_TRIM_THRESHOLD: Final = -1
_MMAP_THRESHOLD: Final = -3
"""The parameters of glibc's mallopt, by their numbers in malloc.h."""
_LARGE: Final = 128 * 1024
"""bytes; glibc's own thresholds at the start of a process."""


def keep_large_blocks_apart() -> None:
    """Have the C library take blocks of 128 KiB and more from the system, each by itself, for good.

    By itself it does so at first, and raises the threshold to the size of each such block that is
    freed, up to 32 MiB: pictures, scans and maps then lie in the heap among small objects that
    stay, and the heap grows. C libraries other than glibc have no such threshold.
    """
    set_option = getattr(ctypes.CDLL(None), "mallopt", None)
    if set_option is not None:
        set_option(_MMAP_THRESHOLD, _LARGE)
        set_option(_TRIM_THRESHOLD, _LARGE)


def give_back() -> None:
    """Give free pages of the heap back to the system, wherever they lie.

    By itself the C library gives back those at the heap's end alone, and a small object that
    stays there keeps all below it. It takes some milliseconds. C libraries other than glibc have
    no such function: there it does nothing.
    """
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
