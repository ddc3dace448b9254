"""Sampled scans of a drive, to find out facts about its lidar, and odometry's poses of them."""

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
"""m, rad; sampled scans are at least so far apart: a robot that stands shows nothing new."""
_MOST: Final = 600
"""Scans that are kept at most, with 18 m of way or 18 rad of turns between them."""
_REACH: Final = 12.0
"""m; farther points of a scan do not count when scans are matched."""
_AROUND: Final = 2.0
"""s of odometry before and after a scan that is used with it."""
_TIMES: Final = 4
"""Messages of odometry that are needed to find out anything."""


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

    ``period`` is the usual time between two scans of the drive, s, ``odometry_period`` that of
    odometry; 0 without. ``count`` is the number of scans read, also of those without odometry. With
    ``has_odometry`` there is enough odometry to find out anything; if it ``never_changes``, all its
    poses are equal. ``turnings`` are rows of stamp, s, and turning speed, rad/s, of a gyro till the
    last scan.
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
        """Return how far the robot turned within the usual time to the next scan, rad."""
        return float(self._path.at(sample.stamp + self.period)[2] - sample.pose[2])

    def between(self, one: Sample, other: Sample, late: float = 0.0) -> Floats:
        """Return the pose at one scan as seen from that at another, by odometry, [3].

        The scans' stamps are ``late`` by so many s.
        """
        at = (self._path.at(each.stamp - late).tolist() for each in (one, other))
        return np.array(seen_from(np.array(next(at)), np.array(next(at))))

    def points(self, sample: Sample, sweep: Sweep | None = None, late: float = 0.0) -> Floats:
        """Return the points that a scan shows, [n, 4], as :func:`surface_points` does.

        ``sweep`` None is the driver's own; the scans' stamps are ``late`` by so many s.
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
    """Match the points of a scan to those of another one, ``place``.

    Both are as :meth:`LidarSamples.points` returns them. Returns the best pose within ``window``,
    m, and ``turn``, rad, of the pose ``around`` [3] in the frame of ``place``; None if one of them
    shows nothing near, or no pose has a mean likelihood above ``least``, 0..1.
    """
    if not (np.hypot(place[:, 0], place[:, 1]) < _REACH).any():
        return None
    return CorrelativeMatcher(place, _REACH).best(points, around, window, turn, least)


def _period(stamps: Sequence[float] | Floats) -> float:
    """Return the usual time between two stamps, s; 0 of fewer."""
    return float(np.median(np.diff(stamps))) if len(stamps) > 1 else 0.0
