"""Other ways over the same floor: our plan as planned, and peers that drive theirs."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.coverage import CoverageConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.geometry import Pose
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.coverage.planner import CoveragePlanner
from roomba.world.home.home import Home
from roomba_bench.coverage.bounce import bounce
from roomba_bench.coverage.floor import (
    Reachable,
    exact_share,
    length,
    share_over_time,
    swept_share,
    turning,
    turning_at_corners,
)
from roomba_bench.coverage.lanes import Order, boustrophedon
from roomba_bench.coverage.peer import PeerRobot
from roomba_bench.ours_sim import ROBOT

CONFIG: Final = CoverageConfig()
BOUNCE: Final = "random bounce"


@dataclass(frozen=True, eq=False)
class Planned:
    """Our plan as it is, before a robot drives it; ``cpu`` s from the map to the way."""

    share: float
    ratio: float
    turning: float
    cpu: float
    points: Floats = field(repr=False)


@dataclass(frozen=True, eq=False)
class Driven:
    """A peer's result: %, way by least way, rad, min; ``poses`` has rows t, x, y, theta."""

    name: str
    coverage: float
    exact: float
    ratio: float
    turning: float
    hits: float
    minutes: float
    is_random: bool
    poses: Floats = field(repr=False)


def context_of(home: Home) -> PlanningContext:
    """Return the home as the robot plans in it."""
    return PlanningContext(
        home.map, home.station, ROBOT, MissionConfig(coverage=CONFIG), DockingConfig()
    )


def planned(home: Home, context: PlanningContext, floor: Reachable, rounds: int) -> Planned:
    """Plan the whole floor as at a clean's start; the best CPU time of several rounds counts."""
    start = (context.staging.x, context.staging.y)
    width, todo = context.coverage.floor.tool_width, context.coverable()
    sharp = ROBOT.tracking.sharp_corner

    def plan() -> CoveragePlan:
        # A planner caches what it knows of the floor, so each round gets a new one.
        planner = CoveragePlanner(context.known, context.reach, width, sharp, CONFIG)
        return planner.plan(start, start, todo)

    made, cpu = plan(), float("inf")
    for _ in range(rounds):
        began = time.process_time()
        made = plan()
        cpu = min(cpu, time.process_time() - began)
    points = made.points
    return Planned(
        swept_share(floor, points),
        length(points) / floor.least_way,
        turning_at_corners(points),
        cpu,
        points,
    )


def drive_lanes(home: Home, start: Pose, floor: Reachable, order: Order) -> Driven:
    """Plan lanes on what the map shows, and drive them."""
    way = boustrophedon(home.map.solid | home.drop, home.frame, (start.x, start.y), order)
    robot = PeerRobot(home, start)
    robot.follow(way)
    return _driven(name_of(order), floor, robot)


def name_of(order: Order) -> str:
    """Return a peer's name in the table."""
    return f"boustrophedon, {order.value}"


def drive_bounce(home: Home, start: Pose, floor: Reachable, seconds: float, seed: int) -> Driven:
    """Bounce about for a while."""
    robot = PeerRobot(home, start, seed)
    bounce(robot, seconds, seed)
    return _driven(BOUNCE, floor, robot)


def shares_at(floor: Reachable, poses: Floats, minutes: tuple[int, ...]) -> list[float]:
    """Return the swept share after so many minutes each, or at the end if that is earlier."""
    shares = share_over_time(floor, poses[:, 1:3])
    at = np.searchsorted(poses[:, 0] - poses[0, 0], 60.0 * np.array(minutes), "right") - 1
    return [float(share) for share in shares[at]]


def _driven(name: str, floor: Reachable, robot: PeerRobot) -> Driven:
    poses = robot.poses
    return Driven(
        name,
        100.0 * swept_share(floor, poses[:, 1:3]),
        100.0 * exact_share(floor, poses[:, 1:3]),
        length(poses[:, 1:3]) / floor.least_way,
        turning(poses[:, 3]),
        float(robot.hits),
        (poses[-1, 0] - poses[0, 0]) / 60.0,
        name == BOUNCE,
        poses,
    )
