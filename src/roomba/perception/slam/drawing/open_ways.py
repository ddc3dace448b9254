"""Ways near the lidar that are open, as beams without an echo show.

A run of beams brings no echo if the surfaces ahead are too far, black, or met at too flat an angle.
Farther off that tells nothing. But the run lies between two beams that met something. Nearer than
these met it, as a rule nothing stands there, at least where the lidar sees black things as well.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry, inner_part
from roomba.perception.matching.beams import LidarBeams

Ranges = NDArray[np.float32]


def open_ways(
    ranges: Ranges, beams: LidarBeams, farthest: float, margin: float
) -> NDArray[np.float32]:
    """Return where the open ways of a scan, float32 [beams], m, end: float32 [n, 2], robot's frame.

    Each way leads from the lidar along a beam without an echo. It is ``farthest`` m long, but ends
    ``margin`` m before the nearer range of the two beams beside the run that met something.
    """
    ends = np.empty((len(ranges), 2), np.float32)
    return ends[: _find(ranges, beams, farthest, margin, ends)].copy()


@entry
def _find(
    ranges: Ranges, beams: LidarBeams, farthest: float, margin: float, ends: NDArray[np.float32]
) -> int:
    """Fill ``ends`` [beams, 2]; return how many there are."""
    count, first = ranges.size, -1
    for index in range(count):
        if _has_met(ranges[index], beams):
            first = index
            break
    if first < 0:
        return 0
    cosine, sine = math.cos(beams.mount[2]), math.sin(beams.mount[2])
    found, last, step = 0, first, 1
    while step <= count:
        index = (first + step) % count
        step += 1
        if not _has_met(ranges[index], beams):
            continue
        # If the lidar does not look all around, the first and the last beam count as neighbours.
        length = min(farthest, min(ranges[last], ranges[index]) - margin)
        between = (last + 1) % count
        while between != index:
            if length > 0.0 and not _is_near(ranges[between], beams):
                along, across = beams.directions[between]
                ends[found, 0] = beams.mount[0] + length * (cosine * along - sine * across)
                ends[found, 1] = beams.mount[1] + length * (sine * along + cosine * across)
                found += 1
            between = (between + 1) % count
        last = index
    return found


@inner_part
def _has_met(length: float, beams: LidarBeams) -> bool:
    return beams.nearest <= length < beams.farthest


@inner_part
def _is_near(length: float, beams: LidarBeams) -> bool:
    """Whether a beam met something nearer than the lidar measures, so that its way is not open."""
    is_near: bool = length < beams.nearest and length != 0.0
    return is_near
