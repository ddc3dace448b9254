"""How far off a surface points may lie, by the noise of the lidar's ranges."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry

_LAST_SCALE: Final = 0.03
_SCALE_IN_DEVIATIONS: Final = 3.0
"""m, and in standard deviations of a range: scale of a match's last rounds, the larger of both."""
_IN_PLANE: Final = 0.03
_IN_PLANE_IN_DEVIATIONS: Final = 3.0
_MAP_ERROR: Final = 0.01
"""m; a point less than this off a plane lies in it: the larger of the first number, and the second
times the standard deviation of a range plus the third, the map's own error."""


class Tolerances(NamedTuple):
    """Tolerances of a match.

    ``scales``, float64 [n], m, are those of the first rounds, the last one also that of the rest;
    ``variance``, m2, is that of a point; a point less than ``close``, m, off a plane lies in it.
    """

    scales: NDArray[np.float64]
    variance: float
    close: float


@entry
def last_scale(deviation: float) -> float:
    """Return the scale of a match's last rounds, m, for ranges of a standard deviation, m."""
    return max(_LAST_SCALE, _SCALE_IN_DEVIATIONS * deviation)


@entry
def in_plane(deviation: float) -> float:
    """Return how far off a plane, m, a point still lies in it, by the deviation of a range, m."""
    return max(_IN_PLANE, _IN_PLANE_IN_DEVIATIONS * deviation + _MAP_ERROR)


def tolerances_of(
    first_scales: tuple[float, ...], range_deviation: float, point_deviation: float
) -> Tolerances:
    """Return the tolerances of a match that begins with ``first_scales``, m; deviations in m."""
    scales = np.array([*first_scales, last_scale(range_deviation)])
    return Tolerances(scales, point_deviation**2, in_plane(range_deviation))
