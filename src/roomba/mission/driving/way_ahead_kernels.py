"""How far a path is clear before the robot, in compiled code."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import entry
from roomba.perception.things.kernels import first_blocked
from roomba.perception.things.state import Things

_HORIZON: Final = 2.0
"""m; so far ahead a path is looked at."""

AHEAD: Final = np.dtype(
    [
        ("checked", "i8"),  # version of what stands about at the last look; -1 before the first
        ("clear_to", "f8"),  # m along the path; so far nothing that is known is in the way
        ("blocked_at", "f8"),  # m along the path, where the first thing stands; nan: none
        # what does not change
        ("look_ahead", "f8"),  # m; the path is clear until so far before the first thing
        ("leaves_until", "f8"),  # m along the path; before it no thing counts
        ("keep", "f8"),  # m; so near to the path a thing is in the way
    ]
)
"""What is known of the way ahead, one row."""


@entry
def is_blocked(
    rows: NDArray[np.void],
    things: Things,
    points: Floats,
    stations: Floats,
    version: int,
    along: float,
) -> bool:
    """Tell whether a path is not clear any more for a robot that is ``along``, m.

    The path is looked at again when ``version`` is not that of the last look, or the robot has come
    as far as the path was clear. ``points`` [n, 2] and ``stations`` [n], m, are the path's.
    """
    ahead = rows[0]
    if ahead.checked != version or along >= ahead.clear_to:
        ahead.checked = version
        # What the path was just planned to leave is not in the way.
        first, last = max(along, ahead.leaves_until), along + _HORIZON
        at = first_blocked(things, points, stations, first, last, ahead.keep)
        # A path that begins beside a thing is the way out of there: station 0 does not count.
        ahead.blocked_at = math.nan if at == 0.0 else at
        clear = last if math.isnan(ahead.blocked_at) else ahead.blocked_at
        ahead.clear_to = clear - ahead.look_ahead
    return bool(along >= ahead.clear_to)
