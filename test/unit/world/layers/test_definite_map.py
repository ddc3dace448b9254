"""Maps of others as floors: what they leave open is settled, for the world and its robot alike."""

from __future__ import annotations

from collections import deque
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from roomba.commands.trials.runs import run_trial
from roomba.commands.trials.trial import Trial
from roomba.files.occupancy_map import save_map
from roomba.grid import FREE, MOST_CELLS, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.matching.surface_field import SurfaceField
from roomba.world.layers.definite_map import FENCE, MARGIN, SPECK, definite_map, with_small_cells
from roomba.world.layers.layer import load_home

SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))
CELL = 0.05
PIXELS = {FREE: 254, UNKNOWN: 205, OCCUPIED: 0}
"""As map_saver writes them."""
Values = NDArray[np.int8]


def map_of(values: Values, cell: float = CELL) -> OccupancyMap:
    return OccupancyMap(GridFrame(cell, -1.0, 2.0, *values.shape), values)


def room() -> Values:
    """Return 2.4 x 1.8 m of floor with a wall around it, and nothing known beyond."""
    values = np.full((46, 58), UNKNOWN, np.int8)
    values[3:-3, 3:-3] = OCCUPIED
    values[5:-5, 5:-5] = FREE
    return values


def specked(values: Values, per_m2: float) -> Values:
    """Return a map of whose floor single cells are not known."""
    floor = np.argwhere(values == FREE)
    count = round(per_m2 * len(floor) * CELL**2)
    chosen = floor[np.random.default_rng(1).choice(len(floor), count, replace=False)]
    values = values.copy()
    values[chosen[:, 0], chosen[:, 1]] = UNKNOWN
    return values


def written(folder: Path, values: Values, mode: str) -> str:
    """Write a map as map_saver does, but for the mode."""
    pixels = np.zeros(values.shape, np.uint8)
    for value, pixel in PIXELS.items():
        pixels[values == value] = pixel
    cv2.imwrite(str(folder / "map.png"), pixels[::-1])
    (folder / "map.yaml").write_text(
        f"image: map.png\nresolution: {CELL}\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n"
        f"occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: {mode}\n",
        encoding="utf-8",
    )
    return str(folder / "map.yaml")


@pytest.mark.parametrize("mode", ["trinary", "scale"])
@pytest.mark.parametrize("kind", ["room", "floor without a wall", "specks"])
def test_maps_of_others_are_cleaned(tmp_path: Path, kind: str, mode: str) -> None:
    values = {
        "room": room(),
        "floor without a wall": np.full((40, 52), FREE, np.int8),
        "specks": specked(room(), 8.0),
    }[kind]
    found = run_trial(Trial(home=written(tmp_path, values, mode), seed=1)).figures
    area = np.count_nonzero(values == FREE) * CELL**2
    assert (found.outcome, found.docked, found.hits) == ("COMPLETED", True, 0)
    assert found.fraction > 0.98
    assert found.coverable_m2 > 0.8 * area


@pytest.mark.parametrize("mode", ["trinary", "scale"])
def test_world_and_robot_hold_the_same_cells_for_solid(tmp_path: Path, mode: str) -> None:
    home = load_home(written(tmp_path, specked(room(), 8.0), mode), tmp_path)
    assert np.array_equal(home.solid, home.map.solid)
    assert np.array_equal(home.solid, home.map.likely_solid)


def test_shares_are_settled_by_the_half() -> None:
    values = room()
    values[20, 20:26] = [1, 20, 49, 50, 75, 99]
    settled = definite_map(map_of(values)).values
    # Three of them are a spot of 75 cm2 that a wall ends.
    assert settled[20, 20:26].tolist() == [OCCUPIED] * 6
    values[20, 20:26] = values[20, 19]
    settled[20, 20:26] = values[20, 19]
    assert np.array_equal(settled, values)


@pytest.mark.parametrize(
    "thing",
    [[[45]], [[40, 40, 40]], [[70, 0, 0], [0, 45, 0], [0, 0, 70]]],
    ids=["a leg", "a board", "a slanted wall"],
)
def test_what_fills_less_than_half_of_a_cell_does_not_vanish(thing: list[list[int]]) -> None:
    values = room()
    rows, columns = np.shape(thing)
    values[20 : 20 + rows, 20 : 20 + columns] = thing
    settled = definite_map(map_of(values)).values[20 : 20 + rows, 20 : 20 + columns]
    assert np.array_equal(settled == FREE, np.array(thing) == FREE)


@pytest.mark.parametrize("side", [2, 6, 9, 11, 14])
def test_the_lidar_expects_surfaces_where_the_world_is_solid(side: int) -> None:
    """The spot that is not known may be of any size, in cells: a localizer takes small ones for
    floor that no beam passed."""
    values = room()
    values[15 : 15 + side, 20 : 20 + side] = UNKNOWN
    settled = definite_map(map_of(values))
    field = SurfaceField.of(settled)
    assert np.array_equal(field.values <= 0.0, settled.values != FREE)


def test_a_map_of_which_nothing_is_known_has_no_floor() -> None:
    unknown = np.full((2, 2), UNKNOWN, np.int8)
    assert np.array_equal(definite_map(map_of(unknown)).values, unknown)


