"""A home that changed: noticed when it is furniture, and nothing is made up."""

from __future__ import annotations

import math
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from fixtures.homes.rooms import Block, room_home
from fixtures.robots.located import CONFIG, LIDAR, Eye
from fixtures.thoroughness import core_first
from numpy.typing import NDArray

from roomba.configuration.mapping import MapChangesConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist
from roomba.grid import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from roomba.perception.floors.map_changes import Change, ChangeKind, MapChanges
from roomba.planning.path.costmap import FitMap
from roomba.raster.distance import distance_to_nearest
from roomba.world.home.home import Box, Home
from roomba.world.home.raster import covered_cells, footprint
from roomba.world.layers.assembly import standing_cells
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator

Mask = NDArray[np.bool_]
BEAMS = LIDAR.arrays()
EVERY = 0.4
"""s; between scans that are shown."""
APART = 0.7
"""s; the same, over the flat."""
ROOM = room_home(6.0, 5.0)
SOFA: Block = (2.0, 2.0, 4.0, 2.9)


@cache
def flat() -> Home:
    return load_home("flat", HOMES)


def block(x: float, y: float, theta: float, length: float, width: float) -> Mask:
    return covered_cells(
        flat().frame, [footprint(Box(x, y, theta, length, width, 0.0, 0.5, "wood"))]
    )


def piece(*names: str) -> Mask:
    pieces = [each for each in flat().furniture if each.name in names]
    assert len(pieces) == len(names)
    return standing_cells(flat().frame, pieces, CONFIG.body.height)


def changed_flat(added: Mask | None = None, removed: Mask | None = None) -> Home:
    """The flat as it is now; its map is the one from before."""
    solid = flat().solid.copy()
    solid &= ~removed if removed is not None else True
    solid |= added if added is not None else False
    return replace(flat(), solid=solid)


def to_and_fro(home: Home, step: float = 0.5) -> list[Pose]:
    """Return poses on lanes over the floor where there is room for the body."""
    occupied = np.where(home.solid, OCCUPIED, home.map.values).astype(np.int8)
    fits = FitMap.build(OccupancyMap(home.frame, occupied), CONFIG.body.radius, 0.03)
    x_min, x_max, y_min, y_max = home.frame.extent
    poses = []
    for number, y in enumerate(np.arange(y_min, y_max, step).tolist()):
        lane = [Pose(x, y, math.pi * (number % 2)) for x in np.arange(x_min, x_max, 0.2).tolist()]
        poses += [pose for pose in lane[:: 1 - 2 * (number % 2)] if fits.fits_at(pose.x, pose.y)]
    return poses


Meanwhile = Callable[[Simulator, int], None]


def cleaned(
    home: Home, occupancy: OccupancyMap | None = None, meanwhile: Meanwhile | None = None
) -> MapChanges:
    """Go over the flat once: the sensors' usual noise, and poses that are 2 cm and 0.5° off."""
    poses, random = to_and_fro(home), np.random.default_rng(3)
    world = Simulator(home, CONFIG, seed=3, start=poses[0])
    changes = MapChanges(occupancy or home.map, MapChangesConfig())
    for number, pose in enumerate(poses):
        # Where the robot goes people step aside.
        world.remove_obstacles()
        world.put(pose)
        if meanwhile is not None:
            meanwhile(world, number)
        now = world.step(Twist(), 0.12)
        off = Pose(*random.normal(0.0, (0.015, 0.015, math.radians(0.5))).tolist())
        changes.see(APART * number, world.ranges, BEAMS, now.pose.compose(off))
    assert changes.looks > 10
    return changes


def as_scanned(occupancy: OccupancyMap) -> OccupancyMap:
    """Return a map as a lidar makes it: unknown behind what it met."""
    values = occupancy.values.copy()
    values[distance_to_nearest(values == FREE) > 2.0] = UNKNOWN
    return OccupancyMap(occupancy.frame, values)


@pytest.mark.parametrize("is_scanned", core_first([False, True], {True}))
def test_where_nothing_changed_nothing_is_offered(is_scanned: bool) -> None:
    """The toy on the floor, which is not on the map, is no furniture."""
    occupancy = as_scanned(flat().map) if is_scanned else flat().map
    changes = cleaned(flat(), occupancy)
    assert changes.changes() == ()
    assert np.array_equal(changes.proposed().values, occupancy.values)


@pytest.mark.parametrize("theta", core_first([0.0, 0.6], {0.6}))
def test_a_sofa_that_was_added_is_noticed(theta: float) -> None:
    sofa = block(1.9, 2.25, theta, 2.1, 0.9)
    changes = cleaned(changed_flat(added=sofa))
    (change,) = changes.changes()
    assert change.kind is ChangeKind.APPEARED
    assert math.hypot(change.x - 1.9, change.y - 2.25) < 0.1
    box = np.argwhere(sofa)
    height, width = ((np.ptp(box, axis=0) + 1) * 0.05).tolist()
    assert change.width == pytest.approx(width, abs=0.2)
    assert change.height == pytest.approx(height, abs=0.2)
    assert 0.15 < change.area < 0.5
    proposed, before = changes.proposed().values, flat().map.values
    assert np.array_equal(np.argwhere((proposed == OCCUPIED) & (before == FREE)), change.cells)
    near = distance_to_nearest(sofa) <= 1.5
    assert np.array_equal(proposed[~near], before[~near])


