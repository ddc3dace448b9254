"""How the camera's kernels are compiled."""

from __future__ import annotations

from typing import Any, Final

KERNEL: Final[dict[str, Any]] = {
    "cache": True,
    "nogil": True,
    "error_model": "numpy",
    # No runtime for references: numba refuses code that allocates, and counts no references
    # to arrays that are passed on, which took a third of the time.
    "_nrt": False,
    # Not all of it: infinities are depths of what is not there.
    "fastmath": {"arcp", "contract", "nsz"},
}
"""Options of ``numba.njit``: ``@compiled(**KERNEL)``."""

INNER: Final[dict[str, Any]] = {**KERNEL, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""For a kernel that only other kernels call.

What would take a scene's arrays over from Python takes longer to compile than most kernels.
"""

INLINE: Final[dict[str, Any]] = {**INNER, "forceinline": True}
"""For an inner kernel that is called in one or two places, but often.

An array is handed over as seven arguments, so that a call with a scene costs more than its work.
"""
