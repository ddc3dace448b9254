"""The latency of scans against odometry, learned from the turns that both measure.

Many drivers stamp a scan when it has come and not when it was taken. Several latencies are
compared: the one with which dead reckoning best predicts how far matched scans turned is believed.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.compilation import entry, inner_part
from roomba.perception.calibration.state import Row
from roomba.perception.matching.reckoned_path import ReckonedPath, is_told_within, pose_at

Rows = NDArray[np.void]

_STEP: Final = 0.05
_COUNT: Final = 9
"""The latencies that are compared, from 0 on: their distance, s, and their number."""
_SELDOM: Final = 0.25
"""s; odometry that comes less often than this is too coarse to tell such latencies apart."""
_KEPT: Final = 0.99
"""Share of what was learned that counts after another scan: about the last hundred do."""
_LEAST_TURNED: Final = 0.1
"""rad2; sum of squared turns from which anything is said."""
_BETTER: Final = 0.7
"""Another latency is believed if its squared errors are below this share of the present one's: with
each change the robot seems to move a little."""


LATENCY: Final = np.dtype(
    [
        ("seconds", "f8"),  # the latency to go by
        ("errors", "f8", (_COUNT,)),  # rad2; sum of squared errors of each latency
        ("turned", "f8"),  # rad2; sum of squared turns
        ("before", "f8", (_COUNT,)),  # rad; reckoned headings at the scan before; nan: not known
        ("now", "f8", (_COUNT,)),
        ("pose", "f8", (3,)),  # what the kernel works in; means nothing between two calls
    ],
    align=True,
)
"""What was learned, one row."""


def no_latency() -> Rows:
    """Return a latency of 0, LATENCY [1], with nothing learned yet."""
    latency = np.zeros(1, LATENCY)
    latency["before"] = np.nan
    return latency


@entry
def learn_latency(latencies: Rows, turn: float, stamp: float, path: ReckonedPath) -> None:
    """Learn from the ``turn`` of a scan against the scan before it, rad, nan if not known.

    ``stamp``, s, is the scan's; ``path`` tells where dead reckoning had the robot.
    """
    latency = latencies[0]
    is_known = not math.isnan(turn) and is_told_within(path, _SELDOM)
    for index in range(_COUNT):
        heading = math.nan
        if pose_at(path, stamp - index * _STEP, latency.pose):
            heading = latency.pose[2]
        latency.now[index] = heading
        is_known = is_known and not math.isnan(heading + latency.before[index])
    if is_known:
        _add_errors(latency, turn)
    for index in range(_COUNT):
        latency.before[index] = latency.now[index]


@inner_part
def _add_errors(latency: Row, turn: float) -> None:
    """Compare a turn with the one reckoned for each latency, and choose the latency to go by."""
    best = 0
    for index in range(_COUNT):
        off = wrapped(latency.now[index] - latency.before[index]) - turn
        latency.errors[index] = _KEPT * latency.errors[index] + off * off
        if latency.errors[index] < latency.errors[best]:
            best = index
    latency.turned = _KEPT * latency.turned + turn * turn
    if latency.turned > _LEAST_TURNED:
        present = round(latency.seconds / _STEP)
        if latency.errors[best] < _BETTER * latency.errors[present]:
            latency.seconds = best * _STEP
