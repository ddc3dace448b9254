"""How dirty each room was that a clean swept."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.missions import DEN, HALL, TWO_ROOMS, WALL_X, two_rooms

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.room_dirt import dirt_of_rooms
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import CleanMode

CONTEXT = PlanningContext(
    TWO_ROOMS.map,
    TWO_ROOMS.station,
    RobotConfig(),
    MissionConfig(),
    DockingConfig(),
    rooms=two_rooms(),
)


def test_each_room_has_what_was_counted_there() -> None:
    dirt = DirtMap(TWO_ROOMS.map)
    for x in np.arange(0.3, 3.4, 0.2).tolist():
        for y in np.arange(0.3, 2.2, 0.2).tolist():
            # 0.2 m of way over cells of 0.2 m, with 8 grains in the hall and 2 in the den.
            dirt.note(x, y, 8.0 if x < WALL_X else 2.0, 0.2)
    clean = CONTEXT.coverable() & CONTEXT.in_room(HALL)
    (hall,) = dirt_of_rooms(clean, CONTEXT, dirt)
    assert (hall.room, hall.share) == (HALL, 1.0)
    assert hall.grains == pytest.approx(8.0 / 0.04, rel=0.01)
    found = dirt_of_rooms(CONTEXT.coverable(), CONTEXT, dirt)
    den = next(each for each in found if each.room == DEN)
    assert den.grains == pytest.approx(2.0 / 0.04, rel=0.1)


def test_without_rooms_or_swept_floor_there_is_nothing_to_tell() -> None:
    dirt = DirtMap(TWO_ROOMS.map)
    assert dirt_of_rooms(np.zeros(CONTEXT.frame.shape, np.bool_), CONTEXT, dirt) == ()


def test_a_clean_tells_of_the_rooms_that_it_swept() -> None:
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms(), seed=4)
    result = robot.clean(CleanRequest(CleanMode.ROOMS, rooms=(DEN,))).result
    shares = {each.room: each.share for each in result.rooms}
    assert shares[DEN] > 0.98
    assert shares.get(HALL, 0.0) < 0.5
