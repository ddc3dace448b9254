"""The results of whole cleans that can reach only a part, or nothing, of the wanted floor."""

from __future__ import annotations

import re

import pytest
from fixtures.robots.missions import DEN, HALL, TWO_ROOMS, shut_door, two_rooms
from fixtures.thoroughness import core_first

from roomba.clean_request import CleanRequest
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome, CleanResult, MissReason
from roomba.vocabulary import CleanMode
from roomba.world.layers.layer import load_home


def cleaned(*rooms: str) -> CleanResult:
    """Return what becomes of rooms while the door between them is shut."""
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms())
    shut_door(robot)
    result = robot.clean(CleanRequest(CleanMode.ROOMS, rooms=rooms)).result
    assert robot.is_home
    assert result.outcome is CleanOutcome.COMPLETED
    return result


def test_a_room_behind_a_shut_door_is_not_just_completed() -> None:
    result = cleaned(DEN)
    assert result.fraction < 0.02
    assert "could be reached: a door is shut" in result.message
    assert result.missed[0].reason is MissReason.SHUT
    assert result.missed[0].room == DEN


def test_with_another_room_done_the_message_names_the_one_that_is_not() -> None:
    result = cleaned(DEN, HALL)
    assert re.match(r"not clean: \d\.\d m² of den \(no way leads there", result.message)
    assert result.missed[0].reason is MissReason.SHUT


@pytest.mark.parametrize("seed", core_first([1, 2], {1}))
def test_down_the_stairs_the_floor_ends(seed: int) -> None:
    config = SimulatedRobotConfig()
    home = load_home("family", HOMES, config.body)
    robot = HeadlessMission(home, config, seed=seed)
    result = robot.clean().result
    assert result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    down = [each for each in result.missed if each.reason is MissReason.EDGE]
    (stairs,) = home.stairs
    assert sum(each.area for each in down) > 0.9
    for each in down:
        assert stairs.x_min < each.x < stairs.x_max
        assert stairs.y_min < each.y < stairs.y_max
    others = [each for each in result.missed if each.reason is not MissReason.EDGE]
    assert {each.reason for each in others} <= {MissReason.THING, MissReason.LEFT_OVER}
