"""Making room for what stands in the way: it may be waiting for the robot to go."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.mission import GivingWayConfig
from roomba.geometry import Point, RoundObstacle
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.trail import Trail
from roomba.mission.inputs.senses import Senses
from roomba.planning.frontiers.kernels import ways_from
from roomba.planning.path.planner import NoPathError, PathPlanner


def way_aside(
    planner: PathPlanner,
    senses: Senses,
    obstacles: Obstacles,
    trail: Trail,
    config: GivingWayConfig,
) -> Floats | None:
    """Return a way, float64 [n, 2], m, to where the robot leaves room beside what stands there.

    Where nothing is known to stand beside the robot, the robot leaves the place where it is: what
    stands there may be part of a map that is being made. None when there is no such place.
    """
    here = (senses.pose.x, senses.pose.y)
    standing, at_least = obstacles.standing(senses.now), obstacles.at_least(senses.now)
    around = [(x, y) for x, y, _ in standing if math.dist(here, (x, y)) < config.farthest]
    near = [place for place in around if math.dist(here, place) < config.beside]
    beside = near or [here, *around]
    for things in (standing, at_least):
        points = _way_from(here, planner, things, beside, config)
        if points is not None:
            return points
    points, _ = trail.back_and_on(lambda place: _way_from(place, planner, at_least, beside, config))
    return points


def _way_from(
    start: Point,
    planner: PathPlanner,
    things: Sequence[RoundObstacle],
    beside: list[Point],
    config: GivingWayConfig,
) -> Floats | None:
    frame = planner.frame
    try:
        fits = planner.reachable(start, things)
    except NoPathError:
        return None
    ways = np.empty(frame.shape)
    ways_from(fits, *frame.cell_of(*start), ways)
    rows, columns = np.nonzero(ways * frame.resolution < config.farthest)
    x, y = frame.centres(rows, columns)
    off = np.min([np.hypot(x - at_x, y - at_y) for at_x, at_y in beside], axis=0)
    room = np.minimum(off, config.room)
    best = int(np.argmax(room - config.per_way * frame.resolution * ways[rows, columns]))
    if room[best] < config.least_room:
        return None
    try:
        return planner.plan(start, (float(x[best]), float(y[best])), things).points
    except NoPathError:
        return None
