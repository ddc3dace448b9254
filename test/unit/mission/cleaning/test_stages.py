"""The parts of a clean, against all cells of the floor looked at one by one."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.missions import DEN, HALL, HOME, TWO_ROOMS, WALL_X, two_rooms

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.cleaning.stages import Stage, stages_of
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import CleanMode, RoomWay
from roomba.world.home.home import Home

HERE = Pose(0.85, 1.2, 0.0)


def context(home: Home = TWO_ROOMS) -> PlanningContext:
    rooms = two_rooms() if home is TWO_ROOMS else None
    return PlanningContext(
        home.map, home.station, RobotConfig(), MissionConfig(), DockingConfig(), rooms
    )


def stages(request: CleanRequest, place: PlanningContext, here: Pose = HERE) -> list[Stage]:
    dirt = DirtMap(place.occupancy)
    return stages_of(request, place, dirt, place.coverable(), here)


def assert_floor_is(stage: Stage, place: PlanningContext, *areas: tuple[float, ...]) -> None:
    """Of what can be covered, the cells with middles in one of the areas, and no others."""
    coverable = place.coverable()
    assert stage.floor.any()
    for row, column in np.ndindex(*place.frame.shape):
        x, y = place.frame.centre_of(row, column)
        inside = any(left <= x <= right and low <= y <= high for left, low, right, high in areas)
        assert stage.floor[row, column] == (coverable[row, column] and inside)


def test_a_whole_clean_is_all_that_can_be_covered_once_for_each_pass() -> None:
    place = context()
    found = stages(CleanRequest(passes=3), place)
    assert [stage.again for stage in found] == [False, True, True]
    assert all(np.array_equal(stage.floor, place.coverable()) for stage in found)


def test_each_room_has_as_many_passes_as_it_is_given() -> None:
    request = CleanRequest(
        CleanMode.ROOMS, (DEN, HALL), in_order=True, each=(RoomWay(1), RoomWay(2))
    )
    found = stages(request, context())
    assert [(stage.name, stage.again) for stage in found] == [
        (DEN, False),
        (HALL, False),
        (HALL, True),
    ]


def test_edges_are_the_floor_within_a_tool_s_width_of_where_it_ends() -> None:
    place = context(HOME)
    (stage,) = stages(CleanRequest(mode=CleanMode.EDGES), place)
    coverable = place.coverable()
    outside = np.argwhere(~np.pad(coverable, 1)) - 1
    for row, column in np.argwhere(coverable)[::7].tolist():
        away = np.hypot(outside[:, 0] - row, outside[:, 1] - column).min()
        away *= place.frame.resolution
        if abs(away - place.tool_width) > place.frame.resolution:
            assert stage.floor[row, column] == (away < place.tool_width)
    assert not (stage.floor & ~coverable).any()


def test_zones_and_spots_are_what_of_them_can_be_covered() -> None:
    place = context()
    areas = ((0.4, 0.4, 1.0, 0.9), (0.8, 0.7, 1.5, 2.0))
    (zones,) = stages(CleanRequest(mode=CleanMode.ZONES, zones=areas), place)
    assert_floor_is(zones, place, *areas)
    half = 0.5 * MissionConfig().cleaning.spot_size
    (spot,) = stages(CleanRequest(mode=CleanMode.SPOT, spot=(1.2, 1.3)), place)
    assert_floor_is(spot, place, (1.2 - half, 1.3 - half, 1.2 + half, 1.3 + half))
    (here,) = stages(CleanRequest(mode=CleanMode.SPOT), place)
    x, y = HERE.x, HERE.y
    assert_floor_is(here, place, (x - half, y - half, x + half, y + half))


@pytest.mark.parametrize(
    ("rooms", "in_order", "expected"),
    [
        ((DEN, HALL), False, [HALL, DEN]),
        ((DEN, HALL), True, [DEN, HALL]),
        ((DEN, DEN), True, [DEN]),
    ],
)
def test_rooms_come_nearest_first_or_in_the_order_asked_for(
    rooms: tuple[str, ...], in_order: bool, expected: list[str]
) -> None:
    """The station stands in the hall."""
    place = context()
    found = stages(CleanRequest(mode=CleanMode.ROOMS, rooms=rooms, in_order=in_order), place)
    assert [stage.name for stage in found] == expected
    middle = WALL_X + 0.05
    areas = {HALL: (0.0, 0.0, middle, 2.4), DEN: (middle, 0.0, 3.6, 2.4)}
    for stage in found:
        assert_floor_is(stage, place, areas[stage.name])


def test_the_dirtiest_room_comes_first_and_all_floor_comes() -> None:
    place = context()
    dirt = DirtMap(place.occupancy)
    request = CleanRequest(mode=CleanMode.DIRTIEST)
    coverable = place.coverable()
    found = stages_of(request, place, dirt, coverable, HERE)
    names = [stage.name for stage in found]
    assert sorted(names)[:2] == [DEN, HALL]
    assert set(names) <= {DEN, HALL, "outside of all rooms"}
    counts = sum(stage.floor.astype(int) for stage in found)
    assert np.array_equal(counts, coverable.astype(int))


def test_rooms_that_are_not_there_are_refused() -> None:
    with pytest.raises(CleanRefusedError, match="there are: "):
        stages(CleanRequest(mode=CleanMode.ROOMS, rooms=("attic",)), context())
    with pytest.raises(CleanRefusedError, match="without"):
        stages(CleanRequest(mode=CleanMode.ROOMS, rooms=(DEN,)), context(HOME))
