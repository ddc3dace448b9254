"""String pulling: ways become as short as a disc's can be, and pass what they passed."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from fixtures.homes.planned_rooms import CHORD, CLEARANCE, RADIUS, occupancy, room
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.geometry import Point
from roomba.grid import OccupancyMap
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.string_kernels import QUARTER
from roomba.planning.path.string_pulling import StringPulling

Floats = NDArray[np.float64]
Box = tuple[float, float, float, float]
REACH = RADIUS + CLEARANCE
ROOM = math.sqrt(REACH**2 - 0.025**2)
"""m; what a way between centres of cells of 5 cm keeps from a corner."""

BESIDE = 0.05 * math.sqrt(0.5)
"""m; what it keeps in addition from things that were seen."""

HALF_AROUND = 2 * QUARTER + 1
"""Points on half of the circle around a thing, which no taut way goes farther around."""

BOXES = st.lists(
    st.tuples(
        st.floats(-0.8, 2.6), st.floats(-1.8, 1.6), st.floats(0.05, 0.8), st.floats(0.05, 0.8)
    ).map(lambda box: (box[0], box[1], min(box[0] + box[2], 2.9), min(box[1] + box[3], 1.9))),
    max_size=6,
)
BENDS = st.lists(
    st.tuples(st.floats(-0.7, 2.7), st.floats(-1.7, 1.7)), min_size=3, max_size=7, unique=True
)
THINGS = st.lists(
    st.tuples(st.floats(-0.5, 2.5), st.floats(-1.5, 1.5), st.floats(0.02, 0.2)), max_size=3
)


def fit_of(map: OccupancyMap) -> FitMap:
    return FitMap.build(map, RADIUS, CLEARANCE)


def length_of(way: Floats) -> float:
    return float(np.hypot(*np.diff(way, axis=0).T).sum())


def rooms_along(way: Floats, fit: FitMap) -> list[float]:
    corners = [(float(x), float(y)) for x, y in way]
    return [fit.room_along(*leg) for leg in pairwise(corners)]


def walls_of(map: OccupancyMap) -> shapely.Geometry:
    """What is solid, m."""
    frame = map.frame
    rows, columns = np.nonzero(map.solid)
    left, low = columns * 0.05 + frame.origin_x, rows * 0.05 + frame.origin_y
    return shapely.union_all(shapely.box(left, low, left + 0.05, low + 0.05))


def times_around(way: Floats, other: Floats, points: Floats) -> Floats:
    """How often the loop of a way and back by another one goes around each point, [n]."""
    loop = np.concatenate((way, other[::-1]))
    spokes = loop[None] - points[:, None]
    angles = np.arctan2(spokes[..., 1], spokes[..., 0])
    turns = np.diff(np.concatenate((angles, angles[:, :1]), axis=1), axis=1)
    whole: Floats = np.round(((turns + math.pi) % (2.0 * math.pi) - math.pi).sum(axis=1), 6)
    return whole


@given(BOXES, BENDS, THINGS)
@settings(max_examples=examples(300), deadline=None)
def test_a_pulled_way_is_shorter_keeps_its_room_and_passes_things_on_the_same_side(
    boxes: list[Box], bends: list[Point], things: list[tuple[float, float, float]]
) -> None:
    map = room(*boxes)
    walls = fit_of(map)
    way = np.array(bends)
    far_off = [(x, y, radius + BESIDE) for x, y, radius in things]
    assume(min(rooms_along(way, walls.with_obstacles(far_off))) >= ROOM)
    string = StringPulling(walls)
    pulled = string.pulled(way, things)
    assert length_of(pulled) <= length_of(way) + 1e-9
    assert np.array_equal(pulled[[0, -1]], way[[0, -1]])
    line = shapely.LineString(pulled)
    assert line.distance(walls_of(map)) >= ROOM * (1.0 - CHORD) - 1e-9
    for x, y, radius in things:
        assert line.distance(shapely.Point(x, y)) >= (ROOM + BESIDE + radius) * (1.0 - CHORD) - 1e-9
    middles = np.argwhere(map.solid)[:, ::-1] * 0.05 + (-0.975, -1.975)
    passed = np.concatenate((middles, np.array(things).reshape(-1, 3)[:, :2]))
    assert (times_around(way, pulled, passed) == 0.0).all()
    again = string.pulled(pulled, things)
    assert length_of(again) == pytest.approx(length_of(pulled), abs=2e-3)


@given(BOXES, BENDS)
@settings(max_examples=examples(150), deadline=None)
def test_no_way_beside_a_pulled_one_is_shorter(boxes: list[Box], bends: list[Point]) -> None:
    """Between any two of its points the straight line, if it is shorter, would hit a wall."""
    map = room(*boxes)
    walls = fit_of(map)
    way = np.array(bends)
    assume(min(rooms_along(way, walls)) >= ROOM)
    pulled = StringPulling(walls).pulled(way)
    closed = walls_of(map).buffer(ROOM * 0.998, quad_segs=64)
    for before, bend, after in zip(pulled, pulled[1:], pulled[2:], strict=False):
        swept = shapely.Polygon((before, bend, after))
        if swept.area > 1e-9:
            # Close to the bend: two steps of an arc are all that a string leaves.
            assert swept.buffer(ROOM * 0.01).intersects(closed)


def quarter_around(reach: float) -> float:
    """Length from (-1, -reach) to (reach, 1) around the corner (0, 0), of which NW is solid."""
    return 2.0 + 0.5 * math.pi * reach


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("mirrored", [False, True])
def test_around_one_corner_it_is_a_quarter_of_a_circle(turns: int, mirrored: bool) -> None:
    solid = np.zeros((80, 80), np.bool_)
    solid[40:, :40] = True
    way = np.array(((-1.0, -ROOM), (0.6, -0.6), (ROOM, 1.0)))
    # The frame's middle is at (1, 0).
    if mirrored:
        solid, way = solid[:, ::-1], way * (-1.0, 1.0)
    turn = turns * 0.5 * math.pi
    matrix = np.array(((math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))))
    map = occupancy(np.rot90(solid, -turns))
    walls = fit_of(map)
    pulled = StringPulling(walls).pulled(way @ matrix + (1.0, 0.0))
    exact = quarter_around(ROOM)
    assert exact * 0.9998 < length_of(pulled) < exact
    assert np.allclose(np.hypot(*(pulled[1:-1] - (1.0, 0.0)).T), ROOM)


def test_around_a_round_thing_it_follows_its_circle() -> None:
    reach = ROOM + BESIDE + 0.15
    way = np.array(((0.0, 0.0), (1.0, 0.7), (2.0, 0.0)))
    pulled = StringPulling(fit_of(room())).pulled(way, [(1.0, 0.0, 0.15)])
    tangent, angle = math.sqrt(1.0 - reach**2), math.pi - 2.0 * math.acos(reach)
    exact = 2.0 * tangent + angle * reach
    assert exact * 0.999 < length_of(pulled) < exact * 1.0005


@given(
    st.floats(-12.0, -5.0),
    st.tuples(*[st.floats(-1.0, 1.0)] * 3),
    st.floats(-1.2, 1.2),
    st.floats(-1.2, 1.2),
)
@settings(max_examples=examples(200), deadline=None)
def test_around_things_that_are_nearly_one_it_comes_to_an_end(
    exponent: float, apart: tuple[float, float, float], start: float, goal: float
) -> None:
    """A thing that was felt twice, or felt and seen, is two things at nearly one place."""
    x, y, larger = (10.0**exponent * each for each in apart)
    things = [(1.0, 0.0, 0.06), (1.0 + x, y, 0.06 + abs(larger))]
    way = np.array(((0.0, start), (1.0, 0.5), (2.0, goal)))
    pulled = StringPulling(fit_of(room())).pulled(way, things)
    assert length_of(pulled) <= length_of(way) + 1e-9
    assert len(pulled) <= len(way) + 2 * HALF_AROUND


def test_a_way_closer_to_a_thing_than_to_be_pulled_around_it_stays() -> None:
    way = np.array(((0.0, 0.0), (1.0, ROOM + 0.16), (2.0, 0.0)))
    pulled = StringPulling(fit_of(room())).pulled(way, [(1.0, 0.0, 0.15)])
    assert np.array_equal(pulled, way)


def test_legs_with_too_little_room_stay_as_they_are() -> None:
    map = room((0.5, -2.0, 1.5, 0.0), (0.5, 0.38, 1.5, 2.0))
    walls = fit_of(map)
    # The gap of 0.4 m lets the body pass, but not with the clearance wanted.
    way = np.array(
        ((-0.6, -1.0), (-0.6, 0.9), (0.1, 0.2), (0.4, 0.2), (1.6, 0.2), (2.0, 0.3), (2.6, 1.3))
    )
    pulled = StringPulling(walls).pulled(way)
    among = {tuple(point) for point in pulled.tolist()}
    assert {(0.4, 0.2), (1.6, 0.2)} <= among
    assert not {(-0.6, 0.9), (0.1, 0.2), (2.0, 0.3)} & among
    assert length_of(pulled) < length_of(way) - 1.0


def test_without_a_bend_nothing_is_pulled() -> None:
    walls = fit_of(room())
    way = np.array(((0.0, 0.0), (1.0, 0.5)))
    assert StringPulling(walls).pulled(way) is way


def test_a_disc_smaller_than_a_cell_is_not_pulled() -> None:
    walls = FitMap.build(occupancy(np.zeros((9, 9), np.bool_), resolution=1.0), 0.2, 0.0)
    string = StringPulling(walls)
    way = np.array(((0.0, 0.0), (1.0, 0.5), (2.0, 0.0)))
    assert string.room == 0.0
    assert string.pulled(way) is way


def test_a_way_with_more_bends_than_there_was_room_for() -> None:
    """A comb of walls: at each tooth's tip the way goes around two corners."""
    teeth = [
        (x, -1.95, x + 0.1, 1.0) if n % 2 else (x, -1.0, x + 0.1, 1.95)
        for n, x in enumerate(np.arange(-0.4, 2.4, 0.6))
    ]
    walls = fit_of(room(*teeth))
    heights = [1.0 + 0.5 if n % 2 else -1.0 - 0.5 for n in range(len(teeth))]
    bends = [
        (float(x) + side, height)
        for (x, *_), height in zip(teeth, heights, strict=True)
        for side in (-0.25, 0.35)
    ]
    way = np.array([(-0.65, 0.0), *bends, (2.45, 0.0)])
    string = StringPulling(walls)
    string._make_room(4)
    pulled = string.pulled(way)
    assert len(pulled) > 60
    assert length_of(pulled) < length_of(way)
    assert min(rooms_along(pulled, walls)) >= ROOM * (1.0 - CHORD) - 1e-9
