"""Moments that are kept, in a range in which days before and after can be reckoned as well."""

from __future__ import annotations

import datetime as dt
from typing import Annotated, Final

from pydantic import AwareDatetime, Field

_UTC: Final = dt.timezone.utc

Moment = Annotated[
    AwareDatetime,
    Field(ge=dt.datetime(1970, 1, 1, tzinfo=_UTC), lt=dt.datetime(9000, 1, 1, tzinfo=_UTC)),
]
"""A moment of the wall clock, from 1970 on, which a clock that was never set tells."""
_BEGAN: Final = dt.datetime(2026, 1, 1, tzinfo=_UTC)
"""Before this program there were no plans of it."""


def is_set(now: dt.datetime) -> bool:
    """Whether a clock that tells this can have been set.

    A computer whose clock has no battery begins in 1970, or on a day of its maker's, and has the
    right time once it reaches the network.
    """
    return now >= _BEGAN