def test_a_wall_of_boxes_is_noticed() -> None:
    boxes = block(7.3, 3.4, 0.1, 0.4, 0.3) | block(7.3, 3.7, 0.0, 0.35, 0.35)
    (change,) = cleaned(changed_flat(added=boxes)).changes()
    assert change.kind is ChangeKind.APPEARED
    assert math.hypot(change.x - 7.3, change.y - 3.55) < 0.1


@pytest.mark.parametrize("is_scanned", core_first([False, True], {True}))
def test_a_wardrobe_that_was_taken_away_is_noticed(is_scanned: bool) -> None:
    wardrobe = piece("wardrobe")
    occupancy = as_scanned(flat().map) if is_scanned else flat().map
    changes = cleaned(changed_flat(removed=wardrobe), occupancy)
    (change,) = changes.changes()
    assert change.kind is ChangeKind.VANISHED
    assert math.hypot(change.x - 8.4, change.y + 0.7) < 0.1
    proposed = changes.proposed().values
    assert np.mean(proposed[wardrobe] == FREE) > 0.85
    assert np.array_equal(proposed[~wardrobe] == FREE, occupancy.values[~wardrobe] == FREE)
    if is_scanned:
        # The wall behind it was never seen before.
        new_wall = (proposed == OCCUPIED) & (occupancy.values == UNKNOWN)
        assert np.count_nonzero(new_wall) > 20
        assert flat().walls[new_wall].mean() > 0.8


def test_people_who_walk_about_are_no_change() -> None:
    def walk(world: Simulator, number: int) -> None:
        angle = 0.35 * number
        for x, y in ((2.2, 2.8), (5.2, 3.0), (7.2, 3.6)):
            at_x = x + math.sin(0.31 * angle + x)
            at_y = y + 1.2 * math.cos(0.47 * angle)
            for side in (-0.1, 0.1):
                put_foot(world, at_x + side, at_y + 0.1 * math.sin(angle + 20.0 * side))

    assert cleaned(flat(), meanwhile=walk).changes() == ()


