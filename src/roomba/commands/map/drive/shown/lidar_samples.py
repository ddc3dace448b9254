"""Scans of a drive by which its lidar is looked at, and where odometry had the robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats
from roomba.perception.matching.pose_kernels import is_apart, seen_from
from roomba.perception.matching.reckoned_path import ReckonedPath
from roomba.perception.slam.scan_matching.correlative import CorrelativeMatch, CorrelativeMatcher
from roomba.perception.slam.scan_matching.surface_kernels import (
    POINT,
    room_for_sums,
    surface_points,
)
from roomba.recordings.drives.sweeps import Sweep, SweptScans
from roomba.recordings.readings import LidarScan, Odometry, Reading, Turning

_APART_WAY, _APART_TURN = 0.03, 0.03
"""m, rad; between scans that are kept: a robot that stands shows nothing new."""
_MOST: Final = 600
"""Scans that are kept at most, with 18 m of way or 18 rad of turns between them."""
_REACH: Final = 12.0
"""m; farther points of a scan do not count when it is laid on another one."""
_AROUND: Final = 2.0
"""s; of odometry before and after a scan that is looked at."""
_TIMES: Final = 4
"""Odometry that is needed to tell anything."""


class Sample(NamedTuple):
    """A scan and its stamp, s; ``pose`` is where odometry had the robot then, [3]."""

    stamp: float
    scan: LidarScan
    pose: Floats


@dataclass(frozen=True, slots=True, eq=False)
class _Path:
    """Odometry: rows of stamp, s, x, y, m, and theta, rad, not wrapped."""

    rows: Floats

    def at(self, stamp: float) -> Floats:
        """Return the pose at a time, [3]."""
        stamps, *axes = self.rows.T
        return np.array([np.interp(stamp, stamps, axis) for axis in axes])

    def around(self, stamp: float) -> ReckonedPath:
        """Return a piece of it as kernels know it."""
        begin, end = np.searchsorted(self.rows[:, 0], (stamp - _AROUND, stamp + _AROUND)).tolist()
        piece = self.rows[max(begin - 1, 0) : end + 1].copy()
        return ReckonedPath(piece, np.array([len(piece) - 1, len(piece)]))


class LidarSamples:
    """Scans that were kept, in the order of time.

    ``period`` is the usual time between two, s, ``odometry_period`` that of odometry; 0 without.
    ``count`` is how many scans came, also of which odometry tells nothing. With ``has_odometry``
    there is enough of it to tell anything; if it ``never_changes``, it has one pose alone.
    ``turnings`` are rows of stamp, s, and turning speed, rad/s, of a gyro till the last scan.
    """

    def __init__(self, readings: Iterable[Reading]) -> None:
        """Keep scans until there are enough, and all odometry till then."""
        rows: list[tuple[float, float, float, float]] = []
        turnings: list[tuple[float, float]] = []
        kept: list[tuple[float, LidarScan]] = []
        stamps: list[float] = []
        apart_from: tuple[float, float, float] | None = None
        self.count = 0
        for stamp, value, _ in readings:
            if isinstance(value, Odometry) and (not rows or stamp > rows[-1][0]):
                rows.append((stamp, value.pose.x, value.pose.y, value.pose.theta))
            elif isinstance(value, Turning):
                turnings.append((stamp, value.speed))
            elif isinstance(value, LidarScan):
                self.count += 1
                if not rows:
                    continue
                stamps.append(stamp)
                now = rows[-1][1:]
                if apart_from is None or is_apart(
                    np.array(now), np.array(apart_from), _APART_WAY, _APART_TURN
                ):
                    kept.append((stamp, value))
                    apart_from = now
            if len(kept) == _MOST:
                break
        path = np.array(rows).reshape(-1, 4)
        path[:, 3] = np.unwrap(path[:, 3])
        self._path = _Path(path)
        self.turnings = np.array(turnings).reshape(-1, 2)
        self.period, self.odometry_period = _period(stamps), _period(path[:, 0])
        self.has_odometry = len(rows) >= _TIMES
        self.never_changes = self.has_odometry and not np.ptp(path[:, 1:], axis=0).any()
        self._kept = kept if self.has_odometry else []
        self._swept: dict[Sweep, SweptScans] = {}

    @cached_property
    def scans(self) -> list[Sample]:
        """The scans of which odometry tells where they were taken, from begin to end."""
        begin, end = self._path.rows[[0, -1], 0].tolist() if self._kept else (0.0, 0.0)
        return [
            Sample(stamp, scan, self._path.at(stamp))
            for stamp, scan in self._kept
            if begin <= stamp <= end - self.period
        ]

    def turning(self, sample: Sample) -> float:
        """Return how far the robot turned from a scan on until the next one usually came, rad."""
        return float(self._path.at(sample.stamp + self.period)[2] - sample.pose[2])

    def between(self, one: Sample, other: Sample, late: float = 0.0) -> Floats:
        """Return where odometry had the robot at a scan, as seen from it at another one, [3].

        Scans are stamped ``late``, s.
        """
        at = (self._path.at(each.stamp - late).tolist() for each in (one, other))
        return np.array(seen_from(np.array(next(at)), np.array(next(at))))

    def points(self, sample: Sample, sweep: Sweep | None = None, late: float = 0.0) -> Floats:
        """Return the points that a scan shows, [n, 4], as :func:`surface_points` does.

        None is the sweep that the driver tells; scans are stamped ``late``, s.
        """
        scan = sample.scan
        if sweep is not None:
            scan = self._swept.setdefault(sweep, SweptScans(sweep)).of(scan)
        stamp = sample.stamp - late
        still = scan.lidar.at_once(stamp, scan.ranges, self._path.around(stamp))
        points, sums = np.empty((scan.lidar.beams, POINT)), room_for_sums(scan.lidar.beams)
        return points[: surface_points(still, scan.lidar.arrays(), 0.0, points, sums)]


def laid_on(
    place: Floats, points: Floats, around: Floats, window: float, turn: float, least: float = 0.0
) -> CorrelativeMatch | None:
    """Lay the points of a scan on those of another one, ``place``.

    Both are as :meth:`LidarSamples.points` returns them. Returns the best pose within ``window``,
    m, and ``turn``, rad, of the pose ``around`` [3] in the frame of ``place``; None if one of them
    shows nothing near, or they fit nowhere by a mean likelihood of more than ``least``, 0..1.
    """
    if not (np.hypot(place[:, 0], place[:, 1]) < _REACH).any():
        return None
    return CorrelativeMatcher(place, _REACH).best(points, around, window, turn, least)


def _period(stamps: Sequence[float] | Floats) -> float:
    """Return the usual time between two stamps, s; 0 of fewer."""
    return float(np.median(np.diff(stamps))) if len(stamps) > 1 else 0.0
