"""Compiled: the mapper's work on a scan that only has to be followed."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry, inner_part
from roomba.perception.calibration.kernels import drop_window
from roomba.perception.calibration.latency import learn_latency
from roomba.perception.calibration.place_kernels import note_pose
from roomba.perception.localization.belief.belief import Rows
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.matching.range_noise import measure_noise
from roomba.perception.matching.reckoned_path import ReckonedPath, pose_at
from roomba.perception.matching.sweep import at_once
from roomba.perception.slam.following.finding_back_kernels import is_due, least_usual, saw
from roomba.perception.slam.following.follow_kernels import COVARIANCE, follow, moved_since
from roomba.perception.slam.scan_matching.surface_kernels import surface_points
from roomba.perception.slam.scan_matching.surfel_kernels import Surfels

Ranges = NDArray[np.float32]

IS_LEFT: Final = 0
IS_FOLLOWED: Final = 1
IS_DONE: Final = 2
"""Results of :func:`take_scan`: all work on the scan is left to the classes; the scan was followed,
but it does not fit or is to be kept, and that is left; all is done."""


class Following(NamedTuple):
    """All arrays that are needed to follow scans.

    ``follower``, FOLLOWER, ``belief``, BELIEF, ``noise``, NOISE, ``latency``, LATENCY, and
    ``finding``, FINDING, have one row each. Scans of ``beams`` are matched to ``surfels``;
    ``points`` is float64 [beams, POINT], those of the newest scan. ``sums``, ``still`` and ``work``
    are work arrays.
    """

    follower: Rows
    belief: Rows
    path: ReckonedPath
    noise: Rows
    latency: Rows
    finding: Rows
    surfels: Surfels
    beams: LidarBeams
    points: Floats
    sums: Floats
    still: Ranges
    work: Floats


@inner_part
def take_scan(following: Following, stamp: float, ranges: Ranges) -> int:
    """Follow the robot by a scan, float32 [beams], m, that was taken at ``stamp``, s.

    Returns what is left to do: nothing, if the scan only confirms where the robot is.
    """
    follower = following.follower[0]
    if not find_reckoned(following, stamp):
        return IS_LEFT
    see_points(following, stamp, ranges)
    follow_points(following, stamp)
    if not follower.is_sure or is_due(following.finding):
        return IS_FOLLOWED
    if is_apart_from_keyframe(following.follower):
        return IS_FOLLOWED
    compare_turns(following, stamp)
    return IS_DONE


@entry
def is_apart_from_keyframe(followers: Rows) -> bool:
    """Whether the newest scan was taken so far from the newest keyframe as to be kept."""
    row = followers[0]
    return is_apart(row.here, row.keyframe, row.keyframe_way, row.keyframe_turn)


@inner_part
def find_reckoned(following: Following, stamp: float) -> bool:
    """Fill ``scanned_at`` with where dead reckoning had the robot at a scan, if it is known."""
    lateness = following.latency[0].seconds
    return pose_at(following.path, stamp - lateness, following.follower[0].scanned_at)


@entry
def see_points(following: Following, stamp: float, ranges: Ranges) -> None:
    """Find the points that a scan shows, and learn how noisy its ranges are."""
    noise, beams = following.noise, following.beams
    measure_noise(noise, ranges, beams.nearest, beams.farthest)
    following.follower[0].range_deviation = noise[0].deviation
    if beams.time_increment == 0.0:
        _find_points(following, ranges)
        return
    began = stamp - following.latency[0].seconds
    at_once(ranges, beams, following.path, began, following.still, following.work)
    _find_points(following, following.still)


@inner_part
def _find_points(following: Following, ranges: Ranges) -> None:
    """Find the points of a scan whose beams were all measured at once."""
    follower = following.follower[0]
    follower.points = surface_points(
        ranges, following.beams, follower.range_deviation, following.points, following.sums
    )


@entry
def follow_points(following: Following, stamp: float) -> None:
    """Follow the robot by the points of a scan, and note how well they fit."""
    follower = following.follower[0]
    follower.heading_before = follower.here[2] if follower.is_sure else math.nan
    finding = following.finding[0]
    follow(
        following.follower, following.belief, follower.scanned_at, following.surfels,
        following.points, follower.points, stamp - finding.stamp, least_usual(following.finding),
    )  # fmt: skip
    saw(following.finding, following.follower, stamp)
    _calibrate(following)


@inner_part
def _calibrate(following: Following) -> None:
    """Measure the robot's errors by the scan that was followed just now."""
    follower, row = following.follower[0], following.belief[0].calibration
    if not follower.is_sure:
        drop_window(row)
        return
    here = follower.here
    now = moved_since(following.follower, following.belief, here[0], here[1], here[2])
    note_pose(row, now, follower.work[COVARIANCE : COVARIANCE + 3], follower.spread)


@entry
def compare_turns(following: Following, stamp: float) -> None:
    """Learn how late scans are from the turn since the scan before, if both confirmed the pose."""
    follower = following.follower[0]
    turn = wrapped(follower.here[2] - follower.heading_before) if follower.is_sure else math.nan
    learn_latency(following.latency, turn, stamp, following.path)