def test_people_who_stand_about_for_a_minute_are_no_change() -> None:
    def stand(world: Simulator, number: int) -> None:
        x, y = ((2.0, 0.4), (5.2, 3.0), (7.2, 3.2), (2.2, 5.6))[number // 80 % 4]
        for side in (-0.1, 0.1):
            put_foot(world, x + side, y)

    assert cleaned(flat(), meanwhile=stand).changes() == ()


def put_foot(world: Simulator, x: float, y: float) -> None:
    """Put it down where it fits, not on the robot."""
    here = world.pose
    if here.distance_to(x, y) > 0.3:
        world.place_obstacle(x, y, 0.05)


def test_chairs_that_were_moved_are_no_change() -> None:
    before, now = np.zeros(flat().frame.shape, np.bool_), np.zeros(flat().frame.shape, np.bool_)
    moves = {
        "dining chair 1": (4, 0),
        "dining chair 2": (0, 4),
        "dining chair 3": (-4, 2),
        "kitchen chair 1": (0, 5),
        "desk chair": (5, -4),
    }
    for name, (rows, columns) in moves.items():
        before |= piece(name)
        now |= np.roll(piece(name), (rows, columns), (0, 1))
    before &= ~piece("dining table", "kitchen table", "desk")
    assert cleaned(changed_flat(now, before)).changes() == ()


def test_a_sofa_that_was_moved_is_a_change_when_it_is_far_enough() -> None:
    sofa = piece("sofa")
    moved = [np.roll(sofa, -columns, 1) for columns in (2, 10)]
    assert cleaned(changed_flat(moved[0], sofa)).changes() == ()
    kinds = {change.kind for change in cleaned(changed_flat(moved[1], sofa)).changes()}
    assert kinds == {ChangeKind.APPEARED, ChangeKind.VANISHED}


class Walker:
    """Walks around in a room, and shows what it sees."""

    def __init__(self, home: Home = ROOM) -> None:
        self.changes = MapChanges(home.map, MapChangesConfig())
        self.now = 0.0
        self._random = np.random.default_rng(1)

    def go_around(self, home: Home, rounds: int = 4) -> Sequence[Change]:
        """Go around near the walls of the room as it is now."""
        eye = Eye(home)
        for _ in range(rounds):
            for turn in np.linspace(0.0, 2.0 * math.pi, 60, endpoint=False).tolist():
                pose = Pose(3.0 + 2.4 * math.cos(turn), 2.5 + 1.9 * math.sin(turn), turn)
                self.show(eye, pose)
        return self.changes.changes()

    def show(self, eye: Eye, pose: Pose) -> None:
        self.now += EVERY
        self.changes.see(self.now, eye.scan(pose, self._random), BEAMS, pose)


def room(*blocks: Block) -> Home:
    """The room with things in it that its map does not show."""
    return replace(room_home(6.0, 5.0, blocks), map=ROOM.map)


def test_what_is_enclosed_is_no_longer_known() -> None:
    walker = Walker()
    (change,) = walker.go_around(room(SOFA))
    assert math.hypot(change.x - 3.0, change.y - 2.45) < 0.04
    values = walker.changes.proposed().values
    middle = ROOM.frame.cell_of(3.0, 2.45)
    assert values[middle] == UNKNOWN
    assert values[ROOM.frame.cell_of(1.0, 1.0)] == FREE
    unknown = np.argwhere(values == UNKNOWN)
    assert len(unknown) == pytest.approx(2.0 * 0.9 / 0.0025 - len(change.cells), abs=60)


def test_it_takes_several_looks() -> None:
    walker = Walker()
    assert walker.go_around(room(SOFA), 1) == ()
    assert walker.changes.looks == 1
    walker.go_around(room(SOFA), 1)
    assert walker.changes.changes() == ()
    assert len(walker.go_around(room(SOFA), 2)) == 1
    assert walker.changes.looks <= 6


def test_standing_it_learns_nothing_however_long() -> None:
    walker, eye = Walker(), Eye(room(SOFA))
    for _ in range(2000):
        walker.show(eye, Pose(1.0, 1.0, 0.0))
    assert walker.changes.looks == 0
    assert walker.changes.changes() == ()


def test_what_stands_there_only_while_the_robot_stands_counts_once() -> None:
    walker, eye = Walker(), Eye(room(SOFA))
    for _ in range(6):
        for _ in range(300):
            walker.show(eye, Pose(5.4, 2.5, 0.0))
        assert walker.go_around(ROOM, 1) == ()


def test_turning_on_the_spot_is_no_look_from_elsewhere() -> None:
    walker, eye = Walker(), Eye(room(SOFA))
    for number in range(300):
        walker.show(eye, Pose(1.0, 1.0, 0.3 * number))
    assert walker.changes.looks == 0


def test_a_clock_that_is_set_back_delays_nothing() -> None:
    walker = Walker()
    walker.now = 1e6
    walker.go_around(room(SOFA), 1)
    walker.now = 0.0
    assert len(walker.go_around(room(SOFA), 4)) == 1


def test_what_is_taken_away_again_is_no_change_any_more() -> None:
    walker = Walker()
    assert len(walker.go_around(room(SOFA))) == 1
    assert walker.go_around(ROOM, 8) == ()
    assert np.array_equal(walker.changes.proposed().values, ROOM.map.values)


def test_what_came_long_after_is_noticed_as_soon() -> None:
    walker = Walker()
    walker.go_around(ROOM, 30)
    looks = walker.changes.looks
    assert len(walker.go_around(room(SOFA), 7)) == 1
    assert walker.changes.looks - looks <= 11


def test_what_was_dismissed_is_not_offered_again() -> None:
    walker = Walker()
    (change,) = walker.go_around(room(SOFA))
    walker.changes.dismissed(change)
    assert walker.changes.changes() == ()
    assert walker.go_around(room(SOFA)) == ()
    assert np.array_equal(walker.changes.proposed().values, ROOM.map.values)


def test_what_was_dismissed_and_became_different_is_offered_again() -> None:
    walker = Walker()
    (change,) = walker.go_around(room(SOFA))
    walker.changes.dismissed(change)
    (larger,) = walker.go_around(room(SOFA, (2.0, 2.9, 2.6, 3.5)), 8)
    assert larger.area > change.area


def test_another_change_is_offered_though_one_was_dismissed() -> None:
    walker = Walker()
    (change,) = walker.go_around(room(SOFA))
    walker.changes.dismissed(change)
    (other,) = walker.go_around(room(SOFA, (4.6, 1.6, 4.8, 2.6)), 8)
    assert other.x == pytest.approx(4.7, abs=0.05)


def test_the_largest_comes_first() -> None:
    found = Walker().go_around(room(SOFA, (4.6, 1.6, 4.8, 2.6)))
    areas = [change.area for change in found]
    assert len(areas) == 2
    assert areas == sorted(areas, reverse=True)


@pytest.mark.parametrize(("width", "count"), [(0.15, 0), (0.25, 0), (0.6, 1)])
def test_small_things_are_no_change(width: float, count: int) -> None:
    assert len(Walker().go_around(room((2.0, 2.0, 2.0 + width, 2.15)))) == count


@pytest.mark.parametrize(("out", "count"), [(0.10, 0), (0.30, 1)])
def test_what_is_at_a_wall_counts_when_it_sticks_out(out: float, count: int) -> None:
    """Nearer to the wall it could be the wall, seen from a pose that is a little off."""
    assert len(Walker().go_around(room((2.0, 0.0, 3.2, out)))) == count


def test_it_needs_no_more_memory_the_longer_it_looks() -> None:
    walker = Walker()
    walker.go_around(room(SOFA), 1)
    eye = Eye(room(SOFA))
    tracemalloc.start()
    try:
        for number in range(500):
            walker.show(eye, Pose(1.0 + 0.002 * number, 1.0, 0.3 * number))
        grown, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert grown < 50_000
