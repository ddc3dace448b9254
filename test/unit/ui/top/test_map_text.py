"""The map in characters shows each thing at its place, at any size."""

import math

import numpy as np
import pytest

from roomba.ui.top.grids import Grid
from roomba.ui.top.map_text import FREE, ROBOT, STATION, SWEPT, WALL, WAY, map_text

HOME = {"station": [0.55, 0.5, 0.0]}


def room() -> dict[str, Grid]:
    """A room of 4 m by 2 m with walls of 0.1 m, whose left half was swept, in a larger grid."""
    cells = np.zeros((60, 100), np.uint8)
    cells[10:50, 10:90] = 2
    cells[12:48, 12:88] = 1
    swept = np.zeros((60, 100), np.uint8)
    swept[12:48, 12:50] = 3
    grids = (Grid(0.05, -0.5, -0.5, cells), Grid(0.05, -0.5, -0.5, swept))
    return dict(zip(("map", "coverage"), grids, strict=True))


def lines(state: dict[str, object], size: tuple[int, int]) -> list[str]:
    return map_text(room(), state, HOME, size).plain.splitlines()


def test_it_shows_walls_floor_what_was_swept_the_way_station_and_robot() -> None:
    state = {"pose": [3.05, 1.5, 0.0], "path": [305, 150, 315, 150, 355, 150]}
    drawn = lines(state, (40, 10))
    assert len(drawn) == 10
    assert {len(line) for line in drawn} == {40}
    assert drawn[0] == drawn[-1] == WALL * 40
    assert all(line[0] == line[-1] == WALL for line in drawn)
    assert drawn[5][2:18] == SWEPT * 16
    assert drawn[5][22:38] == FREE * 16
    # North is up: the robot at y 1.5 m of 2 m, the station at 0.5 m.
    assert drawn[2][30] == ROBOT[0]
    assert drawn[2][35] == WAY
    assert drawn[7][5] == STATION


@pytest.mark.parametrize(
    ("degrees", "shown"), [(0, "▶"), (90, "▲"), (180, "◀"), (-90, "▼"), (45, "◥"), (359, "▶")]
)
def test_the_robot_looks_where_it_does(degrees: float, shown: str) -> None:
    drawn = "\n".join(lines({"pose": [2.0, 1.0, math.radians(degrees)]}, (60, 20)))
    assert drawn.count(shown) == 1


@pytest.mark.parametrize("size", [(1, 1), (5, 40), (200, 3), (200, 100)])
def test_it_fits_any_terminal(size: tuple[int, int]) -> None:
    drawn = lines({"pose": [2.0, 1.0, 0.0]}, size)
    assert 1 <= len(drawn) <= size[1]
    assert max(map(len, drawn)) <= size[0]


def test_without_a_map_it_says_so() -> None:
    empty = {"map": Grid(0.05, 0.0, 0.0, np.zeros((4, 4), np.uint8))}
    for grids in ({}, empty):
        assert map_text(grids, {}, {}, (10, 10)).plain == "no map yet"
