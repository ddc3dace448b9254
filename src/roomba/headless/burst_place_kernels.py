"""Localization within a burst, by wheels, gyro and scans: for a localizer or for a mapper.

A burst is compiled for one of the two. The argument of the other, ``sights`` of a localizer or
``following`` of a mapper, is None, and numba leaves out the code that needs it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_part, inner_part
from roomba.headless.burst_state import PlaceParts, Rows, Sight, World
from roomba.perception.localization.belief.correct_kernels import (
    calibrate,
    correct,
    correct_late,
    is_calm,
    place_deviation,
)
from roomba.perception.localization.belief.reckon_kernels import reckon_on
from roomba.perception.localization.recent_sight_kernels import Sights, note_sight
from roomba.perception.matching.pose_kernels import beyond, pose_then
from roomba.perception.matching.sweep import at_once
from roomba.perception.slam.following.follow_kernels import moved_since
from roomba.perception.slam.following.scan_kernels import IS_DONE, IS_LEFT, Following, take_scan
from roomba.perception.things.kernels import note


@inner_part
def believed(burst: Any, place: PlaceParts) -> tuple[float, float, float]:
    """Return the pose that the robot believes, x, y, theta, map."""
    return pose_of(burst, place.belief, place.following)


@inner_part
def pose_of(burst: Any, belief: Rows, following: Following | None) -> tuple[float, float, float]:
    """Return the pose in the map, x, y, theta, as a localizer or a mapper knows it."""
    if following is not None:
        at = burst.at_scan
        return moved_since(following.follower, belief, at[0], at[1], at[2])
    pose: Any = belief[0].pose
    return pose[0], pose[1], pose[2]


@inner_part
def follow(burst: Any, world: World, place: PlaceParts, sight: Sight, now: float) -> bool:
    """Update the pose by wheels, gyro and a new scan; tell whether it is sure and all is done."""
    robot: Any = world.state.solid.robots[0]
    reckon_on(
        place.belief,
        place.numbers,
        place.path,
        now,
        robot.odometry_x,
        robot.odometry_y,
        robot.odometry_theta,
        robot.gyro,
    )
    is_new = robot.scans != burst.scans
    burst.scans = robot.scans
    stamp = robot.scan_stamp + burst.clock if burst.is_late else now
    if is_new and not 0.0 <= stamp - burst.seen_at < burst.apart:
        burst.seen_at = stamp
        ranges = world.state.ranges[0]
        return look(burst, place, place.sights, place.following, sight, ranges, stamp, now)
    return is_sure(place, place.following, now)


@allocating_part
def look(
    burst: Any,
    place: PlaceParts,
    sights: Sights | None,
    following: Following | None,
    sight: Sight,
    ranges: NDArray[np.float32],
    stamp: float,
    now: float,
) -> bool:
    """Correct the pose by a scan of time ``stamp``, s; tell whether nothing is left to be done."""
    if following is not None:
        return map_on(burst, place, following, sight, ranges, stamp)
    if sights is not None:
        return localize(burst, place, sights, sight, ranges, stamp, now)
    return False


@inner_part
def is_sure(place: PlaceParts, following: Following | None, now: float) -> bool:
    """Tell whether the pose is sure enough without a new scan; a mapper's pose always is."""
    if following is not None:
        return True
    return bool(is_calm(place.belief, place.numbers, now))


@allocating_part
def localize(
    burst: Any,
    place: PlaceParts,
    sights: Sights,
    sight: Sight,
    ranges: NDArray[np.float32],
    stamp: float,
    now: float,
) -> bool:
    """Correct a localizer's pose by a scan of time ``stamp``, s; tell whether it is sure now."""
    belief, beams = place.belief, place.beams
    reckoned = place.work[0, :3]
    if burst.is_late:
        at_once(ranges, beams, place.path, stamp, place.still, place.work)
        count = correct_late(
            belief, place.numbers, sight.field, sight.place, beams, place.still, place.path,
            stamp, now, reckoned,
        )  # fmt: skip
    else:
        count = correct(belief, place.numbers, sight.field, sight.place, beams, ranges, now)
        for axis in range(3):
            reckoned[axis] = belief[0].reckoned[axis]
    calibrate(belief)
    if belief[0].calibration.is_lidar_due or not is_calm(belief, place.numbers, now):
        burst.is_left = True
        return False
    note_sight(sights, stamp, reckoned, beams.ends, count)
    still, at = place.still if burst.is_late else ranges, burst.seen_from
    at[0], at[1], at[2] = pose_then(belief[0].pose, belief[0].reckoned, reckoned)
    unsure = place_deviation(belief)
    note(sight.things, sight.field, sight.place, beams, still, ranges, at, unsure, burst.stride)
    return True


@inner_part
def map_on(
    burst: Any,
    place: PlaceParts,
    following: Following,
    sight: Sight,
    ranges: NDArray[np.float32],
    stamp: float,
) -> bool:
    """Follow a mapper's pose by a scan of time ``stamp``, s; tell whether all of that is done."""
    left = take_scan(following, stamp, ranges)
    if left != IS_DONE:
        burst.is_left, burst.is_followed = True, left != IS_LEFT
        return False
    submap, here, at = burst.submap, following.follower[0].here, burst.at_scan
    at[0], at[1], at[2] = beyond(submap[0], submap[1], submap[2], here[0], here[1], here[2])
    beams, unsure = place.beams, burst.unsure
    still = ranges if beams.time_increment == 0.0 else following.still
    note(sight.things, sight.field, sight.place, beams, still, ranges, at, unsure, burst.stride)
    return True
