"""Walls of a layer file: rectangles, lines, arcs, and what they are made of."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from fixtures.homes.home_layers import STATION, loaded, value_at

from roomba.errors import HomeError
from roomba.grid import FREE, OCCUPIED
from roomba.world.home.home import Home
from roomba.world.home.surface import Finish

OUTER = """walls:
  - [-0.1, -0.1, 4.1, 0.0]
  - {area: [-0.1, 3.0, 4.1, 3.1], material: dark}
"""


def home_of(tmp_path: Path, *walls: str, furniture: str = "") -> Home:
    lines = "".join(f"  - {wall}\n" for wall in walls)
    return loaded(tmp_path, STATION + OUTER + lines + furniture)


def test_a_slanted_wall_is_exact_for_the_world_and_steps_for_the_robot(tmp_path: Path) -> None:
    home = home_of(tmp_path, "{line: [[1.0, 1.0], [2.0, 2.0]], thickness: 0.1}")
    # The wall's middle, a cell that it half fills, and one beside it.
    assert value_at(home, 1.525, 1.525) == (OCCUPIED, True, True)
    value, is_solid, is_wall = value_at(home, 1.575, 1.525)
    assert 0 < value < OCCUPIED
    assert (is_solid, is_wall) == (True, True)
    assert value_at(home, 1.725, 1.525) == (FREE, False, False)
    exact = home.exact
    assert exact.free_walls is not None
    (wall,) = exact.free_walls.walls
    assert wall.polygon.area == pytest.approx(0.1 * math.sqrt(2.0))
    assert not exact.solid[exact.frame.cell_of(1.575, 1.525)]
    assert exact.blocked[exact.frame.cell_of(1.575, 1.525)]


def test_a_round_wall_goes_counter_clockwise_from_one_direction_to_another(tmp_path: Path) -> None:
    arc = "{arc: {centre: [2.0, 1.5], radius: 1.0, from: 0.0, to: 1.5707963}, thickness: 0.2}"
    home = home_of(tmp_path, arc)
    for angle, is_there in ((0.1, True), (1.4, True), (-0.3, False), (1.9, False)):
        x, y = 2.0 + math.cos(angle), 1.5 + math.sin(angle)
        assert value_at(home, x, y)[1] == is_there


def test_what_the_map_does_not_show_is_solid_all_the_same(tmp_path: Path) -> None:
    pane = "{line: [[1.0, 1.0], [2.0, 1.2]], thickness: 0.02, material: glass, on_map: false}"
    home = home_of(tmp_path, pane)
    assert value_at(home, 1.5, 1.1)[:2] == (FREE, True)


def test_a_low_thing_stands_in_the_way_and_on_no_map(tmp_path: Path) -> None:
    furniture = "furniture:\n  - {name: lead, kind: cable, x: 2.0, y: 1.5, facing: 0.3}\n"
    home = home_of(tmp_path, furniture=furniture)
    assert value_at(home, 2.0, 1.5)[:2] == (FREE, True)
    assert home.exact.free_walls is not None
    (wall,) = home.exact.free_walls.walls
    assert wall.surface is not None
    assert wall.surface.finish is Finish.LOW


def test_materials_come_to_cells_and_faces(tmp_path: Path) -> None:
    furniture = (
        "furniture:\n"
        "  - {name: a, kind: wardrobe, x: 1.0, y: 2.6, facing: south, material: shiny}\n"
        "  - {name: b, kind: wardrobe, x: 3.0, y: 2.0, facing: 0.3, material: mirror}\n"
    )
    home = home_of(tmp_path, furniture=furniture).exact
    assert home.surfaces is not None
    assert home.surfaces[home.frame.cell_of(2.0, 3.05)] == 4
    assert home.surfaces[home.frame.cell_of(2.0, -0.05)] == 0
    assert home.surfaces[home.frame.cell_of(1.0, 2.6)] == 101
    assert home.free_walls is not None
    finishes = {wall.surface and wall.surface.finish for wall in home.free_walls.walls}
    assert finishes == {Finish.MIRROR}
    assert not home.solid[home.frame.cell_of(3.0, 2.0)] or not home.walls.all()


def test_a_layer_without_materials_has_neither_faces_nor_codes(tmp_path: Path) -> None:
    home = loaded(tmp_path, STATION + "walls:\n  - [-0.1, -0.1, 4.1, 0.0]\n")
    assert home.turned is None
    assert home.free_walls is None
    assert home.surfaces is None


@pytest.mark.parametrize(
    ("wall", "reason"),
    [
        ("{material: dark}", "exactly one of the keys"),
        ("{line: [[1.0, 1.0], [2.0, 2.0]]}", "thickness"),
        ("{line: [[1.0, 1.0], [1.0, 1.0]], thickness: 0.1}", "another than the one before"),
        ("{area: [1.0, 1.0, 2.0, 1.1], thickness: 0.1}", "thickness"),
        ("{area: [1.0, 1.0, 2.0, 1.1], on_map: false}", "on_map"),
        ("{line: [[1.0, 1.0], [2.0, 2.0]], thickness: 0.1, material: glas}", "glass"),
        ("{line: [[1.0, 1.0], [9.0, 2.0]], thickness: 0.1}", "on the map"),
        (
            "{line: [[1, 1], [2, 1], [2, 2], [1, 2], [1, 1]], thickness: 0.1}",
            "expected",
        ),
        (
            "{arc: {centre: [2.0, 1.5], radius: 1.0, from: 1.0, to: 0.5}, thickness: 0.2}",
            "'to' above 'from'",
        ),
        (
            "{arc: {centre: [2.0, 1.5], radius: 0.1, from: 0.0, to: 0.5}, thickness: 0.2}",
            "twice the radius",
        ),
        (
            "{arc: {centre: [2.0, 1.5], radius: 1.0e+9, from: 0.0, to: 3.0}, thickness: 0.2}",
            "radius.*10000",
        ),
        (
            "{arc: {centre: [2.0, 1.5], radius: 9000.0, from: 0.0, to: 3.0}, thickness: 0.2}",
            "on the map",
        ),
    ],
)
def test_what_is_no_wall_is_refused_with_its_line(tmp_path: Path, wall: str, reason: str) -> None:
    with pytest.raises(HomeError, match=reason) as refused:
        home_of(tmp_path, wall)
    assert "home.yaml:5" in str(refused.value)


def test_shut_cells_of_other_walls_stay_where_a_free_wall_meets_them(tmp_path: Path) -> None:
    home = home_of(tmp_path, "{line: [[1.0, -0.05], [1.0, 1.0]], thickness: 0.02}").exact
    row = home.frame.cell_of(1.0, -0.025)[0]
    assert home.solid[row].all()
    assert np.count_nonzero(home.solid[home.frame.cell_of(1.0, 0.5)[0], 10:-10]) == 0
