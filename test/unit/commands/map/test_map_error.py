"""The measured errors of made-up maps: moved, turned, with doubled walls, with too much floor."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from fixtures.homes.worlds import EXACT
from numpy.typing import NDArray

from roomba.commands.map.error_kernels import TrueSurfaces, offsets
from roomba.commands.map.map_error import MapError, map_error, wrong_sides
from roomba.commands.map.seen_floor import seen_floor
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap

FRAME = GridFrame(0.05, -1.0, -2.0, 120, 160)
"""8 x 6 m."""
STATION = (-0.5, -1.5)


def _solid() -> NDArray[np.bool_]:
    """A home: a wall around, one with a doorway, a box, and a closed room of 1 x 1 m."""
    solid = np.zeros(FRAME.shape, np.bool_)
    solid[:3], solid[-3:], solid[:, :3], solid[:, -3:] = True, True, True, True
    solid[3:70, 80:82] = True
    solid[20:36, 80:82] = False
    solid[90:100, 30:50] = True
    solid[94:, 134:] = True
    solid[97:117, 137:157] = False
    return solid


SOLID = _solid()


@cache
def all_seen() -> NDArray[np.bool_]:
    """The floor that can be seen; made by the process that needs it."""
    return seen_floor(SOLID, FRAME, STATION, RobotConfig())


def _map(
    shift: tuple[float, float] = (0.0, 0.0), turn: float = 0.0, frame: GridFrame | None = None
) -> OccupancyMap:
    """The home as a perfect robot would draw it that takes its frame to lie elsewhere."""
    frame = frame or GridFrame(0.05, -1.5, -2.5, 140, 180)
    rows, columns = np.mgrid[: frame.rows, : frame.columns]
    x = frame.origin_x + (columns + 0.5) * frame.resolution - shift[0] - 3.0
    y = frame.origin_y + (rows + 0.5) * frame.resolution - shift[1] - 1.0
    cosine, sine = math.cos(-turn), math.sin(-turn)
    true_x, true_y = cosine * x - sine * y + 3.0, sine * x + cosine * y + 1.0
    row = np.floor((true_y - FRAME.origin_y) / FRAME.resolution + 1e-9).astype(int)
    column = np.floor((true_x - FRAME.origin_x) / FRAME.resolution + 1e-9).astype(int)
    inside = (row >= 0) & (row < FRAME.rows) & (column >= 0) & (column < FRAME.columns)
    row, column = np.where(inside, row, 0), np.where(inside, column, 0)
    values = np.full(frame.shape, UNKNOWN, np.int8)
    values[inside & all_seen()[row, column]] = FREE
    values[inside & SOLID[row, column]] = OCCUPIED
    return OccupancyMap(frame, values)


def _error(occupancy: OccupancyMap) -> MapError:
    return map_error(occupancy, FRAME, SOLID, all_seen())


def _with(occupancy: OccupancyMap, rows: slice, columns: slice, value: int) -> OccupancyMap:
    values = occupancy.values.copy()
    values[rows, columns] = value
    return OccupancyMap(occupancy.frame, values)


def test_the_truth_has_no_error_whatever_its_frame() -> None:
    error = _error(_map())
    assert error.walls == 1.0
    assert error.floor == pytest.approx(1.0, abs=1e-9)
    assert error.wall_distance < 1e-9
    assert (error.doubled, error.specks) == (0, 0)
    assert (error.extra, error.missed) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert math.hypot(*error.shift) < 1e-6
    assert abs(error.rotation) < 1e-6


def test_finer_cells_are_compared_as_exactly() -> None:
    error = _error(_map(frame=GridFrame(0.025, -1.5, -2.5, 280, 360)))
    assert error.walls == 1.0
    assert error.floor == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("shift", [(0.03, 0.0), (0.0, -0.04), (0.02, 0.01)])
def test_a_map_is_shifted_by_less_than_a_cell(shift: tuple[float, float]) -> None:
    # The grid is shifted along, as a robot's own may be: its sides are where it says, to the mm.
    frame = GridFrame(0.05, -1.5 + shift[0], -2.5 + shift[1], 140, 180)
    error = _error(_map(shift, frame=frame))
    assert error.walls == 1.0
    assert error.shift == pytest.approx(shift, abs=0.002)
    assert error.floor < 1.0


def test_beyond_five_centimetres_walls_are_wrong() -> None:
    frame = GridFrame(0.05, -1.5 + 0.06, -2.5, 140, 180)
    error = _error(_map((0.06, 0.0), frame=frame))
    # Those along x are still where they were.
    assert 0.4 < error.walls < 0.75
    assert error.shift == pytest.approx((0.06, 0.0), abs=0.003)


@pytest.mark.parametrize("degrees", [-1.0, 0.6, 2.0])
def test_a_map_is_turned(degrees: float) -> None:
    # Cells lie otherwise than the true ones, as they would: else small turns change none of them.
    frame = GridFrame(0.05, -1.52, -2.51, 140, 180)
    error = _error(_map(turn=math.radians(degrees), frame=frame))
    assert math.degrees(error.rotation) == pytest.approx(degrees, abs=0.15)
    assert error.doubled == 0


def test_floor_that_is_not_there_and_floor_that_is_missed() -> None:
    true = _map()
    # Both beside the box, 20 x 10 cells of it at (0.5, 2.5) m: 0.25 m2 each.
    more = _error(_with(true, slice(100, 110), slice(40, 50), FREE))
    assert more.extra == pytest.approx(0.25, abs=1e-6)
    assert more.missed == pytest.approx(0.0, abs=1e-6)
    less = _error(_with(true, slice(70, 80), slice(40, 50), UNKNOWN))
    assert less.missed == pytest.approx(0.25, abs=1e-6)
    area = np.count_nonzero(all_seen()) * 0.05**2
    assert more.floor == pytest.approx(area / (area + 0.25))
    assert less.floor == pytest.approx((area - 0.25) / area)


def test_floor_beyond_the_home_s_grid_is_too_much() -> None:
    # 10 x 20 cells at the far corner of its own grid, all of them outside of the true one.
    error = _error(_with(_map(), slice(120, 140), slice(0, 10), FREE))
    assert error.extra == pytest.approx(200 * 0.05**2, abs=1e-6)


def test_a_closed_room_does_not_count() -> None:
    room = _with(_map(), slice(107, 127), slice(147, 167), FREE)
    assert _error(room).floor == pytest.approx(1.0)
    assert not all_seen()[97:117, 137:157].any()


def test_a_wall_that_is_mapped_twice_is_counted() -> None:
    true = _map()
    # The left wall's side lies at column 10 + 3; 10 cm before it stands another one, 1 m long.
    assert _error(_with(true, slice(40, 60), slice(15, 16), OCCUPIED)).doubled == 20
    # 40 cm before it, it is a thing of its own: wrong, but no wall mapped twice.
    far = _error(_with(true, slice(40, 60), slice(21, 22), OCCUPIED))
    assert (far.doubled, far.specks) == (0, 0)
    assert far.walls < 1.0


def test_one_cell_before_a_wall_is_a_speck() -> None:
    error = _error(_with(_map(), slice(50, 51), slice(15, 16), OCCUPIED))
    assert (error.doubled, error.specks) == (0, 1)


def test_holes_in_a_wall_are_no_second_wall() -> None:
    occupancy = _map()
    values = occupancy.values.copy()
    # Every other cell of a stretch of the left wall's surface, and what is behind it is not known.
    values[40:60, :12] = UNKNOWN
    values[40:60:2, 12] = FREE
    error = _error(OccupancyMap(occupancy.frame, values))
    assert error.doubled == 0
    assert error.specks > 0


def test_a_slanted_wall_that_is_mapped_twice_is_counted() -> None:
    true = _map()
    values = true.values.copy()
    for step in range(20):
        values[40 + step, 60 + step // 2] = OCCUPIED
        values[40 + step, 63 + step // 2] = OCCUPIED
    assert _error(OccupancyMap(true.frame, values)).doubled >= 20


def test_what_truly_stands_before_a_wall_is_not_mapped_twice() -> None:
    solid = SOLID.copy()
    solid[40:60, 5] = True
    occupancy = _with(_map(), slice(50, 70), slice(15, 16), OCCUPIED)
    assert map_error(occupancy, FRAME, solid, all_seen() & ~solid).doubled == 0
    assert _error(occupancy).doubled == 20


def test_a_thin_wall_seen_from_both_sides_is_one_wall() -> None:
    solid = SOLID.copy()
    solid[3:70, 81] = False
    seen = seen_floor(solid, FRAME, STATION, RobotConfig())
    occupancy = OccupancyMap(FRAME, np.where(solid, OCCUPIED, np.where(seen, FREE, UNKNOWN)))
    assert map_error(occupancy, FRAME, solid, seen).doubled == 0


def test_sides_that_are_wrong_are_told() -> None:
    # A cell in the middle of nowhere has four.
    wrong = wrong_sides(
        _with(_map(), slice(60, 61), slice(60, 61), OCCUPIED), FRAME, SOLID, all_seen()
    )
    assert len(wrong) == 4
    assert wrong.mean(axis=0) == pytest.approx((-1.5 + 60.5 * 0.05, -2.5 + 60.5 * 0.05))
    assert len(wrong_sides(_map(), FRAME, SOLID, all_seen())) == 0


def test_an_empty_map_cannot_be_compared() -> None:
    empty = OccupancyMap(FRAME, np.full(FRAME.shape, FREE, np.int8))
    with pytest.raises(ValueError, match="expected a map with occupied cells"):
        _error(empty)


def test_behind_a_gap_too_narrow_for_the_body_floor_is_seen_and_counts() -> None:
    solid = SOLID.copy()
    # The doorway is narrowed to 10 cm: the other half of the home is seen through it, in part.
    solid[20:36, 80:82] = True
    solid[70:117, 80:82] = True
    solid[27:29, 80:82] = False
    seen = seen_floor(solid, FRAME, STATION, RobotConfig())
    beyond = np.count_nonzero(seen[:, 82:])
    assert 0 < beyond < 0.7 * np.count_nonzero(all_seen()[:, 82:])
    assert not (seen & solid).any()


def test_floor_beyond_the_lidar_s_range_is_not_all_seen() -> None:
    frame = GridFrame(0.05, 0.0, 0.0, 20, 400)
    solid = np.zeros(frame.shape, np.bool_)
    solid[0], solid[-1], solid[:, 0], solid[:, -1] = True, True, True, True
    solid[:7, 100:] = True
    solid[12:, 100:] = True
    seen = seen_floor(solid, frame, (1.0, 0.5), EXACT)
    # It gets no farther than 5 m: 12 m from there it is dark.
    assert seen[8:11, 330].any()
    assert not seen[:, 345].any()


def test_a_robot_that_fits_nowhere_is_refused() -> None:
    solid = np.ones((10, 10), np.bool_)
    solid[4:6, 4:6] = False
    with pytest.raises(RoombaError, match="on which the robot fits"):
        seen_floor(solid, GridFrame(0.05, 0.0, 0.0, 10, 10), (0.25, 0.25), RobotConfig())


def test_of_two_true_sides_the_nearer_one_tells_how_far_a_side_is_off() -> None:
    solid = np.zeros((20, 20), np.bool_)
    solid[10, 4] = solid[10, 8] = True
    ground = TrueSurfaces(solid, ~solid, np.array([0.0, 0.0, 0.05]))
    # They face along x at 0.25 and 0.45 m.
    points, off = np.array([[0.27, 0.52], [0.44, 0.52], [0.90, 0.52]]), np.empty(3)
    offsets(ground, points, np.zeros(3, np.int64), 0.3, off)
    assert off[:2] == pytest.approx([0.02, -0.01])
    assert math.isnan(off[2])
