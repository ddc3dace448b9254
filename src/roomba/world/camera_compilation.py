"""How the camera's kernels are compiled."""

from __future__ import annotations

from typing import Any, Final

KERNEL: Final[dict[str, Any]] = {
    "cache": True,
    "nogil": True,
    "error_model": "numpy",
    # No runtime for references: numba refuses whatever would allocate, and counts no references
    # to arrays that are passed on, which took a third of the time.
    "_nrt": False,
}
"""Options of ``numba.njit``: ``@njit(**KERNEL)``."""
