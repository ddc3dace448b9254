"""Whether two maps show the same floor: the shipped homes among each other, and changed ones."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from fixtures.robots.located import FURNISHED, MOVED
from fixtures.thoroughness import core_first

from roomba.commands.trials.homes import with_doors_shut
from roomba.configuration.mapping import FloorsConfig, MappingConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, wrap_angle
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.headless.mission import HeadlessMission
from roomba.perception.floors.recognition import FloorRecord
from roomba.perception.floors.same_floor import FloorMatch, match_floors
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home

NAMES = ("apartment", "empty", "family", "flat", "lshape", "studio")
TURNED = Pose(4.0, -3.0, math.pi / 2)
"""Where the frame of a map lies in that of the same map turned by a quarter."""


def matched(new: FloorRecord, old: FloorRecord) -> FloorMatch:
    return match_floors(new, old, FloorsConfig())


@cache
def shipped(name: str) -> Home:
    return load_home(name, HOMES)


def floor_of(home: Home, off: Pose | None = None) -> FloorRecord:
    """Return what the home's own map shows, the station a little off."""
    return FloorRecord(home.map, home.station.compose(off or Pose()))


def standing(home: Home) -> OccupancyMap:
    """Return what really stands there."""
    values = np.where(home.solid, OCCUPIED, FREE).astype(np.int8)
    return OccupancyMap(home.frame, np.where(home.map.values == UNKNOWN, UNKNOWN, values))


@cache
def made(name: str, seed: int, *, shut: bool = False) -> FloorRecord:
    """Return the map that a robot makes of a home, in a run of its own."""
    home = with_doors_shut(shipped(name)) if shut else shipped(name)
    robot = HeadlessMission(home, seed=seed, known=MappingConfig())
    record = robot.explore()
    return FloorRecord(record.occupancy, Pose(*robot.mapper.trajectory[0].tolist()))


def turned(floor: FloorRecord) -> FloorRecord:
    """Return the same map in a frame that is turned and moved."""
    frame = floor.occupancy.frame
    x, _, _, y = frame.extent
    corner = TURNED.compose(Pose(x, y))
    around = GridFrame(frame.resolution, corner.x, corner.y, frame.columns, frame.rows)
    # A quarter to the left: columns become rows, rows columns from the other end.
    values = np.ascontiguousarray(floor.occupancy.values.T[:, ::-1])
    return FloorRecord(OccupancyMap(around, values), TURNED.compose(floor.station))


def is_at(found: Pose, expected: Pose) -> bool:
    near = found.distance_to(expected.x, expected.y) < 0.04
    return near and abs(wrap_angle(found.theta - expected.theta)) < 0.01


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("off", [Pose(), Pose(0.05, -0.04, 0.06), Pose(-0.03, 0.05, -0.07)])
def test_a_home_is_itself_though_the_robot_docked_askew(name: str, off: Pose) -> None:
    home = shipped(name)
    match = matched(floor_of(home, off), floor_of(home))
    assert match.is_same
    assert match.walls > 0.99
    assert match.floor > 0.99
    assert is_at(match.old_in_new, Pose())


@pytest.mark.parametrize("name", ["family", "flat", "lshape"])
def test_a_home_in_another_frame_is_laid_on_itself(name: str) -> None:
    home = shipped(name)
    match = matched(turned(floor_of(home, Pose(-0.03, 0.05, -0.09))), floor_of(home))
    assert match.is_same
    assert is_at(match.old_in_new, TURNED)
    match = matched(floor_of(home), turned(floor_of(home)))
    assert match.is_same
    assert is_at(match.old_in_new, TURNED.inverse())


def test_a_station_that_was_moved_makes_no_other_home_of_the_same_frame() -> None:
    home = shipped("flat")
    moved = Pose(home.station.x + 2.0, home.station.y, home.station.theta + 1.0)
    match = matched(FloorRecord(home.map, moved), floor_of(home))
    assert match.is_same
    assert is_at(match.old_in_new, Pose())


