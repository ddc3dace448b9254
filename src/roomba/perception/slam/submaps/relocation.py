"""Finding a robot on its own growing map after it was carried: over all of the map, at any heading.

One scan may fit in several places. The place must fit clearly better than all others, and a second
scan, taken elsewhere, must be found where the first one and dead reckoning say.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.slam.following.follow_kernels import LEAST_POINTS
from roomba.perception.slam.scan_matching.correlative import CorrelativeMatcher, is_in_reach
from roomba.perception.slam.submaps.pose_graph import composed, relative_to
from roomba.perception.slam.submaps.submap import Submap

Floats = NDArray[np.float64]

_WINDOW: Final = 3.0
"""m; so far around a submap's beginning it is looked for."""
_LIKELIHOOD: Final = 0.85
"""Mean likelihood of points, 0..1, that a place must have."""
_CLEARLY: Final = 0.85
"""Share of the best one's likelihood that other places may have."""
_ELSEWHERE: Final = 0.5
_TURNED: Final = 0.3
"""m, rad; poses that are farther apart are of two places."""
_MOVED: Final = 0.25
_LOOKED: Final = 0.5
"""m, rad; what is driven or turned between two scans that are searched for."""
_SAME: Final = 0.2
_SAME_HEADING: Final = 0.1
"""m, rad; two scans agree that were found so near to where they lie to each other."""


class MapRelocation:
    """Keeps whether the robot is carried, and where the scan before was found.

    ``is_lifted`` while its wheels hang in the air, ``is_lost`` from then on until it is placed.
    """

    def __init__(self) -> None:
        """Begin on the floor, where the map begins."""
        self.is_lifted = self.is_lost = False
        self._searched_at: Floats | None = None
        self._found: Floats | None = None

    @property
    def is_placed(self) -> bool:
        """Whether the robot's place on the map is known from where it came along."""
        return not (self.is_lifted or self.is_lost)

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air; what was found before it is set down is old."""
        if self.is_lifted and not is_lifted:
            self.is_lost = True
            self._searched_at = self._found = None
        self.is_lifted = is_lifted

    def find(
        self, points: Floats, reckoned: Floats, submaps: list[Submap], poses: Floats
    ) -> Floats | None:
        """Return where the robot is, [3], map frame, or None as long as that is not sure.

        ``points`` [n, 4] are those of a scan, ``reckoned`` [3] its pose by dead reckoning,
        ``poses`` [m, 3] those of the submaps.
        """
        if len(points) < LEAST_POINTS:
            return None
        before, earlier = self._searched_at, self._found
        if before is not None and not is_apart(reckoned, before, _MOVED, _LOOKED):
            return None
        self._searched_at = reckoned.copy()
        self._found = found = _clearly_best(points, submaps, poses)
        if found is None or earlier is None or before is None:
            return None
        expected = composed(earlier[None], relative_to(before[None], reckoned[None]))[0]
        return found if not _differ(found, expected, _SAME, _SAME_HEADING) else None


def _clearly_best(points: Floats, submaps: list[Submap], poses: Floats) -> Floats | None:
    """Return the pose on the map that fits clearly better than all others, [3], or None."""
    places, scores = [], []
    for submap, pose in zip(submaps, poses, strict=True):
        if not len(submap.cloud) or not is_in_reach(submap.cloud):
            continue
        matcher = CorrelativeMatcher(submap.cloud)
        found = matcher.best(points, np.zeros(3), _WINDOW, math.pi, _LIKELIHOOD)
        if found is not None:
            places.append(composed(pose[None], found.pose[None])[0])
            scores.append(found.score)
    if not places:
        return None
    best = int(np.argmax(scores))
    others = [
        score
        for place, score in zip(places, scores, strict=True)
        if _differ(place, places[best], _ELSEWHERE, _TURNED)
    ]
    if max(others, default=0.0) > _CLEARLY * scores[best]:
        return None
    result: Floats = places[best]
    return result


def _differ(pose: Floats, other: Floats, way: float, turn: float) -> bool:
    away = math.hypot(pose[0] - other[0], pose[1] - other[1])
    return away > way or abs(wrapped(pose[2] - other[2])) > turn
