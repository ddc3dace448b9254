"""Loads or compiles all that a clean needs, by cleaning a closet; a clean is timed alone then."""

from __future__ import annotations

import argparse
import functools

import numpy as np

from roomba.commands.compiling import compiled_functions_told
from roomba.commands.trials.unreached import unreached_in
from roomba.configuration.coverage import CoverageConfig
from roomba.configuration.loops import TrackingConfig
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.headless.burst import LONGEST_BURST
from roomba.headless.mission import HeadlessMission
from roomba.headless.odometry import reckoned
from roomba.perception.swept.coverage_kernels import missed_of
from roomba.perception.swept.visits import Visits
from roomba.planning.coverage.stages import OUR_STAGES
from roomba.world.home.home import DirtSource, Home


@functools.cache
def warm_up() -> None:
    """Clean it once in this process, with a thing on the floor that the map does not show."""
    robot = HeadlessMission(closet())
    robot.simulator.place_obstacle(1.9, 0.45, 0.05)
    robot.clean()
    _look_back(robot)


def _look_back(robot: HeadlessMission) -> None:
    """Call what pages and reports need of a clean."""
    rows = robot.passed
    reckoned(rows, robot.robot_config, None)
    visits = Visits(robot.context.frame, robot.context.tool_width)
    visits.sweep_all(np.ascontiguousarray(rows[:, :3]))
    missed_of(visits.counts, visits.counts > 0)
    unreached_in(robot.context)


def closet() -> Home:
    """Return a home of 2.6 x 1.6 m with a box in it."""
    frame = GridFrame(0.05, 0.0, 0.0, 36, 56)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    values[20:24, 30:36] = OCCUPIED
    solid = values != FREE
    return Home(
        "closet",
        OccupancyMap(frame, values),
        solid=solid,
        walls=solid,
        station=Pose(0.30, 0.90, np.pi),
        dirt_sources=(DirtSource("dust", 1.2, 0.8, 0.3, 1.0, 0.0),),
    )


def warm_up_half(longest_burst: int) -> None:
    """Walk, then clean it, with bursts of so many ticks; with 0, tick by tick as nodes do.

    A function that two processes compile at the same time is compiled twice. So this half walks
    first, as :mod:`roomba.commands.warm_up`, which may run beside it, plans first. Then it does the
    last stages of a plan, to which the other process comes last. The burst, the largest loop of
    all, comes last; one of these stages is left out for it, so that both halves take equally long.
    """
    robot = HeadlessMission(closet(), longest_burst=longest_burst)
    robot.walk(0.9, 0.9)
    _finish_a_plan(is_polished=not longest_burst)
    robot.clean()


def _finish_a_plan(*, is_polished: bool) -> None:
    """Do the last stages of planning, on a zigzag over free floor."""
    floor, config = np.ones((40, 40), np.bool_), CoverageConfig()
    way = np.array([[5.0, 5.0], [30.0, 5.0], [30.0, 12.0], [5.0, 12.0]])
    if is_polished:
        way = OUR_STAGES.polish(way, floor, floor, 3.5, config)
    OUR_STAGES.rounding(way, floor, floor, 3.5, TrackingConfig().sharp_corner, config)


if __name__ == "__main__":
    halves = {"ticks": 0, "bursts": LONGEST_BURST}
    parser = argparse.ArgumentParser(description="Compile what a clean needs.")
    parser.add_argument("half", nargs="?", choices=halves)
    half = parser.parse_args().half
    with compiled_functions_told():
        warm_up() if half is None else warm_up_half(halves[half])
