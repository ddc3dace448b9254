"""A scan as perception uses it: the ends of the beams that met something, in the robot's frame."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.fit_kernels import (
    AGREEING,
    EVIDENCE,
    JUDGE_LANES,
    LOOKED_AT,
    SHORT,
    THROUGH,
    judge,
)
from roomba.perception.matching.match_kernels import beam_ends
from roomba.perception.matching.plausible import FARTHEST_ECHO
from roomba.perception.matching.reckoned_path import ReckonedPath
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.matching.sweep import SWEEP_WORK, at_once

Ranges = NDArray[np.float32]

_LONGEST_SWEEP: Final = 1.5
"""s; no lidar takes longer for a scan: with a longer time the driver filled in something else."""


@dataclass(frozen=True, slots=True)
class Fit:
    """How well a scan fits a pose: shares of its beams, and the evidence to compare poses by.

    Beams that end where the map has a surface ``agree``; ``short`` ones met something that the map
    does not show; those that go ``through`` a surface of the map are the worst.
    """

    agree: float
    short: float
    through: float
    evidence: float


def plain_ranges(ranges: Ranges) -> Ranges:
    """Return a scan as it is, or a copy if the array is not contiguous, or is read-only.

    Kernels would be compiled anew, for seconds, for each such kind of array.
    """
    return np.require(ranges, np.float32, ("C", "W"))


class LidarModel:
    """Where the beams of a lidar go: angles in its own frame, the mount in the robot's frame."""

    def __init__(
        self,
        angles: NDArray[np.float64],
        nearest: float,
        farthest: float,
        mount: Pose | None = None,
        time_increment: float = 0.0,
    ) -> None:
        """Take the beams' ``angles``, float64 [beams], rad, evenly spaced.

        Ranges count from ``nearest`` on that are less than ``farthest``, m. Each beam is measured
        ``time_increment``, s, after the one before it, the first one at the stamp of its scan; an
        increment that makes no sense counts as 0.
        """
        mount = mount or Pose()
        self.beams = len(angles)
        self.mount = mount.as_array()
        self._first_angle = float(angles[0]) if self.beams else 0.0
        self._step = float(angles[1] - angles[0]) if self.beams > 1 else 2.0 * np.pi
        self._directions = np.column_stack((np.cos(angles), np.sin(angles)))
        # In float32, as ranges are: drivers report no echo as a range equal to the farthest.
        self._nearest = float(nearest)
        self._farthest = float(np.float32(min(farthest, FARTHEST_ECHO)))
        is_sweep = abs(time_increment) * self.beams <= _LONGEST_SWEEP
        self.time_increment = float(time_increment) if is_sweep else 0.0
        self._arrays: LidarBeams | None = None

    @staticmethod
    def all_around(beams: int, nearest: float, farthest: float) -> LidarModel:
        """Return a lidar in the middle of the robot, beam 0 ahead, then counter-clockwise."""
        return LidarModel(np.arange(beams) * (2.0 * np.pi / beams), nearest, farthest)

    def moved(self, by: Pose) -> LidarModel:
        """Return the same lidar with its mount moved by ``by``, in the robot's frame."""
        lidar = copy(self)
        mount = by.compose(Pose(*self.mount.tolist()))
        lidar.mount, lidar._arrays = mount.as_array(), None
        return lidar

    def swept(self, time_increment: float, *, is_backwards: bool) -> LidarModel:
        """Return the same lidar with another time between beams, s.

        A lidar that ``is_backwards`` has its beams in the opposite order: the ranges of its scans
        are to be reversed as well.
        """
        lidar = copy(self)
        lidar.time_increment, lidar._arrays = time_increment, None
        if is_backwards and self.beams:
            lidar._directions = np.ascontiguousarray(self._directions[::-1])
            lidar._first_angle = self._first_angle + self._step * (self.beams - 1)
            lidar._step = -self._step
        return lidar

    @property
    def step(self) -> float:
        """Angle from one beam to the next, rad."""
        return self._step

    def arrays(self) -> LidarBeams:
        """Return the lidar as kernels know it, with work arrays of its own."""
        ends, lanes = np.empty((self.beams, 4)), np.empty((JUDGE_LANES, self.beams))
        return LidarBeams(
            self._directions,
            self.mount,
            self._first_angle,
            self._step,
            self._nearest,
            self._farthest,
            self.time_increment,
            ends,
            lanes,
        )

    @property
    def sweep(self) -> float:
        """How long after the stamp of a scan its last beam is measured, s."""
        return max(0.0, self.time_increment * (self.beams - 1))

    def at_once(self, stamp: float, ranges: Ranges, path: ReckonedPath) -> Ranges:
        """Return a scan, float32 [beams], m, as if all of it was measured at its stamp, s.

        ``path`` tells how the robot moved meanwhile. If the lidar measures all beams at once, the
        scan is returned as it is.
        """
        if self.time_increment == 0.0 or ranges.shape != (self.beams,):
            return ranges
        if self._arrays is None:
            self._arrays = self.arrays()
        still, work = np.empty(self.beams, np.float32), np.empty((SWEEP_WORK, self.beams))
        at_once(plain_ranges(ranges), self._arrays, path, stamp, still, work)
        return still

    def view(self, ranges: NDArray[np.float32]) -> ScanView:
        """Return the view of a scan, float32 [beams], m; raises ValueError for another shape."""
        if ranges.shape != (self.beams,):
            raise ValueError(f"expected a scan of {self.beams} ranges, got shape {ranges.shape}")
        ends, plain = np.empty((self.beams, 4)), plain_ranges(ranges)
        count = beam_ends(plain, self._directions, self.mount, self._nearest, self._farthest, ends)
        return ScanView(ends[:count], self.mount)


class PlacedScan(NamedTuple):
    """What a scan showed from ``pose``, map frame: ``ranges`` is float32 [beams], m.

    ``ranges`` are as if all were measured at once from there; ``measured`` are the original ones.
    """

    pose: Pose
    ranges: Ranges
    measured: Ranges
    lidar: LidarModel


@dataclass(frozen=True, slots=True, eq=False)
class ScanView:
    """Beams that met something: ``ends`` is float64 [n, 4], in the robot's frame.

    A row is a beam's end x, y, m, and its direction, cosine and sine. ``mount`` [3] is the lidar's.
    """

    ends: NDArray[np.float64]
    mount: NDArray[np.float64]

    def __len__(self) -> int:
        """How many beams met something."""
        return len(self.ends)

    def ends_at(self, pose: Pose) -> NDArray[np.float32]:
        """Return the beams' ends in the frame of which ``pose`` is a pose: float32 [n, 2], m."""
        cosine, sine = np.cos(pose.theta), np.sin(pose.theta)
        x, y = self.ends[:, 0], self.ends[:, 1]
        return np.column_stack(
            (pose.x + cosine * x - sine * y, pose.y + sine * x + cosine * y)
        ).astype(np.float32)

    def fit(self, field: SurfaceField, pose: NDArray[np.float64], stride: int = 1) -> Fit:
        """Return how well the scan fits a pose, float64 [3], by each ``stride``-th of its beams."""
        counts, lanes = np.empty(5), np.empty((JUDGE_LANES, len(self.ends)))
        judge(
            field.values,
            field.place,
            self.ends,
            len(self.ends),
            pose,
            self.mount,
            stride,
            counts,
            lanes,
        )
        looked_at = max(counts[LOOKED_AT], 1.0)
        return Fit(
            float(counts[AGREEING] / looked_at),
            float(counts[SHORT] / looked_at),
            float(counts[THROUGH] / looked_at),
            float(counts[EVIDENCE]),
        )
