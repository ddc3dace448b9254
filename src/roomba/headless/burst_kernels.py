"""The compiled burst: world, place, things and tracker, tick by tick, while nothing comes up.

A tick is done here with the functions that the classes call as well, or it is left to them: it ends
before the first tick that would do anything else. So it may end earlier, too; the result is the
same. Ticks begin when all was sensed, and end there, as :meth:`HeadlessMission.tick` does.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.control.tracking_kernels import Course, track
from roomba.headless.rows import GYRO, TIME
from roomba.mission.driving.progress_kernels import along_of, mark_progress, off_path
from roomba.mission.phases.dust_bin_kernels import note_dust
from roomba.perception.localization.belief_correct_kernels import correct, is_calm
from roomba.perception.localization.belief_reckon_kernels import reckon_on
from roomba.perception.localization.recent_sight_kernels import Sights, note_sight
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.match_kernels import beam_ends
from roomba.perception.matching.reckoned_path import ReckonedPath
from roomba.perception.slam.follow_kernels import beyond, moved_since
from roomba.perception.slam.scan_kernels import IS_DONE, IS_LEFT, Following, take_scan
from roomba.perception.swept.coverage_kernels import sweep
from roomba.perception.swept.coverage_map import LONGEST_STEP
from roomba.perception.swept.dirt_map import note_dirt
from roomba.perception.things.kernels import Things, note
from roomba.world.engine.lidar.projection import ScanBuffers
from roomba.world.engine.state.arrays import State
from roomba.world.engine.step_kernels import advance

Floats = NDArray[np.float64]
Rows = NDArray[np.void]

BURST: Final = np.dtype(
    [
        # what does not change
        ("step", "f8"),  # s of the world
        ("steps", "i8"),  # of the world in a tick
        ("apart", "f8"),  # s; at least, between two scans that are looked at
        ("stride", "i8"),  # scans that such a one stands for
        ("bin_capacity", "f8"),  # micrograms
        ("is_mapping", "?"),  # whether the place is a mapper's
        # what ends it
        ("drives", "?"),  # along a path; else it stands on its station
        ("limit", "f8"),  # m/s
        ("until", "f8"),  # s
        ("least_charge", "f8"),  # Wh
        ("most_charge", "f8"),
        ("goal", "f8", (2,)),  # m
        ("near", "f8"),  # m
        ("most_in_bin", "f8"),  # micrograms
        ("most_silent", "f8"),  # m2 that became clean without a grain
        ("cell_area", "f8"),  # m2
        ("clear_to", "f8"),  # m along the path
        ("off_path", "f8"),  # m
        ("progress_timeout", "f8"),  # s without progress
        ("things_version", "i8"),  # of what is known to stand in the way
        # what goes on
        ("clock", "f8"),  # s; of the robot, beside the world's
        ("scans", "i8"),  # that came so far
        ("seen_at", "f8"),  # s; when the last one that was looked at came
        ("submap", "f8", (3,)),  # m, rad; where a mapper follows it
        ("at_scan", "f8", (3,)),  # a mapper's place at that one
        ("seen_from", "f8", (3,)),  # and by now
        ("last", "f8", (3,)),  # time, s, and place, m, as believed, when the last tick began
        ("way", "f8"),  # m; driven between these, as believed
        ("sweeps", "?"),  # whether what is driven over counts
        ("swept_at", "f8", (2,)),  # m; where it counted last, as believed
        ("true_at", "f8", (2,)),  # m; the same in truth
        ("swept", "i8"),  # wanted cells that became clean
        ("truth_swept", "i8"),
        # what the classes have to finish
        ("is_left", "?"),  # the newest scan
        ("is_followed", "?"),  # though a mapper's place was followed by it
    ],
    align=True,
)
"""State and numbers of a burst, one row."""


class World(NamedTuple):
    """The simulated one, of one robot."""

    state: State
    numbers: Rows
    quantiles: NDArray[np.float32]
    buffers: ScanBuffers


class PlaceParts(NamedTuple):
    """What knows the place: ``sights`` counts for a localizer, ``following`` for a mapper."""

    belief: Rows
    numbers: Rows
    path: ReckonedPath
    beams: LidarBeams
    sights: Sights
    following: Following


class Sight(NamedTuple):
    """What is seen that the map does not show; ``field`` and ``place`` are that map's."""

    things: Things
    field: NDArray[np.float32]
    place: Floats


class Drive(NamedTuple):
    """The tracker, its path, and how it comes farther on it."""

    state: Rows
    course: Course
    progress: Rows


