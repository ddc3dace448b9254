"""The error of a message that is refused."""

from __future__ import annotations

import math

from roomba.errors import RoombaError


class MessageError(RoombaError, ValueError):
    """A message that cannot be used: it says what was expected, and what came.

    Its numbers are not finite, an array is empty or of a wrong size, or a code means nothing.
    """


def require_finite(what: str, *numbers: float) -> None:
    """Raise MessageError if one of the numbers of ``what`` is not finite."""
    if not all(map(math.isfinite, numbers)):
        told = ", ".join(f"{number:g}" for number in numbers)
        raise MessageError(f"expected {what} of finite numbers, got ({told})")
