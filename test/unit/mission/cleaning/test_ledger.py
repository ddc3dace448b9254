"""What a clean wants and has done, on a map that is being made and then whole."""

from __future__ import annotations

import json

import numpy as np
import pytest
from fixtures.exploring import HALL, HERE, WHOLE, known_to, site_of
from fixtures.missions import WALL_X

from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.mission.cleaning.checkpoint import CheckpointError
from roomba.mission.cleaning.ledger import CoverageLedger
from roomba.mission.cleaning.request import CleanMode, CleanRefusedError, CleanRequest
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.coverage_bits import SWEPT
from roomba.perception.swept.dirt_map import DirtMap


def begun(site: PlanningContext, request: CleanRequest | None = None) -> CoverageLedger:
    return CoverageLedger(request or CleanRequest(), site, DirtMap(site.occupancy), HERE)


def use(book: CoverageLedger, site: PlanningContext) -> None:
    book.use_site(site, DirtMap(site.occupancy))


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


def swept_places(book: CoverageLedger, frame: GridFrame) -> set[tuple[int, int]]:
    """Swept places in whole centimetres."""
    return {
        (round(100.0 * x - 0.5), round(100.0 * y - 0.5))
        for x, y in (frame.centre_of(*cell) for cell in np.argwhere(book.coverage.swept).tolist())
    }


def test_more_map_is_more_to_clean_and_what_is_clean_stays_so() -> None:
    site, more = site_of(cut(HALL, 1)), site_of(WHOLE)
    book = begun(site)
    book.coverage.sweep(1.0, 1.2)
    book.coverage.sweep(1.3, 1.2)
    wanted, clean = book.coverage.wanted_area, np.count_nonzero(book.clean)
    before = swept_places(book, site.frame)
    use(book, more)
    assert book.coverage.wanted_area > 1.4 * wanted
    assert np.count_nonzero(book.clean) == clean > 500
    assert swept_places(book, more.frame) == before
    assert book.coverage.swept_cells == clean
    assert book.left == pytest.approx(book.coverage.wanted_area - clean * 1e-4)


def test_on_the_whole_map_all_passes_are_wanted_from_the_beginning() -> None:
    book = begun(site_of(HALL), CleanRequest(passes=2))
    assert len(book.stages) == 1
    use(book, site_of(WHOLE, is_growing=False))
    assert [stage.again for stage in book.stages] == [False, True]
    assert book.stage_number == 0


def test_turned_to_its_walls_the_map_takes_along_what_is_clean() -> None:
    site = site_of(HALL)
    book = begun(site)
    book.coverage.sweep(1.0, 1.2)
    book.coverage.sweep(1.2, 1.2)
    turn = Pose(0.02, -0.03, 0.05)
    use(book, site_of(WHOLE, is_growing=False, station=turn.compose(site.station)))
    rows, columns = np.nonzero(book.coverage.swept)
    middle = site_of(WHOLE).frame.centre_of(round(rows.mean()), round(columns.mean()))
    at = turn.compose(Pose(1.1, 1.2))
    assert middle == pytest.approx((at.x, at.y), abs=0.02)


def test_what_was_planned_is_not_planned_again_until_something_broke_it_off() -> None:
    book = begun(site_of(HALL))
    book.coverage.sweep(1.0, 1.2)
    assert np.array_equal(book.untried, book.coverage.missed)
    book.note_tried(book.untried)
    assert not book.untried.any()
    use(book, site_of(WHOLE))
    columns = np.nonzero(book.untried)[1]
    assert (site_of(WHOLE).frame.centre_of(0, int(columns.min()))[0]) > WALL_X - 0.3
    book.try_again()
    assert np.array_equal(book.untried, book.coverage.missed)


@pytest.mark.parametrize("later", [HALL, known_to(WALL_X + 0.5), WHOLE])
@pytest.mark.parametrize("is_growing", [True, False])
def test_values_of_less_map_are_taken_up_on_more(later: OccupancyMap, *, is_growing: bool) -> None:
    site = site_of(cut(HALL, 1))
    book = begun(site)
    book.coverage.sweep(1.0, 1.2)
    book.sweep_anew(book.coverage.wanted)
    book.coverage.sweep(1.4, 1.2)
    values = json.loads(json.dumps(book.values()))
    more = site_of(later, is_growing=is_growing)
    again = begun(more)
    again.restore(values)
    assert swept_places(again, more.frame) == swept_places(book, site.frame)
    assert np.count_nonzero(again.clean) == np.count_nonzero(book.clean)
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
    book = begun(site_of(HALL))
    values = {**book.values(), name: value}
    with pytest.raises((CheckpointError, ValueError, TypeError)):
        begun(site_of(HALL)).restore(values)


def test_a_zone_that_is_gone_is_wanted_at_the_end() -> None:
    book = begun(site_of(WHOLE, is_growing=False))
    book.coverage.cells |= np.uint8(SWEPT)
    use(book, site_of(HALL, is_growing=False))
    less = book.coverage.wanted_area
    use(book, site_of(WHOLE, is_growing=False))
    assert book.coverage.wanted_area > 1.4 * less
    assert [stage.name for stage in book.stages] == ["", "what was a zone before"]


def test_rooms_of_a_map_without_rooms_are_refused() -> None:
    with pytest.raises(CleanRefusedError, match="clean the whole home"):
        begun(site_of(HALL), CleanRequest(CleanMode.ROOMS, rooms=("den",)))
