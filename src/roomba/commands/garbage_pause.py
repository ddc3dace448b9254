"""Imports of a start: what they make is not looked through for garbage."""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Iterator


@contextlib.contextmanager
def nothing_thrown_away() -> Iterator[None]:
    """Look for no garbage meanwhile, and never look through what there is afterwards.

    Hundreds of thousands of objects of modules stay for good. To look through them again and again
    as they become more takes a tenth of a start.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if was_enabled:
            gc.enable()
