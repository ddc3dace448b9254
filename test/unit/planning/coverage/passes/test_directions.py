"""Main directions of walls, of rooms that are turned by a known angle."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.turned_rooms import turned_room
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.arrays import Mask
from roomba.configuration.coverage import CoverageConfig
from roomba.grid import OccupancyMap
from roomba.planning.coverage.floor.floor import CoverageFloor
from roomba.planning.coverage.passes.directions import line_along, main_directions


def middles_of(map: OccupancyMap) -> Mask:
    return CoverageFloor.build(map, 0.165, 0.2, CoverageConfig()).middles((0.0, 0.0))


@given(st.floats(3.0, 87.0))
@settings(max_examples=examples(25))
def test_the_walls_of_a_turned_room_tell_by_how_much_it_is_turned(degrees: float) -> None:
    middles = middles_of(turned_room(4.5, 3.0, degrees, (1.2, 0.9, 1.0, 0.6)))
    (found,) = main_directions(middles)
    off = (math.degrees(found) - degrees + 45.0) % 90.0 - 45.0
    assert abs(off) < 1.0
    assert -45.0 < math.degrees(found) <= 45.0


@pytest.mark.parametrize("degrees", [0.0, 90.0])
def test_walls_along_the_axes_are_none(degrees: float) -> None:
    assert main_directions(middles_of(turned_room(4.5, 3.0, degrees))) == []


def test_what_is_round_has_no_direction() -> None:
    y, x = np.mgrid[-200.0:201.0, -200.0:201.0]
    assert main_directions(np.hypot(x, y) < 190.0) == []


def test_of_two_directions_the_commoner_comes_first() -> None:
    """A room along the axes, with one corner cut off."""
    y, x = np.mgrid[0.0:500.0, 0.0:500.0]
    cut = np.cos(math.radians(60.0)) * x + np.sin(math.radians(60.0)) * y < 500.0
    fenced = np.pad(cut, 1)
    (found,) = main_directions(fenced)
    assert math.degrees(found) == pytest.approx(-30.0, abs=0.5)
    turned = turned_room(6.0, 4.0, 20.0)
    x, y = np.meshgrid(*turned.frame.centres())
    turned.values[np.cos(math.radians(-30.0)) * x + np.sin(math.radians(-30.0)) * y > 1.0] = 100
    first, second = (math.degrees(angle) for angle in main_directions(middles_of(turned)))
    assert first == pytest.approx(20.0, abs=1.0)
    assert second == pytest.approx(-30.0, abs=1.0)


@pytest.mark.parametrize(("aside", "expected"), [(1.4, True), (1.6, False)])
def test_a_window_is_straight_when_it_lies_within_its_band(aside: float, expected: bool) -> None:
    along = np.arange(50.0)
    points = np.column_stack((along, 0.5 * along))
    points[::2] += np.array([-0.5, 1.0]) / math.hypot(1.0, 0.5) * aside
    is_straight, angle = line_along(points, 0, 50, 1.5)
    assert is_straight == expected
    assert math.tan(angle) == pytest.approx(0.5, abs=0.01)