@pytest.mark.parametrize("cell", [0.05, 0.03, 0.01, 0.2])
def test_floor_at_the_end_of_a_map_gets_a_wall_beyond_it(cell: float) -> None:
    values = np.full((9, 7), OCCUPIED, np.int8)
    values[3:6, :5] = FREE
    fenced = definite_map(map_of(values, cell))
    wall = round((fenced.frame.rows - 9) / 2)
    assert FENCE <= wall * cell + 1e-9 < FENCE + cell
    assert np.array_equal(fenced.values, np.pad(values, wall, constant_values=OCCUPIED))
    x, y = map_of(values, cell).frame.centre_of(4, 2)
    assert fenced.frame.centre_of(4 + wall, 2 + wall) == pytest.approx((x, y))
    assert definite_map(fenced).frame == fenced.frame


def test_a_map_with_a_wall_around_it_keeps_its_frame() -> None:
    before = map_of(room())
    after = definite_map(before)
    assert after.frame == before.frame
    assert np.array_equal(after.values, before.values)


def spots(unknown: NDArray[np.bool_]) -> list[list[tuple[int, int]]]:
    """Return the cells of each unknown spot that hangs together over sides, one by one."""
    left, found = {(int(row), int(column)) for row, column in np.argwhere(unknown)}, []
    while left:
        spot, queue = [], deque([left.pop()])
        while queue:
            row, column = queue.popleft()
            spot.append((row, column))
            for up, aside in SIDES:
                beside = row + up, column + aside
                if beside in left:
                    left.remove(beside)
                    queue.append(beside)
        found.append(spot)
    return found


@given(hnp.arrays(np.int8, (9, 11), elements=st.sampled_from([FREE, FREE, UNKNOWN, OCCUPIED])))
def test_small_unknown_spots_are_floor_where_only_floor_is_beside_them(inside: Values) -> None:
    values = np.pad(inside, 2, constant_values=OCCUPIED)
    wanted = values.copy()
    for spot in spots(values == UNKNOWN):
        beside = {
            int(values[row + up, column + aside])
            for row, column in spot
            for up in (-1, 0, 1)
            for aside in (-1, 0, 1)
        }
        if len(spot) * CELL**2 <= SPECK + 1e-9 and OCCUPIED not in beside:
            wanted[tuple(np.transpose(spot))] = FREE
    if (wanted == FREE).any():
        # The others are small as well.
        wanted[wanted == UNKNOWN] = OCCUPIED
    assert np.array_equal(definite_map(map_of(values)).values, wanted)


@pytest.mark.parametrize(("cell", "parts"), [(0.05, 1), (0.2, 1), (0.25, 3), (0.5, 5), (1.0, 10)])
def test_cells_in_which_walls_are_anywhere_are_split(cell: float, parts: int) -> None:
    drawn = map_of(room(), cell)
    split = with_small_cells(drawn)
    assert (split is drawn) == (parts == 1)
    assert split.frame.extent == pytest.approx(drawn.frame.extent)
    assert split.frame.resolution <= max(cell if cell <= 0.2 else 0.0, 0.1)
    assert np.array_equal(split.values, np.kron(drawn.values, np.ones((parts, parts), np.int8)))


def test_so_many_cells_are_split_no_further_than_there_is_room_for() -> None:
    drawn = map_of(np.zeros((2_000, 3_000), np.int8), 0.5)
    assert with_small_cells(drawn).values.size <= MOST_CELLS
    whole = map_of(np.zeros((4_000, 5_000), np.int8), 0.5)
    assert with_small_cells(whole).frame == whole.frame


def test_a_room_of_coarse_cells_is_cleaned_without_a_touch(tmp_path: Path) -> None:
    values = np.full((8, 9), OCCUPIED, np.int8)
    values[1:-1, 1:-1] = FREE
    save_map(map_of(values, 0.5), tmp_path / "map.yaml")
    found = run_trial(Trial(home=str(tmp_path), seed=1)).figures
    assert (found.outcome, found.docked, found.hits) == ("COMPLETED", True, 0)


@pytest.mark.parametrize("rim", [5, 300])
def test_of_what_is_not_known_around_a_home_a_metre_is_kept(rim: int) -> None:
    """A picture may be many times as large as the home, and each cell of it costs memory."""
    inside = room()[3:-3, 3:-3]
    large = map_of(np.pad(inside, ((rim, 2 * rim), (3 * rim, rim)), constant_values=UNKNOWN))
    found = definite_map(large)
    rows, columns = inside.shape
    kept = [min(times * rim, round(MARGIN / CELL)) for times in (1, 2, 3, 1)]
    assert found.frame.shape == (rows + kept[0] + kept[1], columns + kept[2] + kept[3])
    # Each place has what it had before.
    for row, column in np.argwhere(large.values != UNKNOWN)[::17].tolist():
        here = found.frame.cell_of(*large.frame.centre_of(row, column))
        assert found.values[here] == large.values[row, column]
    assert np.count_nonzero(found.values != UNKNOWN) == inside.size


def test_a_home_in_a_large_picture_is_the_same_home(tmp_path: Path) -> None:
    homes = []
    for rim in (20, 200):
        folder = tmp_path / str(rim)
        folder.mkdir()
        values = np.pad(room()[3:-3, 3:-3], rim, constant_values=UNKNOWN)
        frame = GridFrame(CELL, -1.0 - rim * CELL, 2.0 - rim * CELL, *values.shape)
        save_map(OccupancyMap(frame, values), folder / "map.yaml")
        homes.append(load_home(str(folder), tmp_path))
    small, large = homes
    assert (large.frame.rows, large.frame.columns) == (small.frame.rows, small.frame.columns)
    assert large.frame.extent == pytest.approx(small.frame.extent)
    assert np.array_equal(large.map.values, small.map.values)
    assert (large.station.x, large.station.y, large.station.theta) == pytest.approx(
        (small.station.x, small.station.y, small.station.theta)
    )
