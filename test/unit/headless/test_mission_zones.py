"""A robot that cleans keeps out of its zones, also of those that are set meanwhile."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.headless_cleans import BODY, assert_all_clean, begun
from fixtures.robots.missions import (
    DEN,
    FLOOR_TOO_LITTLE,
    HOME,
    TWO_ROOMS,
    WALL_X,
    floor_clean,
    two_rooms,
    until,
)

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.headless.records import CleanRecord
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.phases.machine import Errand, MissionState
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.vocabulary import CleanMode, Phase


def zoned(robot: HeadlessMission, *zones: Zone) -> PlanningContext:
    home = robot.simulator.home
    return PlanningContext(
        home.map,
        home.station,
        robot.robot_config,
        robot.config,
        DockingConfig(),
        robot.context.rooms,
        Zones(zones),
    )


def no_go(left: float, bottom: float, right: float, top: float) -> Zone:
    corners = ((left, bottom), (right, bottom), (right, top), (left, top))
    return Zone("rug", ZoneKind.NO_GO, corners)


def inside_by(record: CleanRecord, since: float, area: tuple[float, ...]) -> float:
    """Return how far the body's rim ever came into an area after a time, m."""
    rows = record.poses[record.poses[:, 0] > since]
    dx = np.maximum(np.maximum(area[0] - rows[:, 1], rows[:, 1] - area[2]), 0.0)
    dy = np.maximum(np.maximum(area[1] - rows[:, 2], rows[:, 2] - area[3]), 0.0)
    return BODY - float(np.hypot(dx, dy).min())


@pytest.mark.parametrize(
    "request_", [CleanRequest(CleanMode.SPOT), CleanRequest(CleanMode.ROOMS, rooms=(DEN,))]
)
def test_carried_beyond_a_step_it_cleans_there_and_says_that_no_way_leads_home(
    request_: CleanRequest,
) -> None:
    step = Zones((Zone("step", ZoneKind.WALL, ((WALL_X + 0.05, 0.7), (WALL_X + 0.05, 1.7))),))
    start = Pose(2.8, 1.2, 0.0)
    robot = HeadlessMission(TWO_ROOMS, zones=step, rooms=two_rooms(), start=start)
    robot.mission.clean(request_, robot.senses())
    assert robot.mission.cleaning is not None
    wanted = robot.mission.cleaning.ledger.coverage.wanted.copy()
    until(robot, lambda: bool(robot.mission.message))
    assert robot.mission.message.startswith("no way home: ")
    swept = np.count_nonzero(robot.truth.swept & wanted)
    assert swept >= FLOOR_TOO_LITTLE * np.count_nonzero(wanted) > 0
    result = robot.mission.take_result()
    assert result is not None
    assert (result.outcome, result.message) == (CleanOutcome.NOT_DOCKED, robot.mission.message)


SPECK = 0.01
"""m2."""
AREA = (1.9, 1.5, 3.0, 2.5)


def test_a_zone_from_the_beginning_is_never_entered() -> None:
    robot = HeadlessMission(HOME, zones=Zones((no_go(*AREA),)))
    record = robot.clean()
    assert_all_clean(robot, record)
    assert inside_by(record, 0.0, AREA) < 0.0
    bare = HeadlessMission(HOME).context
    assert record.result.wanted < np.count_nonzero(bare.coverable()) * 1e-4 - 0.9


@pytest.mark.parametrize("after", [20.0, 60.0, 100.0])
def test_a_zone_set_while_it_cleans_is_not_entered_any_more(after: float) -> None:
    robot = begun(after)
    pose = robot.simulator.pose
    # A corner of the room in which it does not stand.
    left, right = (2.0, 3.0) if pose.x < 1.4 else (0.9, 1.4) if pose.y > 1.0 else (0.0, 1.0)
    area = (left, 1.7, right, 2.5) if pose.y < 1.25 else (left, 0.0, right, 0.7)
    robot.mission.use_context(zoned(robot, no_go(*area)))
    since = robot.seen.time
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert inside_by(record, since, area) < 0.002
    floor = zoned(robot, no_go(*area)).coverable()
    assert floor_clean(robot, floor) >= FLOOR_TOO_LITTLE


def test_a_zone_that_is_set_around_it_is_left() -> None:
    robot = begun()
    until(robot, lambda: robot.simulator.pose.x > 2.4)
    pose = robot.simulator.pose
    area = (pose.x - 0.3, pose.y - 0.3, pose.x + 0.3, pose.y + 0.3)
    robot.mission.use_context(zoned(robot, no_go(*area)))
    since = robot.seen.time
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert inside_by(record, since + 10.0, area) < 0.002


def test_a_virtual_wall_before_the_rest_leaves_it_out() -> None:
    robot = begun(10.0, HeadlessMission(TWO_ROOMS))
    wall = Zone("wall", ZoneKind.WALL, ((WALL_X, 0.0), (WALL_X, 2.4)))
    context = zoned(robot, wall)
    robot.mission.use_context(context)
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert record.poses[:, 1].max() < WALL_X
    # What the wall shuts off is not missed; specks may be.
    assert all(each.area < SPECK for each in record.result.missed)
    assert floor_clean(robot, context.coverable()) >= FLOOR_TOO_LITTLE


def test_when_a_zone_leaves_nothing_to_clean_nothing_is_to_go_on_the_way_home() -> None:
    robot = HeadlessMission(TWO_ROOMS)
    mission = robot.mission
    mission.clean(CleanRequest(CleanMode.SPOT, spot=(2.9, 0.7)), robot.senses())
    until(robot, lambda: mission.sweeps and robot.simulator.pose.x > 2.6)
    assert mission.seconds_to_go() > 0.0
    mission.use_context(zoned(robot, no_go(2.2, 0.0, 3.6, 1.4)))
    until(robot, lambda: mission.state.errand is Errand.HOME and mission.driver is not None)
    assert mission.state == MissionState(Phase.RETURNING, Errand.HOME)
    assert mission.seconds_to_go() == 0.0