class Floor(NamedTuple):
    """What is cleaned as the robot believes and in truth, how dirty it was, and what came in."""

    cells: NDArray[np.uint8]
    place: Floats
    true_cells: NDArray[np.uint8]
    true_place: Floats
    radius: float
    grains: NDArray[np.float32]
    way: NDArray[np.float32]
    dirt_place: Floats
    dust: Rows


@njit(cache=True, nogil=True, error_model="numpy")
def run(
    bursts: Rows,
    world: World,
    place: PlaceParts,
    sight: Sight,
    drive: Drive,
    floor: Floor,
    rows: Floats,
) -> int:
    """Let ticks pass until something comes up, or ``rows`` [n, PASSED] is full; return how many."""
    burst: Any = bursts[0]
    robot: Any = world.state.solid.robots[0]
    x, y, theta = believed(burst, place)
    ticks = 0
    while ticks < rows.shape[0]:
        now = world.state.worlds[0].time + burst.clock
        if comes_up(burst, robot, drive, sight.things, x, y, now) or may_be_full(
            burst, robot, floor
        ):
            break
        linear, angular, is_done = wanted(burst, drive, x, y, theta)
        if is_done:
            break
        account(burst, robot, floor, now, x, y)
        robot.wanted_linear, robot.wanted_angular = linear, angular
        advance(
            world.state, 0, 1, world.numbers, world.quantiles, world.buffers, burst.step,
            burst.steps,
        )  # fmt: skip
        now = world.state.worlds[0].time + burst.clock
        is_settled = follow(burst, world, place, sight, now)
        x, y, theta = believed(burst, place)
        sweep_truth(burst, robot, floor)
        write_down(rows[ticks], now - burst.clock, robot, x, y, theta)
        ticks += 1
        if not is_settled:
            break
    return ticks


# ---------------------------------------------------------------- deciding


@njit(cache=True, nogil=True, error_model="numpy")
def comes_up(
    burst: Any, robot: Any, drive: Drive, things: Things, x: float, y: float, now: float
) -> bool:
    """Tell whether the next tick is for the classes."""
    if is_in_danger(robot) or now >= burst.until:
        return True
    if not burst.drives:
        return bool(robot.docked == 0.0 or robot.charge >= burst.most_charge)
    tracker: Any = drive.state[0]
    if (
        robot.bumper_left + robot.bumper_right + robot.docked > 0.0
        or robot.charge < burst.least_charge
        or math.hypot(x - burst.goal[0], y - burst.goal[1]) < burst.near
        or things.layer[0].version != burst.things_version
        or off_path(tracker, drive.course, x, y) > burst.off_path
    ):
        return True
    along = along_of(tracker, drive.course)
    if along >= burst.clear_to:
        return True
    return bool(mark_progress(drive.progress, along, tracker.leg, now) > burst.progress_timeout)


@njit(cache=True, nogil=True, error_model="numpy")
def may_be_full(burst: Any, robot: Any, floor: Floor) -> bool:
    """Tell whether the dust bin may have become full, by its level or as no grain comes in."""
    silent = floor.dust[0].silent_cells * burst.cell_area
    return bool(robot.in_bin >= burst.most_in_bin or silent >= burst.most_silent)


@njit(cache=True, nogil=True, error_model="numpy")
def is_in_danger(robot: Any) -> bool:
    """Tell whether there is no floor below a part of the robot."""
    return bool(
        robot.cliff_left
        + robot.cliff_front_left
        + robot.cliff_front_right
        + robot.cliff_right
        + robot.drop_left
        + robot.drop_right
        > 0.0
    )


@njit(cache=True, nogil=True, error_model="numpy")
def wanted(burst: Any, drive: Drive, x: float, y: float, theta: float) -> tuple[float, float, bool]:
    """Return the twist, m/s and rad/s, along the path, and whether that has ended.

    Then the tracker is left as it was: the path's last tick is for the classes.
    """
    if not burst.drives:
        return 0.0, 0.0, False
    tracker: Any = drive.state[0]
    leg, turning, along, aside = tracker.leg, tracker.turning, tracker.along, tracker.aside
    linear, angular = track(tracker, drive.course, x, y, theta, burst.limit)
    if tracker.done > 0.0:
        tracker.leg, tracker.turning, tracker.done = leg, turning, 0.0
        tracker.along, tracker.aside = along, aside
        return 0.0, 0.0, True
    return linear, angular, False


# ---------------------------------------------------------------- keeping the ledgers


