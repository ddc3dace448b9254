"""What a clean wants and has done, on a map that is being made and then whole."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from fixtures.missions.exploring import HALL, HERE, WHOLE, context_of, known_to
from fixtures.robots.missions import DEN, TWO_ROOMS, WALL_X, two_rooms
from fixtures.robots.missions import HALL as HALL_ROOM

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.mission.cleaning.checkpoint import CheckpointError
from roomba.mission.cleaning.ledger import CoverageLedger
from roomba.mission.cleaning.stages import Stage
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.perception.swept.coverage_bits import SWEPT
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import CleanMode


def begun(context: PlanningContext, request: CleanRequest | None = None) -> CoverageLedger:
    return CoverageLedger(request or CleanRequest(), context, DirtMap(context.occupancy), HERE)


def use(ledger: CoverageLedger, context: PlanningContext) -> None:
    ledger.use_context(context, DirtMap(context.occupancy))


def cut(occupancy: OccupancyMap, cells: int) -> OccupancyMap:
    """The same map without so many rows below and columns at the left."""
    frame = occupancy.frame
    size = frame.resolution
    less = GridFrame(
        size,
        frame.origin_x + cells * size,
        frame.origin_y + cells * size,
        frame.rows - cells,
        frame.columns - cells,
    )
    return OccupancyMap(less, occupancy.values[cells:, cells:].copy())


def swept_places(ledger: CoverageLedger, frame: GridFrame) -> set[tuple[int, int]]:
    """Swept places in whole centimetres."""
    return {
        (round(100.0 * x - 0.5), round(100.0 * y - 0.5))
        for x, y in (frame.centre_of(*cell) for cell in np.argwhere(ledger.coverage.swept).tolist())
    }


def test_more_map_is_more_to_clean_and_what_is_clean_stays_so() -> None:
    context, more = context_of(cut(HALL, 1)), context_of(WHOLE)
    ledger = begun(context)
    ledger.coverage.sweep(1.0, 1.2)
    ledger.coverage.sweep(1.3, 1.2)
    wanted, clean = ledger.coverage.wanted_area, np.count_nonzero(ledger.clean)
    before = swept_places(ledger, context.frame)
    use(ledger, more)
    assert ledger.coverage.wanted_area > 1.4 * wanted
    assert np.count_nonzero(ledger.clean) == clean > 500
    assert swept_places(ledger, more.frame) == before
    assert ledger.coverage.swept_cells == clean
    assert ledger.left == pytest.approx(ledger.coverage.wanted_area - clean * 1e-4)


def test_on_the_whole_map_all_passes_are_wanted_from_the_beginning() -> None:
    ledger = begun(context_of(HALL), CleanRequest(passes=2))
    assert len(ledger.stages) == 1
    use(ledger, context_of(WHOLE, is_growing=False))
    assert [stage.again for stage in ledger.stages] == [False, True]
    assert ledger.stage_number == 0


def test_turned_to_its_walls_the_map_takes_along_what_is_clean() -> None:
    context = context_of(HALL)
    ledger = begun(context)
    ledger.coverage.sweep(1.0, 1.2)
    ledger.coverage.sweep(1.2, 1.2)
    turn = Pose(0.02, -0.03, 0.05)
    use(ledger, context_of(WHOLE, is_growing=False, station=turn.compose(context.station)))
    rows, columns = np.nonzero(ledger.coverage.swept)
    middle = context_of(WHOLE).frame.centre_of(round(rows.mean()), round(columns.mean()))
    at = turn.compose(Pose(1.1, 1.2))
    assert middle == pytest.approx((at.x, at.y), abs=0.02)


@pytest.mark.parametrize("is_killed", [False, True])
def test_what_is_asked_for_turns_with_the_map(*, is_killed: bool) -> None:
    context, turn = context_of(HALL), Pose(0.02, -0.03, 0.05)
    whole = context_of(WHOLE, is_growing=False, station=turn.compose(context.station))
    request = CleanRequest(CleanMode.ZONES, zones=((0.6, 0.4, 1.4, 0.8),))
    ledger = begun(context, request)
    if is_killed:
        values = json.loads(json.dumps(ledger.values()))
        ledger = begun(whole, request)
        ledger.restore(values)
    else:
        use(ledger, whole)
    middle = turn.compose(Pose(1.0, 0.6))
    left, bottom, right, top = ledger.request.zones[0]
    assert (0.5 * (left + right), 0.5 * (bottom + top)) == pytest.approx((middle.x, middle.y))
    assert (right - left, top - bottom) == pytest.approx((0.8, 0.4))
    x, y = whole.frame.centres(*np.nonzero(ledger.coverage.wanted))
    assert (x.mean(), y.mean()) == pytest.approx((middle.x, middle.y), abs=0.02)


def test_what_was_planned_is_not_planned_again_until_something_broke_it_off() -> None:
    ledger = begun(context_of(HALL))
    ledger.coverage.sweep(1.0, 1.2)
    assert np.array_equal(ledger.untried, ledger.coverage.missed)
    ledger.note_tried(ledger.untried)
    assert not ledger.untried.any()
    use(ledger, context_of(WHOLE))
    columns = np.nonzero(ledger.untried)[1]
    assert (context_of(WHOLE).frame.centre_of(0, int(columns.min()))[0]) > WALL_X - 0.3
    ledger.try_again()
    assert np.array_equal(ledger.untried, ledger.coverage.missed)


@pytest.mark.parametrize("later", [HALL, known_to(WALL_X + 0.5), WHOLE])
@pytest.mark.parametrize("is_growing", [True, False])
def test_values_of_less_map_are_taken_up_on_more(later: OccupancyMap, *, is_growing: bool) -> None:
    context = context_of(cut(HALL, 1))
    ledger = begun(context)
    ledger.coverage.sweep(1.0, 1.2)
    ledger.sweep_anew(ledger.coverage.wanted)
    ledger.coverage.sweep(1.4, 1.2)
    values = json.loads(json.dumps(ledger.values()))
    more = context_of(later, is_growing=is_growing)
    again = begun(more)
    again.restore(values)
    assert swept_places(again, more.frame) == swept_places(ledger, context.frame)
    assert np.count_nonzero(again.clean) == np.count_nonzero(ledger.clean)
    assert again.coverage.wanted_area == pytest.approx(begun(more).coverage.wanted_area)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("grid", [0.0, 0.0, 3, 3]),
        ("grid", [float("nan"), 0.0, 48, 72]),
        ("station", [float("inf"), 0.0, 0.0]),
        ("began_at", [0.0, 0.0]),
        ("swept", "bm90IGEgbWFzaw=="),
    ],
)
def test_junk_is_refused(name: str, value: object) -> None:
    ledger = begun(context_of(HALL))
    values = {**ledger.values(), name: value}
    with pytest.raises((CheckpointError, ValueError, TypeError)):
        begun(context_of(HALL)).restore(values)


def test_a_zone_that_is_gone_is_wanted_at_the_end() -> None:
    ledger = begun(context_of(WHOLE, is_growing=False))
    ledger.coverage.cells |= np.uint8(SWEPT)
    use(ledger, context_of(HALL, is_growing=False))
    less = ledger.coverage.wanted_area
    use(ledger, context_of(WHOLE, is_growing=False))
    assert ledger.coverage.wanted_area > 1.4 * less
    assert [stage.name for stage in ledger.stages] == ["", "what was a zone before"]


def test_a_zone_that_is_newer_than_the_values_is_not_wanted() -> None:
    values = json.loads(json.dumps(begun(context_of(WHOLE, is_growing=False)).values()))
    edited = begun(context_of(HALL, is_growing=False))
    wanted = edited.coverage.wanted.copy()
    edited.restore(values)
    assert np.array_equal(edited.coverage.wanted, wanted)
    assert np.array_equal(edited.stages[0].floor, wanted)


def of_rooms(zones: Zones | None = None) -> PlanningContext:
    parts = RobotConfig(), MissionConfig(), DockingConfig(), two_rooms(), zones
    return PlanningContext(TWO_ROOMS.map, TWO_ROOMS.station, *parts)


IN_THE_DOOR = Zones((Zone("door", ZoneKind.WALL, ((WALL_X + 0.05, 0.7), (WALL_X + 0.05, 1.7))),))
ROOMS = CleanRequest(CleanMode.ROOMS, rooms=(HALL_ROOM, DEN), in_order=True, passes=2)


def rooms_of(ledger: CoverageLedger) -> list[str]:
    return [stage.name for stage in ledger.stages]


def test_a_room_to_come_that_a_zone_takes_away_is_none_any_more() -> None:
    """No floor is nearest to it: a way there would lead to the middle of the map."""
    ledger = begun(of_rooms(), ROOMS)
    assert rooms_of(ledger) == [HALL_ROOM, DEN, HALL_ROOM, DEN]
    use(ledger, of_rooms(IN_THE_DOOR))
    assert rooms_of(ledger) == [HALL_ROOM, HALL_ROOM]
    assert ledger.queue == (HALL_ROOM,)
    assert ledger.stage is not None
    assert ledger.way_out_of(ledger.stage) is None
    # When the zone is gone that room is wanted at the end.
    use(ledger, of_rooms())
    assert rooms_of(ledger) == [HALL_ROOM, HALL_ROOM, "what was a zone before"]


def test_a_room_that_a_zone_takes_away_while_it_is_there_stays_the_present_one() -> None:
    ledger = begun(of_rooms(), ROOMS)
    ledger.next_stage()
    use(ledger, of_rooms(IN_THE_DOOR))
    assert rooms_of(ledger) == [HALL_ROOM, DEN, HALL_ROOM]
    assert ledger.stage is not None
    assert (ledger.stage.name, ledger.stage.cells) == (DEN, 0)


def test_a_room_to_come_that_is_behind_a_newer_zone_is_not_taken_up() -> None:
    values = json.loads(json.dumps(begun(of_rooms(), ROOMS).values()))
    ledger = begun(of_rooms(IN_THE_DOOR), replace(ROOMS, rooms=(HALL_ROOM,)))
    ledger.restore(values)
    assert rooms_of(ledger) == [HALL_ROOM, HALL_ROOM]


def test_rooms_of_a_map_without_rooms_are_refused() -> None:
    with pytest.raises(CleanRefusedError, match="clean the whole home"):
        begun(context_of(HALL), CleanRequest(CleanMode.ROOMS, rooms=("den",)))


def test_its_areas_are_those_of_its_masks() -> None:
    """Of a floor that is swept, made dirty again, and swept in part; then of a second pass."""
    context = context_of(WHOLE)
    ledger = begun(context)
    ledger.add(Stage("again", ledger.coverage.wanted, again=True))
    cell = context.frame.resolution**2
    assert ledger.left == pytest.approx(2.0 * ledger.coverage.wanted.sum() * cell)
    ledger.coverage.sweep(1.0, 1.2)
    ledger.coverage.sweep(2.0, 1.2)
    ledger.sweep_anew(ledger.coverage.wanted)
    ledger.coverage.lift()
    ledger.coverage.sweep(1.0, 1.0)
    ledger.coverage.sweep(1.5, 1.0)
    assert ledger.coverage.swept.sum() < ledger.clean.sum() < ledger.coverage.wanted.sum()
    assert ledger.clean_area == pytest.approx(ledger.clean.sum() * cell)
    missed = ledger.coverage.wanted & ~ledger.coverage.swept
    assert ledger.left == pytest.approx((missed.sum() + ledger.coverage.wanted.sum()) * cell)
    ledger.next_stage()
    assert ledger.clean_area == pytest.approx(ledger.clean.sum() * cell)
    assert ledger.left == pytest.approx(ledger.coverage.wanted.sum() * cell)