@pytest.mark.parametrize(("one", "other"), list(itertools.permutations(NAMES, 2)))
def test_two_homes_are_not_the_same(one: str, other: str) -> None:
    match = matched(floor_of(shipped(one)), floor_of(shipped(other)))
    assert not match.is_same
    assert match.walls < 0.71


@pytest.mark.parametrize("name", core_first(["studio", "lshape"], {"studio"}))
def test_a_home_that_was_mapped_again_is_itself(name: str) -> None:
    match = matched(made(name, 1), made(name, 2))
    assert match.is_same
    assert match.walls > 0.95
    assert is_at(match.old_in_new, Pose())


def test_a_home_with_its_doors_shut_is_itself_and_no_other() -> None:
    part, whole = made("family", 1, shut=True), floor_of(shipped("family"))
    assert part.occupancy.free_area < 0.7 * whole.occupancy.free_area
    assert matched(part, whole).is_same
    assert matched(whole, part).is_same
    for other in NAMES:
        if other != "family":
            assert not matched(part, floor_of(shipped(other))).is_same
            assert not matched(floor_of(shipped(other)), part).is_same


def test_moved_furniture_makes_no_other_home() -> None:
    before = FloorRecord(standing(FURNISHED), FURNISHED.station)
    after = FloorRecord(standing(MOVED), FURNISHED.station)
    match = matched(after, before)
    assert match.is_same
    assert match.walls < 0.95


def test_maps_that_have_next_to_nothing_in_common_are_not_the_same() -> None:
    """The west of a home, and its east: where they touch they agree."""
    home = shipped("flat")
    values, middle = home.map.values, home.map.frame.columns // 2
    west, east = values.copy(), values.copy()
    west[:, middle:] = UNKNOWN
    east[:, : middle - 3] = UNKNOWN
    one, other = (OccupancyMap(home.map.frame, half) for half in (west, east))
    match = matched(FloorRecord(one, home.station), FloorRecord(other, home.station))
    assert match.floor < 0.2
    assert not match.is_same


def test_a_map_without_anything_on_it_is_no_floor() -> None:
    home = shipped("studio")
    for value in (UNKNOWN, FREE, OCCUPIED):
        nothing = OccupancyMap(home.map.frame, np.full_like(home.map.values, value))
        assert not matched(FloorRecord(nothing, home.station), floor_of(home)).is_same
        assert not matched(floor_of(home), FloorRecord(nothing, home.station)).is_same
        assert not matched(
            FloorRecord(nothing, home.station), FloorRecord(nothing, home.station)
        ).is_same


def test_coarser_cells_make_no_other_home() -> None:
    home = shipped("family")
    frame, values = home.map.frame, home.map.values
    fine = OccupancyMap(
        replace(
            frame, resolution=0.5 * frame.resolution, rows=2 * frame.rows, columns=2 * frame.columns
        ),
        np.repeat(np.repeat(values, 2, axis=0), 2, axis=1),
    )
    match = matched(FloorRecord(fine, home.station), floor_of(home))
    assert match.is_same
    assert match.floor > 0.99


@pytest.mark.parametrize("changed", [{}, {"least_walls": 1.0}, {"least_floor": 1.0}])
def test_how_much_maps_must_have_in_common_is_configured(changed: dict[str, float]) -> None:
    before = FloorRecord(standing(FURNISHED), FURNISHED.station)
    after = FloorRecord(standing(MOVED), FURNISHED.station)
    assert match_floors(after, before, FloorsConfig(**changed)).is_same is (changed == {})


@pytest.mark.parametrize("name", NAMES)
def test_a_map_that_was_edited_lies_exactly_on_itself(name: str) -> None:
    home = shipped(name)
    row, column = home.frame.cell_of(home.station.x, home.station.y)
    values = home.map.values.copy()
    values[row + 6 : row + 9, column - 2 : column + 3] = OCCUPIED
    match = matched(FloorRecord(OccupancyMap(home.frame, values), home.station), floor_of(home))
    assert match.is_same
    assert match.old_in_new == Pose()
