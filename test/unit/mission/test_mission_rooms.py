"""Rooms that are changed while a clean is under way, in whole cleans."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.headless_cleans import assert_all_clean
from fixtures.robots.missions import (
    DEN,
    FLOOR_TOO_LITTLE,
    HALL,
    TWO_ROOMS,
    floor_clean,
    in_phase,
    two_rooms,
    until,
    wait,
)

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.commands import CommandRefusedError
from roomba.mission.phases.machine import Event
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.vocabulary import CleanMode, EdgeOrder, Phase, RoomWay


def begun(*rooms: str, passes: int = 1, edges: EdgeOrder = EdgeOrder.ANY) -> HeadlessMission:
    """A robot that has cleaned for twenty seconds."""
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms(), seed=2)
    request = CleanRequest(CleanMode.ROOMS, rooms=rooms, in_order=True, passes=passes, edges=edges)
    robot.mission.clean(request, robot.senses())
    until(robot, in_phase(robot, Phase.CLEANING))
    wait(robot, 20.0)
    assert robot.mission.queue == rooms
    return robot


def test_a_room_is_added_while_it_cleans() -> None:
    robot = begun(HALL)
    driver = robot.mission.driver
    robot.mission.change_rooms((HALL, DEN))
    # The present room goes on as it was planned.
    assert robot.mission.driver is driver
    assert robot.mission.queue == (HALL, DEN)
    assert_all_clean(robot, robot.run())
    assert robot.mission.queue == ()


def test_a_room_is_left_out() -> None:
    robot = begun(HALL, DEN)
    robot.mission.change_rooms((HALL,))
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert record.result.fraction >= FLOOR_TOO_LITTLE
    assert record.result.missed == ()
    assert floor_clean(robot, robot.context.in_room(DEN)) < 0.5


def test_the_present_room_may_come_later_and_nothing_of_it_is_swept_twice() -> None:
    robot = begun(HALL, DEN)
    swept = robot.truth.swept.copy()
    robot.mission.change_rooms((DEN, HALL))
    assert robot.mission.driver is None
    until(robot, lambda: robot.mission.queue == (HALL,))
    assert floor_clean(robot, robot.context.in_room(DEN)) >= FLOOR_TOO_LITTLE
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    hall = robot.context.in_room(HALL) & robot.context.coverable()
    left = cleaning.ledger.left / cleaning.ledger.coverage.cell_area
    assert left < np.count_nonzero(hall) - 0.8 * np.count_nonzero(hall & swept)
    assert_all_clean(robot, robot.run())


def test_the_present_room_may_be_left_out() -> None:
    robot = begun(HALL, DEN)
    robot.mission.change_rooms((DEN,))
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert record.result.missed == ()
    assert floor_clean(robot, robot.context.in_room(DEN)) >= FLOOR_TOO_LITTLE
    assert floor_clean(robot, robot.context.in_room(HALL)) < 0.9


def test_passes_of_a_room_that_is_added_are_its_own() -> None:
    robot = begun(HALL)
    robot.mission.change_rooms((HALL, DEN), (RoomWay(1), RoomWay(2)))
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    assert [stage.name for stage in cleaning.ledger.stages] == [HALL, DEN, DEN]
    assert robot.mission.queue_ways == (RoomWay(1), RoomWay(2))


def test_a_killed_robot_goes_on_with_the_rooms_as_they_were_changed() -> None:
    robot = begun(HALL, DEN)
    robot.mission.change_rooms((DEN,))
    kept = robot.mission.checkpoint(robot.senses())
    assert kept is not None
    again = HeadlessMission(TWO_ROOMS, rooms=two_rooms(), start=robot.seen.pose)
    again.mission.restore(kept, again.senses())
    assert again.mission.queue == (DEN,)
    assert again.run().result.outcome is CleanOutcome.COMPLETED


def test_what_cannot_be_is_refused_and_nothing_changes() -> None:
    robot = begun(HALL)
    for wrong in (("attic",), (), (HALL, HALL)):
        with pytest.raises(CleanRefusedError):
            robot.mission.change_rooms(wrong)
    assert robot.mission.queue == (HALL,)
    robot.mission.command(Event.EMERGENCY, robot.senses(), "a child")
    with pytest.raises(CommandRefusedError, match=r"rooms now.*emergency stop \(a child\)"):
        robot.mission.change_rooms((DEN,))
    assert robot.mission.queue == (HALL,)
    robot.mission.command(Event.RELEASE, robot.senses())
    robot.mission.command(Event.RESUME, robot.senses())
    until(robot, in_phase(robot, Phase.RETURNING))
    with pytest.raises(CleanRefusedError, match="goes home"):
        robot.mission.change_rooms((DEN,))
    robot.mission.command(Event.STOP, robot.senses())
    with pytest.raises(CommandRefusedError, match="under way, got none"):
        robot.mission.change_rooms((DEN,))
    robot.mission.clean(CleanRequest(), robot.senses())
    with pytest.raises(CleanRefusedError, match="mode whole"):
        robot.mission.change_rooms((DEN,))


@pytest.mark.parametrize("rooms", [(HALL, DEN), (DEN, HALL)])
def test_from_room_to_room_it_goes_through_the_middle_of_the_door(rooms: tuple[str, str]) -> None:
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms(), seed=2)
    record = robot.clean(CleanRequest(CleanMode.ROOMS, rooms=rooms, in_order=True))
    assert_all_clean(robot, record)
    assert record.hits == 0


@pytest.mark.parametrize("edges", [EdgeOrder.FIRST, EdgeOrder.LAST])
def test_edges_and_middle_of_a_room_are_both_cleaned_when_another_one_is_added(
    edges: EdgeOrder,
) -> None:
    robot = begun(HALL, edges=edges)
    robot.mission.change_rooms((HALL, DEN))
    assert_all_clean(robot, robot.run())
    assert floor_clean(robot, robot.context.in_room(HALL)) >= FLOOR_TOO_LITTLE


def test_a_room_that_is_renamed_meanwhile_is_cleaned_by_its_new_name() -> None:
    robot = begun(HALL, DEN)
    robot.brain.use_rooms(two_rooms().renamed(HALL, "corridor"), robot.context.zones)
    assert robot.mission.queue == ("corridor", DEN)
    robot.mission.change_rooms((DEN, "corridor"))
    values = robot.mission.checkpoint(robot.senses())
    assert values is not None
    again = HeadlessMission(TWO_ROOMS, rooms=two_rooms().renamed(HALL, "corridor"), seed=2)
    again.mission.restore(values, again.senses())
    assert again.mission.queue == (DEN, "corridor")
    assert_all_clean(robot, robot.run())


def test_rooms_that_are_joined_or_forgotten_meanwhile_are_cleaned_all_the_same() -> None:
    for rooms in (two_rooms().joined(DEN, HALL), None):
        robot = begun(HALL, DEN)
        robot.brain.use_rooms(rooms, robot.context.zones)
        assert_all_clean(robot, robot.run())


def test_a_newer_clean_knows_nothing_of_the_path_of_the_older_one() -> None:
    robot = begun(HALL, DEN)
    robot.mission.clean(CleanRequest(), robot.senses())
    assert robot.mission.cleaning is not None
    assert robot.mission.cleaning.broken_off == 0.0


def test_a_zone_over_all_floor_that_is_taken_away_again_ends_no_clean() -> None:
    robot = begun(HALL, DEN)
    rooms, corners = robot.context.rooms, ((0.0, 0.0), (3.6, 0.0), (3.6, 2.4), (0.0, 2.4))
    robot.brain.use_rooms(rooms, Zones((Zone("all", ZoneKind.NO_GO, corners),)))
    wait(robot, 2.0)
    assert robot.mission.state.phase is Phase.RETURNING
    robot.brain.use_rooms(rooms, Zones())
    assert robot.mission.state.phase is Phase.CLEANING
    assert_all_clean(robot, robot.run())
