"""The exploring loop compiled: the world, the mapper between two keyframes, and the tracker.

It does what :meth:`roomba.headless.explorer.HeadlessExplorer.tick` does while nothing comes up,
with the same functions, and stops as soon as something does.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.headless.closed_loop_kernels import DRIVE, Track, World, drive, something_comes_up
from roomba.perception.localization.belief_reckon_kernels import reckon
from roomba.perception.matching.match_kernels import beam_ends
from roomba.perception.slam.follow_kernels import (
    Following,
    beyond,
    follow_scan,
    is_apart,
    moved_since,
)
from roomba.perception.things.kernels import Things, note

Floats = NDArray[np.float64]
Rows = NDArray[np.void]

EXPLORING_LOOP: Final = np.dtype(
    [
        *DRIVE,
        ("until", "f8"),  # s; then the ordinary classes have their turn
        ("at_scan", "f8", (3,)),  # where it was at the newest scan, map
        ("points", "i8"),  # of the newest scan if it is to be kept as a keyframe, else 0
    ],
    align=True,
)
"""State and numbers of the loop, one row."""

TIME: Final = 0
TRUE: Final = slice(1, 4)
BELIEVED: Final = slice(4, 7)
ODOMETRY: Final = slice(7, 10)
GYRO: Final = 10
PASSED: Final = 11
"""Columns of a tick that passed: t, s; x, y (m) and theta (rad), true, as believed, and by the
wheels; the gyro's turning speed, rad/s."""


class Sight(NamedTuple):
    """What is seen that the map does not show; ``field`` and ``place`` are that map's."""

    things: Things
    field: NDArray[np.float32]
    place: Floats


@njit(cache=True, nogil=True, error_model="numpy")
def run(
    loops: Rows, world: World, following: Following, sight: Sight, tracks: Track, rows: Floats
) -> int:
    """Let ticks pass until something comes up, or ``rows`` [n, PASSED] is full; return how many."""
    loop: Any = loops[0]
    robot: Any = world.state.solid.robots[0]
    follower, belief = following.follower, following.belief
    at = loop.at_scan
    x, y, theta = moved_since(follower, belief, at[0], at[1], at[2])
    ticks = rows.shape[0]
    for tick in range(rows.shape[0]):
        go_on(loop, x, y)
        now = drive(loop, world, tracks, x, y, theta)
        map_on(loop, world, following, sight, now)
        x, y, theta = moved_since(follower, belief, at[0], at[1], at[2])
        write_down(rows[tick], now, robot, x, y, theta)
        if (
            loop.points > 0
            or something_comes_up(loop, robot, tracks, sight.things)
            or not follower[0].is_sure
            or now >= loop.until
        ):
            ticks = tick + 1
            break
    go_on(loop, x, y)
    return ticks


@njit(cache=True, nogil=True, error_model="numpy")
def go_on(loop: Any, x: float, y: float) -> None:
    """Note the way to where it is."""
    loop.way += math.hypot(x - loop.last_x, y - loop.last_y)
    loop.last_x, loop.last_y = x, y


@njit(cache=True, nogil=True, error_model="numpy")
def map_on(loop: Any, world: World, following: Following, sight: Sight, now: float) -> None:
    """Go on by wheels and gyro, and follow every so many scans; one may be worth a keyframe."""
    robot: Any = world.state.solid.robots[0]
    reckon(
        following.belief,
        following.numbers,
        now,
        robot.odometry_x,
        robot.odometry_y,
        robot.odometry_theta,
        robot.gyro,
    )
    if robot.scans == loop.scans:
        return
    loop.scans = robot.scans
    if loop.scans % loop.every != 0:
        return
    ranges = world.state.ranges[0]
    points = follow_scan(following, ranges)
    follower: Any = following.follower[0]
    here, at, submap = follower.here, loop.at_scan, following.submap
    at[0], at[1], at[2] = beyond(submap[0], submap[1], submap[2], here[0], here[1], here[2])
    if not follower.is_sure:
        return
    if is_apart(here, following.keyframe, following.apart, following.turned):
        # What else is seen in it is told when the map has it.
        loop.points = points
        return
    look(sight, following, ranges, at)


@njit(cache=True, nogil=True, error_model="numpy")
def look(sight: Sight, following: Following, ranges: NDArray[np.float32], at: Floats) -> None:
    """Note what a scan that was taken at a pose [3] shows besides the map."""
    lidar = following.beams
    count = beam_ends(
        ranges, lidar.directions, lidar.mount, lidar.nearest, lidar.farthest, lidar.ends
    )
    note(sight.things, sight.field, sight.place, lidar, ranges, count, at, 1)


@njit(cache=True, nogil=True, error_model="numpy")
def write_down(row: Floats, now: float, robot: Any, x: float, y: float, theta: float) -> None:
    """Fill a row with what is so after a tick."""
    row[TIME] = now
    row[1], row[2], row[3] = robot.x, robot.y, robot.theta
    row[4], row[5], row[6] = x, y, theta
    row[7], row[8], row[9] = robot.odometry_x, robot.odometry_y, robot.odometry_theta
    row[GYRO] = robot.gyro
