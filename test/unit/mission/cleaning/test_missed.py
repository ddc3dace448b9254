"""Floor that is not clean: its patches, and the reasons that are reported."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.missions import DEN, HALL, HOME, TWO_ROOMS, WALL_X, two_rooms
from numpy.typing import NDArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import RoundObstacle
from roomba.mission.cleaning.missed import is_hidden, missed_floor, what_is_not_clean
from roomba.mission.cleaning.result import Missed, MissReason
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.coverage_map import patches_of

CONTEXT = PlanningContext(
    TWO_ROOMS.map, TWO_ROOMS.station, RobotConfig(), MissionConfig(), DockingConfig(), two_rooms()
)
FENCE: list[RoundObstacle] = [(WALL_X + 0.05, float(y), 0.05) for y in np.arange(0.85, 1.6, 0.1)]
"""Across the doorway."""
IN_THE_HALL: RoundObstacle = (0.9, 2.0, 0.05)


def den() -> NDArray[np.bool_]:
    floor: NDArray[np.bool_] = CONTEXT.coverable() & CONTEXT.in_room(DEN)
    # Without the doorway, where the fence stands.
    floor[:, : CONTEXT.frame.cell_of(WALL_X + 0.4, 0.0)[1]] = False
    return floor


def reason(
    obstacles: list[RoundObstacle], edges: list[RoundObstacle], *, is_over: bool = True
) -> MissReason:
    (missed,) = missed_floor(den(), 0.01, CONTEXT, obstacles, edges, is_over=is_over)
    assert missed.room == DEN
    assert missed.area == pytest.approx(np.count_nonzero(den()) * CONTEXT.frame.resolution**2)
    return missed.reason


@pytest.mark.parametrize("is_over", [False, True])
def test_a_room_behind_a_door_is_shut_and_behind_stairs_the_floor_ends(is_over: bool) -> None:
    assert reason(FENCE, [], is_over=is_over) is MissReason.SHUT
    assert reason(FENCE, FENCE, is_over=is_over) is MissReason.EDGE


def test_an_edge_elsewhere_shuts_no_door() -> None:
    assert reason([*FENCE, IN_THE_HALL], [IN_THE_HALL]) is MissReason.SHUT


def test_what_can_be_reached_is_left_over_or_was_not_its_turn() -> None:
    assert reason([], []) is MissReason.LEFT_OVER
    assert reason([], [], is_over=False) is MissReason.STOPPED
    assert reason([IN_THE_HALL], [IN_THE_HALL]) is MissReason.LEFT_OVER


def test_a_strip_of_single_cells_along_a_swath_is_no_place_that_was_missed() -> None:
    row, column = CONTEXT.frame.cell_of(0.9, 1.0)
    left = np.zeros(CONTEXT.frame.shape, np.bool_)
    left[row, column : column + 60] = True
    left[row : row + 60, column] = True
    assert missed_floor(left, 0.004, CONTEXT, [], [], is_over=True) == ()
    left[row + 1, column + 30 : column + 32] = True
    (missed,) = missed_floor(left, 0.004, CONTEXT, [], [], is_over=True)
    assert missed.area == pytest.approx(np.count_nonzero(left) * CONTEXT.frame.resolution**2)


def test_next_to_a_thing_it_is_that_thing_and_next_to_an_edge_the_floor_ends() -> None:
    x, y, _ = IN_THE_HALL
    rows, columns = np.indices(CONTEXT.frame.shape)
    row, column = CONTEXT.frame.cell_of(x, y)
    near = np.hypot(rows - row, columns - column) * CONTEXT.frame.resolution < 0.08
    assert is_hidden(patches_of(near, CONTEXT.frame, 0.0)[0], CONTEXT, [IN_THE_HALL])
    for edges, expected in (([], MissReason.THING), ([IN_THE_HALL], MissReason.EDGE)):
        (missed,) = missed_floor(near, 0.01, CONTEXT, [IN_THE_HALL], edges, is_over=True)
        assert missed.reason is expected


def test_only_patches_that_are_large_enough_are_told_the_largest_first() -> None:
    left = np.zeros(CONTEXT.frame.shape, np.bool_)
    for x, size in ((0.6, 2), (1.0, 12), (1.4, 20)):
        row, column = CONTEXT.frame.cell_of(x, 1.0)
        left[row : row + size, column : column + size] = True
    areas = [each.area for each in missed_floor(left, 0.01, CONTEXT, [], [], is_over=True)]
    assert areas == pytest.approx([0.04, 0.0144])


def test_all_clean_there_is_nothing_to_tell() -> None:
    assert (
        missed_floor(np.zeros(CONTEXT.frame.shape, np.bool_), 0.01, CONTEXT, [], [], is_over=True)
        == ()
    )
    assert what_is_not_clean(4.0, 0.0, ()) == ""


@pytest.mark.parametrize(
    ("why", "message"),
    [
        (MissReason.SHUT, "nothing of it could be reached: a door is shut"),
        (MissReason.THING, "nothing of it could be reached: something stands there"),
        (MissReason.EDGE, "nothing of it could be reached: the floor ends there"),
        (MissReason.LEFT_OVER, "nothing of it is clean: it was passed"),
    ],
)
def test_nothing_done_it_says_so_and_why(why: MissReason, message: str) -> None:
    missed = (Missed(4.0, 1.0, 1.0, "", why), Missed(0.1, 1.0, 1.0, "", MissReason.STOPPED))
    assert what_is_not_clean(4.1, 0.0, missed).startswith(message)
    assert what_is_not_clean(4.1, 0.04, missed).startswith(message.replace("nothing", "hardly any"))


def test_what_was_left_out_is_told_by_room_and_reason_the_largest_first() -> None:
    missed = (
        Missed(3.0, 1.0, 1.0, "Kitchen", MissReason.SHUT),
        Missed(0.5, 2.0, 1.0, "Hall", MissReason.THING),
        Missed(0.7, 3.0, 1.0, "Kitchen", MissReason.SHUT),
        Missed(0.9, 3.0, 1.0, "", MissReason.LEFT_OVER),
    )
    assert what_is_not_clean(20.0, 14.9, missed) == (
        f"not clean: 3.7 m² of Kitchen ({MissReason.SHUT.value}), "
        f"0.9 m² ({MissReason.LEFT_OVER.value}), 0.5 m² of Hall ({MissReason.THING.value})"
    )
    many = tuple(Missed(1.0, 0.0, 0.0, f"Room {n}", MissReason.SHUT) for n in range(7))
    assert what_is_not_clean(20.0, 13.0, many).endswith(" and 3 more places")
    assert what_is_not_clean(20.0, 13.0, many[:5]).endswith(" and 1 more place")


def test_a_little_that_was_left_out_needs_no_words() -> None:
    missed = (Missed(0.3, 1.0, 1.0, "Kitchen", MissReason.THING),)
    assert what_is_not_clean(20.0, 19.7, missed) == ""
    assert what_is_not_clean(20.0, 20.0, ()) == ""


def test_of_a_home_without_rooms_patches_have_no_room() -> None:
    context = PlanningContext(
        HOME.map, HOME.station, RobotConfig(), MissionConfig(), DockingConfig()
    )
    (missed,) = missed_floor(context.coverable(), 0.01, context, [], [], is_over=True)
    assert missed.room == ""


def test_floor_missed_in_two_rooms_is_told_of_each() -> None:
    floor = CONTEXT.coverable()
    told = missed_floor(floor, 0.01, CONTEXT, [], [], is_over=False)
    area = {room: sum(each.area for each in told if each.room == room) for room in (HALL, DEN)}
    for room in (HALL, DEN):
        cells = np.count_nonzero(floor & CONTEXT.in_room(room))
        assert area[room] == pytest.approx(cells * CONTEXT.frame.resolution**2)
    assert [each.area for each in told] == sorted((each.area for each in told), reverse=True)


def test_a_small_patch_in_a_doorway_is_told_once() -> None:
    rooms = CONTEXT.fine(CONTEXT.rooms.labels) if CONTEXT.rooms is not None else np.zeros(0)
    border = int(np.argmax(rooms[CONTEXT.frame.cell_of(0.0, 1.2)[0]] != rooms[0, 40]))
    left = np.zeros(CONTEXT.frame.shape, np.bool_)
    row = CONTEXT.frame.cell_of(0.0, 1.2)[0]
    left[row : row + 10, border - 5 : border + 5] = True
    (missed,) = missed_floor(left, 0.008, CONTEXT, [], [], is_over=True)
    assert missed.area == pytest.approx(0.01)
