"""In a drawn plan the station is in the home, not on the paper around it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from roomba.files.occupancy_map import save_map
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.world.home.home import Home, StationPlace
from roomba.world.layers.layer import EVEN_DIRT, load_home
from roomba.world.layers.paper import off_paper


def plan(home: float = 3.0, end: int = FREE) -> OccupancyMap:
    """Return paper of 8 x 8 m, and a square home in its middle, m wide, its walls around it."""
    values = np.full((160, 160), FREE, np.int8)
    values[:, 0] = values[:, -1] = values[0] = values[-1] = end
    half = round(home / 2.0 / 0.05)
    for grown, value in ((2, OCCUPIED), (0, FREE)):
        place = slice(80 - half - grown, 80 + half + grown)
        values[place, place] = value
    return OccupancyMap(GridFrame(0.05, 0.0, 0.0, 160, 160), values)


def home_of(drawn: OccupancyMap, folder: Path, station: Pose | None = None) -> Home:
    save_map(drawn, folder / "map.yaml")
    return load_home(str(folder), folder, station=station)


def is_inside(home: Home, width: float = 3.0) -> bool:
    return max(abs(home.station.x - 4.0), abs(home.station.y - 4.0)) < width / 2.0


def test_the_station_is_in_the_home_and_not_on_the_paper(tmp_path: Path) -> None:
    home = home_of(plan(), tmp_path)
    assert is_inside(home)
    assert home.station_place is StationPlace.FOUND


@pytest.mark.parametrize("station", [None, Pose(4.0, 4.0, 0.0)])
def test_the_paper_around_a_home_is_no_floor(tmp_path: Path, station: Pose | None) -> None:
    home = home_of(plan(), tmp_path, station)
    for x, y in ((1.0, 1.0), (7.9, 4.0), (2.0, 7.9)):
        cell = home.map.frame.cell_of(x, y)
        assert home.map.values[cell] == UNKNOWN
        assert home.solid[cell]
    # The station is solid, or it leans on the wall.
    assert home.map.free_area == pytest.approx(9.0, abs=0.05)
    dirt = home.dirt_sources[0]
    assert dirt.amount == pytest.approx(EVEN_DIRT * home.map.free_area, rel=0.01)


def test_where_the_layer_has_dirt_it_is_no_paper(tmp_path: Path) -> None:
    """Such as a terrace around the house."""
    crumbs = "dirt_sources: [{name: crumbs, x: 1.0, y: 1.0, radius: 0.2, amount: 1.0}]\n"
    (tmp_path / "home.yaml").write_text(crumbs)
    home = home_of(plan(), tmp_path, Pose(4.0, 4.0, 0.0))
    assert home.map.values[home.map.frame.cell_of(1.0, 1.0)] == FREE


def test_what_is_too_small_for_a_home_is_none(tmp_path: Path) -> None:
    home = home_of(plan(home=1.0), tmp_path)
    assert not is_inside(home, 1.0)
    assert home.station_place is StationPlace.ON_PAPER


@pytest.mark.parametrize("end", [OCCUPIED, UNKNOWN])
def test_floor_that_has_an_end_is_no_paper(tmp_path: Path, end: int) -> None:
    home = home_of(plan(end=end), tmp_path)
    assert not is_inside(home)
    assert home.station_place is StationPlace.FOUND


def test_a_map_that_was_cut_off_within_a_home_is_no_paper(tmp_path: Path) -> None:
    cut = plan()
    cut.values[:, :2] = cut.values[:2] = cut.values[-2:] = OCCUPIED
    assert not is_inside(home_of(cut, tmp_path))


def test_a_map_that_is_all_floor_is_a_home(tmp_path: Path) -> None:
    frame = GridFrame(0.05, 0.0, 0.0, 60, 60)
    home = home_of(OccupancyMap(frame, np.zeros(frame.shape, np.int8)), tmp_path)
    assert home.station_place is StationPlace.ON_PAPER


@pytest.mark.parametrize("has_closet", [False, True])
def test_a_home_with_a_gap_at_the_end_of_the_paper_is_no_paper(
    tmp_path: Path, has_closet: bool
) -> None:
    drawn = plan(home=6.0)
    # A corridor of 1 m that is drawn open, and a room to which no door leads.
    drawn.values[70:90, 20:] = FREE
    drawn.values[[68, 69, 90, 91], 138:] = OCCUPIED
    if has_closet:
        drawn.values[20:62, 96:100] = drawn.values[58:62, 96:140] = OCCUPIED
    home = home_of(drawn, tmp_path)
    assert is_inside(home, 6.0)
    assert not (home.station.x > 4.9 and home.station.y < 3.0)
    assert home.station_place is StationPlace.FOUND


def test_a_person_may_put_it_on_the_paper(tmp_path: Path) -> None:
    home = home_of(plan(), tmp_path, Pose(1.0, 1.0, 0.0))
    assert home.station_place is StationPlace.TOLD
    assert home.map.values[home.map.frame.cell_of(7.0, 7.0)] == FREE
    assert home.map.values[home.map.frame.cell_of(4.0, 4.0)] == FREE


def test_a_robot_on_paper_keeps_all_paper(tmp_path: Path) -> None:
    parted = plan(home=1.0)
    parted.values[:, 60] = OCCUPIED
    home = home_of(parted, tmp_path)
    assert home.station_place is StationPlace.ON_PAPER
    for x in (1.0, 7.0):
        assert home.map.values[home.map.frame.cell_of(x, 7.0)] == FREE


def test_of_small_plans_a_share_is_enough() -> None:
    floor = np.zeros((20, 40), np.bool_)
    floor[2:18, 2:12] = floor[4:12, 20:26] = True  # 0.4 and 0.12 m²
    end = np.zeros_like(floor)
    end[:2] = True
    found = off_paper(floor, end, 0.1, 0.05)
    assert found[5, 22]
    assert not found[5, 5]
    floor[4:12, 23:26] = False
    assert off_paper(floor, end, 0.1, 0.05)[5, 5]
