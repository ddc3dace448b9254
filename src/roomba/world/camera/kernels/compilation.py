"""How the camera's kernels are compiled."""

from __future__ import annotations

from typing import Any, Final

KERNEL: Final[dict[str, Any]] = {
    "cache": True,
    "nogil": True,
    "error_model": "numpy",
    # No reference counting: numba refuses code that allocates, and counts no references
    # to arrays that are passed on, which took a third of the time.
    "_nrt": False,
    # Not all of fast math: infinity is the depth of what is not there.
    "fastmath": {"arcp", "contract", "nsz"},
}
"""Options of ``numba.njit``: ``@compiled(**KERNEL)``."""

INNER: Final[dict[str, Any]] = {**KERNEL, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""For a kernel that only other kernels call.

The wrapper that takes a scene's arrays over from Python takes longer to compile than most kernels.
"""

INLINE: Final[dict[str, Any]] = {**INNER, "forceinline": True}
"""For an inner kernel that is called in one or two places, but often.

Each array is passed as seven arguments, so a call with a scene costs more than the kernel's work.
"""
