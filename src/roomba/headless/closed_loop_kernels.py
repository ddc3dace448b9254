"""The closed loop compiled: the world, the localizer and the tracker, tick by tick.

It does what :meth:`roomba.headless.cleaner.HeadlessMission.tick` does while nothing comes up, with
the same functions, and stops as soon as something does.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.control.tracking_kernels import Course, track
from roomba.perception.localization.belief_correct_kernels import correct, is_calm
from roomba.perception.localization.belief_reckon_kernels import reckon
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.swept.coverage_kernels import sweep
from roomba.perception.swept.dirt_map import note_dirt
from roomba.perception.things.kernels import Things, note
from roomba.world.engine.lidar.projection import ScanBuffers
from roomba.world.engine.state.arrays import State
from roomba.world.engine.step_kernels import advance

Floats = NDArray[np.float64]
Rows = NDArray[np.void]

DRIVE: Final = [
    ("limit", "f8"),  # m/s
    ("clear_to", "f8"),  # m along the path
    ("most_aside", "f8"),  # m
    ("step", "f8"),  # s of the world
    ("steps", "i8"),  # of the world in a tick
    ("every", "i8"),  # so many scans until one is used
    ("scans", "i8"),  # seen so far
    ("last_x", "f8"),  # believed, at the tick before
    ("last_y", "f8"),
    ("way", "f8"),  # driven, as believed
    ("things_version", "i8"),  # of what is known to stand in the way
]
"""What a row of any such loop has for driving."""

LOOP: Final = np.dtype(
    [
        *DRIVE,
        ("sweeps", "f8"),  # 1 if what is driven over counts
        ("swept", "i8"),  # wanted cells that became clean
        ("truth_swept", "i8"),
        ("true_x", "f8"),
        ("true_y", "f8"),
        ("seen", "f8"),  # time of the last scan, -1 if there was none
    ]
)
"""State and numbers of the loop, one row."""


class World(NamedTuple):
    """The simulated one, of one robot."""

    state: State
    numbers: Rows
    quantiles: NDArray[np.float32]
    buffers: ScanBuffers


class Belief(NamedTuple):
    """The localizer, and what it sees that the map does not show."""

    belief: Rows
    numbers: Rows
    field: NDArray[np.float32]
    place: Floats
    beams: LidarBeams
    things: Things


class Track(NamedTuple):
    """The tracker and its path."""

    state: Rows
    course: Course


class Floor(NamedTuple):
    """What is cleaned as the robot believes and in truth, and how dirty it was."""

    cells: NDArray[np.uint8]
    true_cells: NDArray[np.uint8]
    place: Floats
    radius: float
    grains: NDArray[np.float32]
    way: NDArray[np.float32]
    dirt_place: Floats


@njit(cache=True, nogil=True, error_model="numpy")
def run(
    loops: Rows, world: World, belief: Belief, tracks: Track, floor: Floor, rows: Floats
) -> int:
    """Let ticks pass until something comes up, or ``rows`` [n, 4] is full; return how many.

    ``rows`` are filled with t (s), x, y (m) and theta (rad), the true ones.
    """
    loop: Any = loops[0]
    robot: Any = world.state.solid.robots[0]
    known: Any = belief.belief[0]
    period = loop.step * loop.steps
    ticks = rows.shape[0]
    for tick in range(rows.shape[0]):
        x, y, theta = known.pose[0], known.pose[1], known.pose[2]
        account(loop, robot, floor, x, y, period)
        now = drive(loop, world, tracks, x, y, theta)
        localize(loop, world, belief, now)
        sweep_truth(loop, robot, floor)
        rows[tick, 0], rows[tick, 1], rows[tick, 2] = now, robot.x, robot.y
        rows[tick, 3] = robot.theta
        if something_comes_up(loop, robot, tracks, belief.things) or not is_calm(
            belief.belief, belief.numbers, now
        ):
            ticks = tick + 1
            break
    account(loop, robot, floor, known.pose[0], known.pose[1], period)
    return ticks


@njit(cache=True, nogil=True, error_model="numpy")
def drive(loop: Any, world: World, tracks: Track, x: float, y: float, theta: float) -> float:
    """Let a tick pass, driving along the path from where it takes itself to be; return the time."""
    robot: Any = world.state.solid.robots[0]
    linear, angular = track(tracks.state[0], tracks.course, x, y, theta, loop.limit)
    robot.wanted_linear, robot.wanted_angular = linear, angular
    advance(world.state, 0, 1, world.numbers, world.quantiles, world.buffers, loop.step, loop.steps)
    return float(world.state.worlds[0].time)


@njit(cache=True, nogil=True, error_model="numpy")
def something_comes_up(loop: Any, robot: Any, tracks: Track, things: Things) -> bool:
    """Tell whether the drive is for the ordinary classes from here on."""
    tracker: Any = tracks.state[0]
    along = tracks.course.stations[tracker.leg] + tracker.along
    return bool(
        is_touched(robot)
        or tracker.done > 0.0
        or along >= loop.clear_to
        or abs(tracker.aside) > loop.most_aside
        or things.layer[0].version != loop.things_version
    )


@njit(cache=True, nogil=True, error_model="numpy")
def account(loop: Any, robot: Any, floor: Floor, x: float, y: float, period: float) -> None:
    """Note the way, and what floor was cleaned on it."""
    way = math.hypot(x - loop.last_x, y - loop.last_y)
    loop.way += way
    if loop.sweeps > 0.0:
        loop.swept += sweep(floor.cells, floor.place, loop.last_x, loop.last_y, x, y, floor.radius)
        grains = robot.grains * period
        note_dirt(floor.grains, floor.way, floor.dirt_place, x, y, grains, way)
    loop.last_x, loop.last_y = x, y


@njit(cache=True, nogil=True, error_model="numpy")
def localize(loop: Any, world: World, belief: Belief, now: float) -> None:
    """Go on by wheels and gyro, and correct that by every so many scans."""
    robot: Any = world.state.solid.robots[0]
    reckon(
        belief.belief,
        belief.numbers,
        now,
        robot.odometry_x,
        robot.odometry_y,
        robot.odometry_theta,
        robot.gyro,
    )
    if robot.scans == loop.scans:
        return
    loop.scans, loop.seen = robot.scans, now
    if loop.scans % loop.every != 0:
        return
    ranges = world.state.ranges[0]
    ended = correct(
        belief.belief, belief.numbers, belief.field, belief.place, belief.beams, ranges, now
    )
    note(
        belief.things,
        belief.field,
        belief.place,
        belief.beams,
        ranges,
        ended,
        belief.belief[0].pose,
        loop.every,
    )


@njit(cache=True, nogil=True, error_model="numpy")
def sweep_truth(loop: Any, robot: Any, floor: Floor) -> None:
    """Note what floor the tool really passed over."""
    loop.truth_swept += sweep(
        floor.true_cells, floor.place, loop.true_x, loop.true_y, robot.x, robot.y, floor.radius
    )
    loop.true_x, loop.true_y = robot.x, robot.y


@njit(cache=True, nogil=True, error_model="numpy")
def is_touched(robot: Any) -> bool:
    """Tell whether anything touches the robot, or is missing below it."""
    return bool(
        robot.bumper_left
        + robot.bumper_right
        + robot.cliff_left
        + robot.cliff_front_left
        + robot.cliff_front_right
        + robot.cliff_right
        + robot.drop_left
        + robot.drop_right
        + robot.docked
        > 0.0
    )