@njit(cache=True, nogil=True, error_model="numpy")
def account(burst: Any, robot: Any, floor: Floor, now: float, x: float, y: float) -> None:
    """Note the way since the last tick began, and what floor was cleaned on it."""
    way = math.hypot(x - burst.last[1], y - burst.last[2])
    burst.way += way
    if burst.sweeps:
        at_x, at_y = from_where(burst.swept_at, x, y)
        cells = sweep(floor.cells, floor.place, at_x, at_y, x, y, floor.radius)
        burst.swept += cells
        burst.swept_at[0], burst.swept_at[1] = x, y
        note_dust(floor.dust, robot.grains, way, cells)
        grains = robot.grains * (now - burst.last[0])
        note_dirt(floor.grains, floor.way, floor.dirt_place, x, y, grains, way)
    burst.last[0], burst.last[1], burst.last[2] = now, x, y


@njit(cache=True, nogil=True, error_model="numpy")
def sweep_truth(burst: Any, robot: Any, floor: Floor) -> None:
    """Note what floor the tool really passed over, with room for its dust."""
    if robot.in_bin >= burst.bin_capacity:
        burst.true_at[0] = burst.true_at[1] = math.nan
        return
    at_x, at_y = from_where(burst.true_at, robot.x, robot.y)
    burst.truth_swept += sweep(
        floor.true_cells, floor.true_place, at_x, at_y, robot.x, robot.y, floor.radius
    )
    burst.true_at[0], burst.true_at[1] = robot.x, robot.y


@njit(cache=True, nogil=True, error_model="numpy")
def from_where(last: Floats, x: float, y: float) -> tuple[float, float]:
    """Return where the tool swept from to a place: from the last one, if it drove from there."""
    away = math.hypot(x - last[0], y - last[1])
    if away <= LONGEST_STEP:
        return last[0], last[1]
    return x, y


@njit(cache=True, nogil=True, error_model="numpy")
def write_down(row: Floats, now: float, robot: Any, x: float, y: float, theta: float) -> None:
    """Fill a row with what is so after a tick."""
    row[TIME] = now
    row[1], row[2], row[3] = robot.x, robot.y, robot.theta
    row[4], row[5], row[6] = x, y, theta
    row[7], row[8], row[9] = robot.odometry_x, robot.odometry_y, robot.odometry_theta
    row[GYRO] = robot.gyro


# ---------------------------------------------------------------- knowing the place


@njit(cache=True, nogil=True, error_model="numpy")
def believed(burst: Any, place: PlaceParts) -> tuple[float, float, float]:
    """Return where the robot takes itself to be, x, y, theta, map."""
    if burst.is_mapping:
        at = burst.at_scan
        return moved_since(place.following.follower, place.belief, at[0], at[1], at[2])
    pose: Any = place.belief[0].pose
    return pose[0], pose[1], pose[2]


@njit(cache=True, nogil=True, error_model="numpy")
def follow(burst: Any, world: World, place: PlaceParts, sight: Sight, now: float) -> bool:
    """Go on by wheels, gyro and scans; tell whether the place is known and all of it is done."""
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
    if is_new and not 0.0 <= now - burst.seen_at < burst.apart:
        burst.seen_at = now
        ranges = world.state.ranges[0]
        if burst.is_mapping:
            return map_on(burst, place, sight, ranges, now)
        return localize(burst, place, sight, ranges, now)
    if burst.is_mapping:
        return True
    return bool(is_calm(place.belief, place.numbers, now))


@njit(cache=True, nogil=True, error_model="numpy")
def localize(
    burst: Any, place: PlaceParts, sight: Sight, ranges: NDArray[np.float32], now: float
) -> bool:
    """Correct a localizer's place by a scan; tell whether it is sure of it."""
    belief, beams = place.belief, place.beams
    count = correct(belief, place.numbers, sight.field, sight.place, beams, ranges, now)
    if not is_calm(belief, place.numbers, now):
        burst.is_left = True
        return False
    note_sight(place.sights, now, belief[0].reckoned, beams.ends, count)
    pose = belief[0].pose
    note(sight.things, sight.field, sight.place, beams, ranges, count, pose, burst.stride)
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def map_on(
    burst: Any, place: PlaceParts, sight: Sight, ranges: NDArray[np.float32], now: float
) -> bool:
    """Follow a mapper's place by a scan; tell whether that is all that is to be done with it."""
    following = place.following
    left = take_scan(following, now, ranges)
    if left != IS_DONE:
        burst.is_left, burst.is_followed = True, left != IS_LEFT
        return False
    submap, here, at = burst.submap, following.follower[0].here, burst.at_scan
    at[0], at[1], at[2] = beyond(submap[0], submap[1], submap[2], here[0], here[1], here[2])
    seen_from = burst.seen_from
    seen_from[0], seen_from[1], seen_from[2] = believed(burst, place)
    beams = place.beams
    count = beam_ends(
        ranges, beams.directions, beams.mount, beams.nearest, beams.farthest, beams.ends
    )
    note(sight.things, sight.field, sight.place, beams, ranges, count, seen_from, burst.stride)
    return True
