"""The compiled burst: world, place, things and tracker, tick by tick, while nothing comes up.

A tick is computed here with the same compiled functions that the classes call. The burst ends
before the first tick that would need anything else, and leaves that tick to the classes. It may
also end earlier: the result is the same. Ticks begin when all was sensed, and end there, as those
of :meth:`HeadlessMission.tick` do.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry, inner_part
from roomba.control.tracking_kernels import along_of, off_path, track
from roomba.headless.burst_place_kernels import believed, follow
from roomba.headless.burst_state import Drive, Floor, PlaceParts, Rows, Sight, World
from roomba.headless.tick_rows import BELIEVED, BIAS, GYRO, ODOMETRY, TIME, TRUE
from roomba.mission.cleaning.dirty.watch_kernels import may_be_dirty
from roomba.mission.driving.progress_kernels import is_held
from roomba.mission.driving.way_ahead_kernels import is_blocked
from roomba.mission.phases.carpet_kernels import changes_floor, note_current
from roomba.mission.phases.dust_bin_kernels import note_dust
from roomba.perception.swept.coverage_kernels import sweep, swept_from
from roomba.perception.swept.dirt_map import note_dirt
from roomba.perception.things.state import Things
from roomba.world.engine.step_kernels import advance


@entry
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
        if (
            comes_up(burst, robot, drive, sight.things, x, y, now)
            or may_be_full(burst, robot, floor)
            or (burst.watches_dirt and is_dirty_near(floor, x, y, now))
            or changes_floor(floor.carpet, robot.brush_current)
        ):
            break
        linear, angular, is_done = wanted(burst, drive, x, y, theta)
        if is_done:
            break
        account(burst, robot, floor, now, x, y)
        robot.wanted_linear, robot.wanted_angular = linear, angular
        advance(
            world.state, world.first, world.last, world.numbers, world.quantiles, world.buffers,
            burst.step, burst.steps,
        )  # fmt: skip
        now = world.state.worlds[0].time + burst.clock
        is_settled = follow(burst, world, place, sight, now)
        x, y, theta = believed(burst, place)
        true = told(burst, robot)
        sweep_truth(burst, robot, floor, true[0], true[1])
        write_down(rows[ticks], now - burst.clock, robot, place.belief[0], true, x, y, theta)
        ticks += 1
        if not is_settled:
            break
    return ticks


@inner_part
def comes_up(
    burst: Any, robot: Any, drive: Drive, things: Things, x: float, y: float, now: float
) -> bool:
    """Tell whether the next tick must be left to the classes."""
    if is_in_danger(robot) or now >= burst.until:
        return True
    if not burst.drives:
        return bool(robot.docked == 0.0 or robot.charge >= burst.most_charge)
    tracker: Any = drive.state[0]
    if (
        robot.bumper_left + robot.bumper_right + robot.docked > 0.0
        or robot.charge < burst.least_charge
        or math.hypot(x - burst.goal[0], y - burst.goal[1]) < burst.near
        or off_path(tracker, drive.course, x, y) > burst.off_path
    ):
        return True
    along = along_of(tracker, drive.course)
    course, version = drive.course, things.layer[0].version + burst.felt_version
    if is_blocked(drive.ahead, things, course.points, course.stations, version, along):
        return True
    return bool(is_held(drive.progress, along, tracker.leg, tracker.to_turn, now))


@inner_part
def may_be_full(burst: Any, robot: Any, floor: Floor) -> bool:
    """Tell whether the dust bin may have become full, by its level or as no grain comes in."""
    silent = floor.dust[0].silent_cells * burst.cell_area
    return bool(robot.in_bin >= burst.most_in_bin or silent >= burst.most_silent)


@inner_part
def is_dirty_near(floor: Floor, x: float, y: float, now: float) -> bool:
    """Tell whether the mission is to look for dirty floor near a place, m."""
    return may_be_dirty(
        floor.watch, floor.grains, floor.way, floor.done, floor.dirt_place, x, y, now
    )


@inner_part
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


@inner_part
def wanted(burst: Any, drive: Drive, x: float, y: float, theta: float) -> tuple[float, float, bool]:
    """Return the twist, m/s and rad/s, along the path, and whether the path has ended.

    If it has, the tracker is left as it was: the path's last tick is for the classes.
    """
    if not burst.drives:
        return 0.0, 0.0, False
    tracker: Any = drive.state[0]
    drive.before[0] = drive.state[0]
    linear, angular = track(tracker, drive.course, x, y, theta, burst.limit)
    if tracker.done > 0.0:
        drive.state[0] = drive.before[0]
        return 0.0, 0.0, True
    return linear, angular, False


@inner_part
def account(burst: Any, robot: Any, floor: Floor, now: float, x: float, y: float) -> None:
    """Note the way since the last tick began, and what floor was cleaned on it."""
    note_current(floor.carpet, robot.brush_current)
    way = math.hypot(x - burst.last[1], y - burst.last[2])
    burst.way += way
    if burst.sweeps:
        at_x, at_y = swept_from(burst.swept_at[0], burst.swept_at[1], x, y)
        cells = sweep(floor.cells, floor.place, at_x, at_y, x, y, floor.radius)
        burst.swept += cells
        burst.swept_at[0], burst.swept_at[1] = x, y
        # The sensor tells whole numbers.
        grains = np.rint(robot.grains)
        note_dust(floor.dust, grains, way, cells)
        grains *= now - burst.last[0]
        note_dirt(floor.grains, floor.way, floor.dirt_place, x, y, grains, way)
    burst.last[0], burst.last[1], burst.last[2] = now, x, y


@inner_part
def told(burst: Any, robot: Any) -> tuple[float, float, float]:
    """Return the true pose, x, y, theta, in the frame in which poses are told."""
    if not burst.is_turned:
        return robot.x, robot.y, robot.theta
    left, bottom, cosine, sine = burst.axes[0], burst.axes[1], burst.axes[2], burst.axes[3]
    return (
        left + cosine * robot.x - sine * robot.y,
        bottom + sine * robot.x + cosine * robot.y,
        wrapped(robot.theta + burst.turn),
    )


@inner_part
def sweep_truth(burst: Any, robot: Any, floor: Floor, x: float, y: float) -> None:
    """Note the floor that the tool really passed over up to a place, while the bin had room."""
    if robot.in_bin >= burst.bin_capacity:
        burst.true_at[0] = burst.true_at[1] = math.nan
        return
    at_x, at_y = swept_from(burst.true_at[0], burst.true_at[1], x, y)
    burst.truth_swept += sweep(floor.true_cells, floor.true_place, at_x, at_y, x, y, floor.radius)
    burst.true_at[0], burst.true_at[1] = x, y


@inner_part
def write_down(
    row: Floats,
    now: float,
    robot: Any,
    belief: Any,
    true: tuple[float, float, float],
    x: float,
    y: float,
    theta: float,
) -> None:
    """Fill a row with the state after a tick."""
    row[TIME] = now
    row[TRUE] = true
    row[BELIEVED] = x, y, theta
    row[ODOMETRY] = robot.odometry_x, robot.odometry_y, robot.odometry_theta
    row[GYRO], row[BIAS] = robot.gyro, belief.bias + belief.calibration.gyro_bias
