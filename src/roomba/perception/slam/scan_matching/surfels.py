"""A grid of surfels around a place: what scans are matched to while a map is made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.perception.slam.scan_matching.surfel_kernels import (
    ALIGN_WORK,
    ASKED,
    CLOSE,
    COUNTS,
    FACINGS,
    MATCHED,
    SUMS,
    Surfels,
    add_points,
    align,
    clear,
)
from roomba.perception.slam.scan_matching.tolerances import Tolerances

CELL: Final = 0.1
"""m; the size of a surfel."""
_MOST_TOUCHED: Final = 40_000


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """Where points fit: ``pose``, its ``covariance``, and the ``information`` of the points alone.

    ``asked`` is the number of points with a normal, ``met`` the share of them that met a surfel,
    ``close`` the share of those that lie in its plane.
    """

    pose: Floats
    covariance: Floats
    information: Floats
    asked: int
    met: float
    close: float


class SurfelGrid:
    """Surfels in a square of ``half_width``, m, to each side of its frame's origin.

    ``arrays`` is what kernels work on.
    """

    def __init__(self, half_width: float) -> None:
        """Begin empty."""
        cells = 2 * int(np.ceil(half_width / CELL))
        corner = -0.5 * cells * CELL
        self.arrays = Surfels(
            np.zeros((cells, cells, FACINGS, SUMS), np.float32),
            np.array([corner, corner, CELL]),
            np.zeros(_MOST_TOUCHED, np.int32),
            np.zeros(1, np.int64),
        )
        self._work = np.empty((ALIGN_WORK, 3))

    def clear(self) -> None:
        """Forget all surfels."""
        clear(self.arrays)

    def add(self, points: Floats, pose: Floats) -> None:
        """Add points, float64 [n, 4], seen from a pose [3] in the grid's frame."""
        add_points(self.arrays, points, len(points), pose)

    def match(
        self,
        points: Floats,
        prior: Floats,
        covariance: Floats,
        tolerances: Tolerances,
        *,
        rounds: int,
        reach: int = 1,
        stride: int = 1,
    ) -> Match | None:
        """Return where ``points`` [n, 4] fit best near ``prior`` [3], unsure by ``covariance``.

        ``prior`` and ``covariance`` [3, 3] are in the grid's frame, m and rad; ``rounds``,
        ``reach`` and ``stride`` are those of :func:`.surfel_kernels.align`. Return None if the
        points tell no pose.
        """
        pose, spread = prior.copy(), covariance.copy()
        information, counts = np.zeros((3, 3)), np.zeros(COUNTS)
        is_solved = align(
            self.arrays, points, len(points), stride, reach, prior, spread, tolerances, rounds,
            pose, information, counts, self._work,
        )  # fmt: skip
        if not is_solved or not np.isfinite(pose).all():
            return None
        met = counts[MATCHED] / max(counts[ASKED], 1.0)
        close = counts[CLOSE] / max(counts[MATCHED], 1.0)
        return Match(pose, spread, information, int(counts[ASKED]), float(met), float(close))
