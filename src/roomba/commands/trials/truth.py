"""The floor that could truly be cleaned, and that was: by the true home and true poses alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from roomba.arrays import Mask
from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import RoundObstacle
from roomba.grid import FREE, OCCUPIED, OccupancyMap
from roomba.mission.cleaning.stages import stages_of
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import CleanMode
from roomba.world.home.home import Home
from roomba.world.home.raster import covered_cells, footprint


def true_map(home: Home, standing: Mask | None = None) -> OccupancyMap:
    """Return the map of all true solids: things off the map, shut doors and drops included.

    Of things that move by themselves only the ``standing`` cells, bool over the home's grid, count.
    """
    solid = home.solid | home.drop
    if standing is not None:
        solid |= standing
    values = np.where(solid, np.int8(OCCUPIED), np.int8(FREE))
    return OccupancyMap(home.frame, values)


def standing_until(home: Home, ended: float, height: float) -> Mask:
    """Return the cells where what moves stood all the time until ``ended``, s of the day.

    Bool over the home's grid; ``height``, m, is that of the body that meets it. What a delay by
    chance let stand for longer does not count.
    """
    boxes = (
        box
        for thing in home.moving
        if not thing.script.moves or thing.script.moves[0].begins >= ended
        for box in thing.first_boxes
    )
    return covered_cells(home.frame, (footprint(box) for box in boxes if box.bottom < height))


def coverable_floor(
    home: Home,
    context: PlanningContext,
    request: CleanRequest,
    things: Sequence[RoundObstacle],
    robot: RobotConfig,
    mission: MissionConfig,
    docking: DockingConfig,
    ended: float | None = None,
) -> Mask:
    """Return the floor of a request that the tool can truly reach, bool over ``context.frame``.

    ``context`` is the home as the robot knows it: edges are those of its map. If the run has
    ``ended``, s of the day, floor is left out on which a thing stood all that time.
    """
    standing = None if ended is None else standing_until(home, ended, robot.body.height)
    solid = true_map(home, standing)
    truth = PlanningContext(
        solid, home.station, robot, mission, docking, context.rooms, context.zones
    )
    staging = (truth.staging.x, truth.staging.y)
    reachable: Mask = truth.coverage.floor.with_obstacles(list(things)).coverable(staging)
    if not reachable.any():
        return reachable
    dirt = DirtMap(home.map)
    if request.mode is CleanMode.EDGES:
        stages = stages_of(request, context, dirt, context.coverable(), home.station)
    else:
        stages = stages_of(request, truth, dirt, reachable, home.station)
    wanted = np.zeros(truth.frame.shape, np.bool_)
    for stage in stages:
        wanted |= stage.floor
    return wanted & reachable
