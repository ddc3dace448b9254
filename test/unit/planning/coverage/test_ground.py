"""The part of the floor that can be reached, against the whole floor cell by cell."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.references.straight_ways import Mask, connected_to, runs_between_centres_that_fit
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from roomba.configuration.coverage import CoverageConfig
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.planning.coverage.floor.floor import CoverageFloor
from roomba.planning.coverage.ground import Ground

MAPS = arrays(
    np.bool_,
    st.tuples(st.integers(4, 10), st.integers(4, 10)),
    elements=st.integers(0, 8).map(lambda number: number == 0),
    fill=st.just(False),
)


@st.composite
def grounds(draw: st.DrawFn) -> tuple[Ground, tuple[int, int]]:
    """A ground, and the cell of its floor from which it was found."""
    solid: Mask = draw(MAPS)
    values = np.where(solid, OCCUPIED, FREE).astype(np.int8)
    floor = CoverageFloor.build(
        OccupancyMap(GridFrame(0.04, -1.0, 2.0, *solid.shape), values),
        0.045,
        0.06,
        CoverageConfig(),
    )
    cells = np.argwhere(floor.fits).tolist()
    assume(cells)
    seed = tuple(draw(st.sampled_from(cells)))
    return Ground.around(floor, seed), seed


@given(grounds())
@settings(max_examples=examples(30))
def test_the_window_shows_all_that_can_be_got_to(found: tuple[Ground, tuple[int, int]]) -> None:
    ground, seed = found
    floor = ground.floor
    reachable = connected_to(floor.fits, seed)
    for row, column in np.ndindex(floor.frame.shape):
        cell = row, column
        assert ground.holds(cell) == (cell in reachable)
        x, y = ground.place_of(cell).astype(int).tolist()
        if cell in reachable:
            assert ground.middles[y, x]
    assert ground.middles.sum() == len(reachable)
    coverable = floor.coverable(floor.frame.centre_of(*seed))
    assert ground.coverable.sum() == coverable.sum()
    assert np.array_equal(coverable[ground.window], ground.coverable)
    for line in ground.rings:
        assert runs_between_centres_that_fit(ground.middles, line)
    assert ground.net.fits is ground.middles
    assert ground.radius == pytest.approx(3.0)


@given(grounds())
@settings(max_examples=examples(15))
def test_places_are_the_centres_of_cells_in_metres_and_back(
    found: tuple[Ground, tuple[int, int]],
) -> None:
    ground, _ = found
    cells = [(0, 0), (3, 7), (11, 2)]
    places = np.array([ground.place_of(cell) for cell in cells])
    metres = ground.metres(places)
    centres = [ground.floor.frame.centre_of(*cell) for cell in cells]
    assert metres == pytest.approx(np.array(centres))
    assert ground.places(metres) == pytest.approx(places)
    assert ground.places(ground.metres(places + 0.3)) == pytest.approx(places + 0.3)


def test_no_cell_outside_the_floor_is_held() -> None:
    values = np.full((8, 8), FREE, np.int8)
    floor = CoverageFloor.build(
        OccupancyMap(GridFrame(0.05, 0.0, 0.0, 8, 8), values), 0.1, 0.1, CoverageConfig()
    )
    ground = Ground.around(floor, (20, 20))
    for cell in ((-1, 20), (20, -1), (40, 20), (20, 40), (0, 0)):
        assert not ground.holds(cell)
    assert ground.holds((20, 20))
