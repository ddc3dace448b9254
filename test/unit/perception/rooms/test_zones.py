"""No-go zones and virtual walls: which cells they cover, and which make no sense."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from roomba.errors import RoombaError
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.rooms.zones import (
    WALL_WIDTH,
    Corners,
    Zone,
    ZoneKind,
    Zones,
    ZonesError,
    _touched,
)
from roomba.vocabulary import MOST_CORNERS, MOST_ZONES

FRAME = GridFrame(0.05, -0.5, 0.25, 30, 40)
LEFT, RIGHT, LOW, HIGH = FRAME.extent
NO_GO, WALL = ZoneKind.NO_GO, ZoneKind.WALL


def area(left: float, low: float, right: float, high: float, name: str = "rug") -> Zone:
    return Zone(name, NO_GO, ((left, low), (right, low), (right, high), (left, high)))


def squares() -> list[list[shapely.Geometry]]:
    half = 0.5 * FRAME.resolution
    made = []
    for row in range(FRAME.rows):
        middles = [FRAME.centre_of(row, column) for column in range(FRAME.columns)]
        made.append([shapely.box(x - half, y - half, x + half, y + half) for x, y in middles])
    return made


SQUARES = np.array(squares(), dtype=object)

numbers = st.tuples(
    st.floats(LEFT - 0.2, RIGHT + 0.2), st.floats(LOW - 0.2, HIGH + 0.2), st.floats(0.1, 1.0)
)


@given(numbers, st.floats(0.12, 1.0))
def test_an_area_along_the_axes_covers_the_cells_that_it_touches_exactly(
    place: tuple[float, float, float], height: float
) -> None:
    x, y, width = place
    cells = area(x, y, x + width, y + height).cells(FRAME)
    box = shapely.box(x, y, x + width, y + height)
    touched = shapely.area(shapely.intersection(SQUARES, box))
    assert cells[touched > 1e-9].all()
    assert not cells[shapely.distance(SQUARES, box) > 1e-9].any()


@given(st.lists(numbers, min_size=3, max_size=3), st.booleans())
@settings(max_examples=examples(40))
def test_slanted_ones_cover_what_they_touch_and_hardly_more(
    points: list[tuple[float, float, float]], is_wall: bool
) -> None:
    corners: Corners = tuple((x, y) for x, y, _ in points)
    sides = zip(corners, (*corners[1:], corners[0]), strict=True)
    assume(min(math.dist(a, b) for a, b in sides) > 0.05)
    polygon = shapely.Polygon(corners)
    assume(polygon.area > 0.02)
    shape = shapely.LineString(corners).buffer(0.5 * WALL_WIDTH) if is_wall else polygon
    cells = Zone("z", WALL if is_wall else NO_GO, corners).cells(FRAME)
    touched = shapely.area(shapely.intersection(SQUARES, shape))
    assert cells[touched > 1e-7].all()
    # At slanted sides and sharp corners a little more.
    far = shapely.distance(SQUARES, polygon if not is_wall else shape)
    assert not cells[far > 6.0 * FRAME.resolution].any()
    assert np.count_nonzero(cells & (far > FRAME.resolution)) < 0.2 * cells.sum() + 12


def test_a_wall_is_closed_along_all_of_its_line() -> None:
    zone = Zone("door", WALL, ((0.0, LOW), (0.62, HIGH)))
    free = ~zone.cells(FRAME)
    reached = np.zeros(FRAME.shape, np.bool_)
    reached[:, 0] = True
    for _ in range(200):
        grown = reached.copy()
        grown[1:] |= reached[:-1]
        grown[:-1] |= reached[1:]
        grown[:, 1:] |= reached[:, :-1]
        grown[:, :-1] |= reached[:, 1:]
        reached = grown & free
    assert not reached[:, -1].any()


def test_what_they_cover_is_occupied_and_the_map_is_left_alone() -> None:
    values = np.full(FRAME.shape, FREE, np.int8)
    values[0], values[:, 0] = OCCUPIED, UNKNOWN
    before = values.copy()
    occupancy = OccupancyMap(FRAME, values)
    zones = Zones((area(0.0, 0.5, 0.5, 1.0), area(0.8, 0.5, 1.0, 1.0, "mat")))
    known = zones.kept_out(occupancy)
    covered = zones.all[0].cells(FRAME) | zones.all[1].cells(FRAME)
    assert (values == before).all()
    assert (known.values[covered] == OCCUPIED).all()
    assert (known.values[~covered] == before[~covered]).all()
    assert known.frame == FRAME
    assert (Zones().kept_out(occupancy).values == before).all()


def test_edits_return_other_zones() -> None:
    rug, mat = area(0.0, 0.5, 0.5, 1.0), area(0.8, 0.5, 1.0, 1.0, "mat")
    zones = Zones().with_zone(rug).with_zone(mat)
    assert zones.names == ("rug", "mat")
    larger = area(0.0, 0.5, 0.7, 1.0)
    assert zones.with_zone(larger).all == (mat, larger)
    assert zones.all == (rug, mat)
    assert zones.without("rug").all == (mat,)
    with pytest.raises(ZonesError, match=r"'bed'.*rug, mat"):
        zones.without("bed")
    with pytest.raises(ZonesError, match="none"):
        Zones().without("bed")


@pytest.mark.parametrize(
    ("name", "kind", "points", "word"),
    [
        (" ", NO_GO, ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)), "name"),
        ("a", NO_GO, ((0.0, 0.0), (1.0, 0.0)), "3 to 200 points, got 2"),
        ("a", WALL, ((0.0, 0.0),), "2 to 200 points, got 1"),
        ("a", WALL, (), "2 to 200 points"),
        ("a", NO_GO, ((0.0, 0.0), (math.nan, 0.0), (1.0, 1.0)), "at most 100000 m"),
        ("a", WALL, ((0.0, 0.0), (math.inf, 0.0)), "at most 100000 m"),
        ("a", NO_GO, ((-1e6, 0.0), (1.0, 0.0), (1.0, 1.0)), "at most 100000 m"),
        ("a", NO_GO, ((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)), "simple outline"),
        ("a", WALL, ((0.5, 0.5), (0.5, 0.5)), "simple outline"),
        ("a", NO_GO, ((0.0, 0.0), (0.1, 0.0), (0.1, 0.09), (0.0, 0.09)), "0.01 m2"),
        ("a", NO_GO, ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), "expected"),
    ],
)
def test_what_makes_no_sense_is_refused(
    name: str, kind: ZoneKind, points: Corners, word: str
) -> None:
    with pytest.raises(ZonesError, match=word) as refused:
        Zone(name, kind, points)
    assert isinstance(refused.value, RoombaError)


def test_limits_are_told_before_anything_is_reckoned() -> None:
    round_one = tuple((math.cos(0.01 * i), math.sin(0.01 * i)) for i in range(MOST_CORNERS + 1))
    assert Zone("most", NO_GO, round_one[:-1]).points
    with pytest.raises(ZonesError, match="expected 3 to 200 points, got 201"):
        Zone("too many", NO_GO, round_one)
    with pytest.raises(ZonesError, match="got 200000"):
        Zone("far too many", NO_GO, 200_000 * ((math.nan, 0.0),))
    all_of_them = tuple(replace(area(0.0, 1.0, 1.0, 1.5), name=f"{n}") for n in range(MOST_ZONES))
    zones = Zones(all_of_them)
    assert zones.with_zone(area(0.0, 1.0, 0.5, 1.5, "7")).all[-1].name == "7"
    with pytest.raises(ZonesError, match="at most 1000 zones, got 1001; remove one first"):
        zones.with_zone(area(0.0, 1.0, 0.5, 1.5, "another"))


@pytest.mark.parametrize("name", ["", "  ", "a\nb", "a\0b", 81 * "a", 1_000_000 * "a"])
def test_names_that_cannot_be_told_are_refused_in_few_words(name: str) -> None:
    with pytest.raises(ZonesError, match="1 to 80 printable characters") as refusal:
        area(0.0, 1.0, 1.0, 1.5, name)
    assert len(str(refusal.value)) < 200
    with pytest.raises(ZonesError, match="expected the name of a zone") as refusal:
        Zones().without(name)
    assert len(str(refusal.value)) < 600


def test_an_edit_reckons_the_cells_of_one_zone() -> None:
    zones = Zones(tuple(area(0.01 * n, 1.0, 0.2 + 0.01 * n, 1.5, f"{n}") for n in range(50)))
    floor = OccupancyMap(FRAME, np.zeros(FRAME.shape, np.int8))
    zones.kept_out(floor)
    before = _touched.cache_info().misses
    kept_out = zones.with_zone(area(0.3, 0.3, 0.5, 0.8, "new")).kept_out(floor)
    assert _touched.cache_info().misses == before + 1
    assert kept_out.values[FRAME.cell_of(0.4, 0.5)] == OCCUPIED


def test_a_carpet_may_be_entered_and_is_told() -> None:
    corners: Corners = ((0.0, 0.5), (0.6, 0.5), (0.6, 1.0), (0.0, 1.0))
    rug, wall = Zone("rug", ZoneKind.CARPET, corners), Zone("wall", WALL, ((1.0, 0.5), (1.0, 1.2)))
    floor = OccupancyMap(FRAME, np.full(FRAME.shape, FREE, np.int8))
    both = Zones((rug, wall))
    assert Zones((rug,)).kept_out(floor) is floor
    assert np.array_equal(both.kept_out(floor).values != FREE, wall.cells(FRAME))
    assert np.array_equal(both.carpets(FRAME), Zone("rug", NO_GO, corners).cells(FRAME))
    assert both.has_carpets
    assert not Zones((wall,)).has_carpets
    assert both.is_carpet_at(0.3, 0.7)
    assert not both.is_carpet_at(0.7, 0.7)
    with pytest.raises(ZonesError, match="3 to"):
        Zone("rug", ZoneKind.CARPET, corners[:2])
