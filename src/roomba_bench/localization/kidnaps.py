"""Carries the robot away: how long until it knows its pose again, and whether it errs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from roomba.geometry import Twist
from roomba.perception.localization.estimate import Knowledge
from roomba.robot.look_around import SearchDrive
from roomba.world.engine.state.arrays import Fault
from roomba_bench.localization.drive import Wander
from roomba_bench.localization.robot import (
    WRONG,
    LocalizedRobot,
    Spots,
    home_named,
    put_anywhere,
    stand_things,
)

TIME = 30.0
"""s; a longer try counts as failed."""
THINGS = 12
"""Round things that stand about on a changed floor."""
_RIGHT, _RIGHT_TURN = 0.10, 0.1
"""m, rad; the largest error of a pose that counts as right."""
_HELD = 20
"""Ticks in the air."""
_AFTER = 2.0
"""s for which the robot is still watched after it has found itself."""
_SETTLING = 6
"""Ticks between two tries."""


class Manner(Enum):
    """How the robot is carried away."""

    LIFTED = "lifted and put elsewhere"
    """Its wheels drop, so it knows that it was carried."""
    SILENT = "carried away unnoticed"
    """No sensor notices; only the scans no longer fit."""
    AMONG_THINGS = f"lifted and put among {THINGS} unknown things"
    """As the first, among round things of 0.1 to 0.3 m that the map does not show."""


@dataclass(frozen=True)
class Task:
    """So many tries in a row in a home; ``folder`` as of a drive's task."""

    home: str
    manner: Manner
    seed: int
    tries: int
    folder: str = ""


@dataclass(frozen=True)
class Try:
    """The result of one try: s until the pose was known, and until it was unknown; or infinite.

    ``is_wrong`` tells whether the robot ever called a wrong pose known. If it was carried away
    unnoticed, only the time after it noticed counts.
    """

    found: float
    noticed: float
    is_wrong: bool


def kidnap(task: Task) -> list[Try]:
    """Make the tries."""
    random = np.random.default_rng(task.seed)
    home = home_named(task.home, task.folder)
    robot = LocalizedRobot(home, task.seed)
    wander = Wander(random)
    spots = Spots(home, robot.config.body.radius)
    tries = []
    for _ in range(task.tries):
        _carry(robot, task.manner, spots, random)
        tries.append(_watch(robot, task.manner, wander))
        if robot.is_off(_RIGHT, _RIGHT_TURN) or not robot.is_known:
            robot.localizer.told(robot.seen.pose, (0.05, 0.05))
        for _ in range(_SETTLING):
            robot.tick(Twist())
    return tries


def _carry(
    robot: LocalizedRobot, manner: Manner, spots: Spots, random: np.random.Generator
) -> None:
    simulator = robot.simulator
    if manner is Manner.AMONG_THINGS:
        simulator.remove_obstacles()
        stand_things(simulator, spots, THINGS, random)
    if manner is Manner.SILENT:
        put_anywhere(simulator, spots, random)
        return
    simulator.inject(Fault.LIFTED, 1.0)
    for _ in range(_HELD):
        robot.tick(Twist())
    put_anywhere(simulator, spots, random)
    simulator.inject(Fault.LIFTED, 0.0)


def _watch(robot: LocalizedRobot, manner: Manner, wander: Wander) -> Try:
    """Let it look around as it wants to, or go about, until it has known its pose for a while."""
    search = SearchDrive(robot.config.body, robot.config.looking_around)
    start = robot.simulator.time
    found = noticed = math.inf
    is_wrong = False
    twist = Twist()
    while robot.simulator.time - start < min(TIME, found + _AFTER):
        robot.tick(twist)
        seen, knowledge = robot.seen, robot.localizer.estimate.knowledge
        is_known, passed = knowledge is Knowledge.KNOWN, seen.time - start
        is_right = is_known and not robot.is_off(_RIGHT, _RIGHT_TURN)
        if is_right:
            found = min(found, passed)
        if is_right or not is_known:
            noticed = min(noticed, passed)
        elif robot.is_off(WRONG, WRONG):
            is_wrong |= manner is not Manner.SILENT or noticed < math.inf
        looking = search.tick(seen.time, robot.localizer, robot.touches)
        if looking is not None:
            twist = looking
        elif knowledge.is_usable:
            twist = wander.tick(seen.time, seen.odometry.theta, robot.ranges, robot.touches)
        else:
            twist = Twist()
    return Try(found, noticed, is_wrong)
