"""What lies behind surfaces is left out of a drawn map, and nothing that was seen."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from numpy.typing import NDArray
from scipy import ndimage

from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.slam.drawing.occupancy_counts import OccupancyCounts
from roomba.perception.slam.drawing.seen_surfaces import only_seen

CELL = 0.05
WORDS = {".": FREE, "#": OCCUPIED, " ": UNKNOWN}
drawn_maps = arrays(
    np.int8,
    array_shapes(min_dims=2, max_dims=2, max_side=12),
    elements=st.sampled_from([FREE, OCCUPIED, UNKNOWN]),
)


def map_of(values: NDArray[np.int8]) -> OccupancyMap:
    return OccupancyMap(GridFrame(CELL, 0.0, 0.0, *values.shape), values)


def seen(text: str, least_cells: int) -> list[str]:
    """What is left of a map that is drawn in words, a row a line."""
    rows = text.splitlines()
    values = np.array([[WORDS[word] for word in row] for row in rows], np.int8)
    words = {value: word for word, value in WORDS.items()}
    left = only_seen(map_of(values), least_cells * CELL**2).values
    return ["".join(words[value] for value in row) for row in left.tolist()]


def test_specks_behind_a_wall_are_unknown() -> None:
    assert seen("....# #\n....#.#\n....###\n....# #", 3) == ["....#  "] * 4


def test_floor_that_only_corners_connect_is_seen() -> None:
    diagonal = "..#   \n##.#  \n  #.# \n   #. "
    assert seen(diagonal, 4) == diagonal.splitlines()


def test_a_leg_in_the_midst_of_floor_is_seen() -> None:
    room = "#####\n#...#\n#.#.#\n#...#\n#####"
    assert seen(room, 8) == room.splitlines()


def test_a_map_with_next_to_no_floor_stays() -> None:
    assert seen("#.#", 2) == ["#.#"]


@given(drawn_maps, st.integers(1, 6))
def test_what_is_left_borders_on_large_floor(values: NDArray[np.int8], least: int) -> None:
    left = only_seen(map_of(values), (least - 0.5) * CELL**2).values
    around = np.ones((3, 3), np.bool_)
    labels, count = ndimage.label(values == FREE, around)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    is_large = sizes >= least
    is_large[0] = False
    if not is_large.any():
        assert np.array_equal(left, values)
        return
    near = ndimage.binary_dilation(is_large[labels], around)
    assert np.array_equal(left[near], values[near])
    assert (left[~near] == UNKNOWN).all()


def test_a_wall_that_is_met_with_noise_is_one_cell_thick() -> None:
    """A wall 2 m ahead, seen in 400 scans by ranges that are 4 cm off, and more now and then."""
    random = np.random.default_rng(1)
    counts = OccupancyCounts(CELL)
    for _ in range(400):
        across = random.uniform(-1.0, 1.0, 50)
        away = 2.01 + random.normal(0.0, 0.04, across.size)
        points = np.column_stack((away, across, -np.ones_like(across), np.zeros_like(across)))
        counts.draw(points.astype(np.float32), np.zeros(2), np.zeros(3))
    made = counts.occupancy(0.3, 2, 0.05)
    wall = made.values[made.frame.rows // 2 - 10 : made.frame.rows // 2 + 10] == OCCUPIED
    assert (wall.sum(axis=1) == 1).all()
    places = made.frame.origin_x + CELL * (np.argmax(wall, axis=1) + 0.5)
    assert np.abs(places - 2.01).max() < 1.5 * CELL
