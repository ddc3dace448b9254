"""What the lidar sees and the map does not know: seen soon, forgotten soon, never made up."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import CONFIG, FURNISHED, LIDAR, TWO_ROOMS, Eye, Ranges, free_poses
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.things import ThingConfig
from roomba.geometry import Pose, Twist
from roomba.grid import UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

ROOM = room_home(6.0, 5.0)
HERE = Pose(2.0, 2.5, 0.3)
BEAMS = LIDAR.arrays()
Disc = tuple[float, float, float]


def layer_of(home: Home, config: ThingConfig | None = None) -> ThingLayer:
    return ThingLayer(SurfaceField.of(home.map), config)


def with_discs(ranges: Ranges, pose: Pose, *discs: Disc) -> Ranges:
    """Return the scan with round things in it."""
    angles = pose.theta + np.arange(len(ranges)) * (2.0 * np.pi / len(ranges))
    for x, y, radius in discs:
        ahead = (x - pose.x) * np.cos(angles) + (y - pose.y) * np.sin(angles)
        aside = (y - pose.y) * np.cos(angles) - (x - pose.x) * np.sin(angles)
        meets = (np.abs(aside) < radius) & (ahead > 0.0)
        way = ahead - np.sqrt(np.maximum(radius**2 - aside**2, 0.0))
        ranges = np.where(meets, np.minimum(ranges, way), ranges).astype(np.float32)
    return ranges


def seen(home: Home, *discs: Disc, scans: int = 10, pose: Pose = HERE) -> ThingLayer:
    layer = layer_of(home)
    ranges = with_discs(Eye(home).scan(pose), pose, *discs)
    for _ in range(scans):
        layer.see(ranges, BEAMS, pose)
    return layer


def is_covered(layer: ThingLayer, x: float, y: float, slack: float = 0.0) -> bool:
    return any(math.hypot(x - a, y - b) <= r + slack for a, b, r in layer.obstacles())


def test_three_scans_show_a_thing_and_two_do_not() -> None:
    disc = (3.0, 2.6, 0.15)
    assert seen(ROOM, disc, scans=2).obstacles() == []
    layer = seen(ROOM, disc, scans=3)
    assert is_covered(layer, 2.85, 2.58, 0.02)
    assert layer.version == 1
    for x, y, radius in layer.obstacles():
        assert math.hypot(x - 3.0, y - 2.6) < 0.15 + 0.05
        assert radius == ThingConfig().spot_radius


@pytest.mark.parametrize(("scans", "needed"), [(1, 3), (2, 2), (3, 2), (4, 2), (9, 2)])
def test_a_scan_that_stands_for_many_counts_more_but_is_never_enough(
    scans: int, needed: int
) -> None:
    layer = layer_of(ROOM)
    ranges = with_discs(Eye(ROOM).scan(HERE), HERE, (3.0, 2.6, 0.15))
    for count in range(1, needed + 1):
        layer.see(ranges, BEAMS, HERE, scans)
        assert bool(layer.obstacles()) == (count == needed)


def test_from_a_metre_things_are_seen_within_half_a_second() -> None:
    def put_chair(world: Simulator, x: float, y: float) -> None:
        away = math.hypot(0.2, 0.2)
        world.place_chair(Pose(x + away, y, 0.25 * math.pi))

    def put_disc(world: Simulator, x: float, y: float) -> None:
        world.place_obstacle(x + 0.15, y, 0.15)

    def shut_door(world: Simulator, x: float, y: float) -> None:
        for number in range(8):
            world.place_obstacle(x + 0.03, y - 0.42 + 0.12 * number, 0.06)

    for put in (put_chair, put_disc, shut_door):
        for seed in range(4):
            start = Pose(2.0, 2.5, 0.2 * seed)
            world, layer = Simulator(ROOM, CONFIG, seed=seed, start=start), layer_of(ROOM)
            random = np.random.default_rng(seed)
            put(world, 3.0, 2.5)
            began, scans = world.time, world.observe().scans
            while not is_covered(layer, 3.0, 2.5, 0.05):
                assert world.time - began <= 0.5, put.__name__
                now = world.step(Twist(0.0, float(random.uniform(-0.3, 0.3))), 0.05)
                if now.scans != scans:
                    scans = now.scans
                    layer.see(world.ranges, BEAMS, now.pose)
            assert len(layer.obstacles()) <= 36


def test_what_the_map_shows_is_no_thing_wherever_it_is_seen_from() -> None:
    """Noise of range, pose and heading, as a robot has that looks at each fourth scan."""
    random = np.random.default_rng(5)
    for home in (FURNISHED, TWO_ROOMS, ROOM):
        eye, layer = Eye(home), layer_of(home)
        for pose in free_poses(home, 25, random):
            for _ in range(6):
                off = Pose(*random.normal(0.0, (0.003, 0.003, math.radians(0.3))).tolist())
                layer.see(eye.scan(pose, random), BEAMS, pose.compose(off))
        assert layer.obstacles() == []
        assert layer.version == 0


@pytest.mark.parametrize("off", [0.03, 0.08, 0.15, 0.25])
@pytest.mark.parametrize("unsure", [0.005, 0.06])
def test_what_stands_at_a_wall_is_a_thing_if_it_sticks_out(off: float, unsure: float) -> None:
    """The wall is at x = 6, and may be half a cell nearer; by the place it may be off as well."""
    pose = Pose(5.0, 2.5, 0.0)
    ranges = with_discs(Eye(ROOM).scan(pose), pose, (6.0 - off + 0.03, 2.5, 0.03))
    layer = layer_of(ROOM)
    layer.arrays.noise["deviation"] = 0.002
    for _ in range(4):
        layer.see(ranges, BEAMS, pose, unsure=unsure)
    assert bool(layer.obstacles()) == (off > 0.05 + unsure)


@pytest.mark.parametrize("facing", [0.0, 0.5 * math.pi, math.pi, 1.5 * math.pi])
def test_a_leg_stands_in_the_middle_of_what_is_seen_of_it(facing: float) -> None:
    """Not at the side that the beams of a sweep meet first."""
    leg = (3.025, 2.525)  # in the middle of a cell
    half = 0.018
    # To its left, so that the beams of a sweep meet it from one side to the other.
    pose = Pose(leg[0] - 0.4 * math.cos(facing), leg[1] - 0.4 * math.sin(facing), facing - 1.0)
    angles = pose.theta + np.arange(BEAMS.directions.shape[0]) * BEAMS.step
    aside = (0.4 - half) * np.tan(angles - facing)
    meets = (np.abs(aside) < half) & (np.cos(angles - facing) > 0.0)
    assert np.count_nonzero(meets) >= 5
    face = (0.4 - half) / np.cos(angles - facing)
    ranges = np.where(meets, face, Eye(ROOM).scan(pose)).astype(np.float32)
    layer = layer_of(ROOM)
    for _ in range(10):
        layer.see(ranges, BEAMS, pose)
    ((x, y, _),) = layer.obstacles()
    off_x, off_y = x - leg[0], y - leg[1]
    assert -math.sin(facing) * off_x + math.cos(facing) * off_y == pytest.approx(0.0, abs=0.002)
    assert math.cos(facing) * off_x + math.sin(facing) * off_y == pytest.approx(-half, abs=0.002)


def test_where_the_map_says_nothing_is_no_thing() -> None:
    values = ROOM.map.values.copy()
    values[:, values.shape[1] // 2 :] = UNKNOWN
    home = replace(ROOM, map=OccupancyMap(ROOM.map.frame, values))
    assert seen(home, (4.5, 2.6, 0.15)).obstacles() == []
    assert layer_of(ROOM).obstacles() == []


def test_what_is_off_the_map_is_no_thing() -> None:
    layer = layer_of(ROOM)
    for pose in (Pose(40.0, 2.0, 0.0), Pose(-3.0, -3.0, 1.0), Pose(6.0, 5.0, 0.7)):
        for _ in range(5):
            layer.see(np.full(360, 1.0, np.float32), BEAMS, pose)
    assert not any(x > 6.0 or y > 5.0 or x < 0.0 or y < 0.0 for x, y, _ in layer.obstacles())


@pytest.mark.parametrize(("length", "cells"), [(0.46, 1), (0.49, 0), (0.52, 0)])
def test_what_ends_at_the_very_edge_of_a_map_is_no_thing(length: float, cells: int) -> None:
    """From the middle of the last cell on the distance of surfaces is not known."""
    frame = GridFrame(0.05, 0.0, 0.0, 20, 20)
    layer = ThingLayer(SurfaceField(frame, np.ones(frame.shape, np.float32)))
    ranges = np.full(360, np.nan, np.float32)
    ranges[0] = length
    for _ in range(5):
        layer.see(ranges, BEAMS, Pose(0.5, 0.51, 0.0))
    assert len(layer.cells(1)) == cells


def test_what_is_far_away_is_looked_at_when_it_is_nearer() -> None:
    disc = (5.4, 2.6, 0.15)
    assert seen(ROOM, disc, pose=Pose(0.6, 2.5, 0.0)).obstacles() == []
    assert seen(ROOM, disc, pose=Pose(2.6, 2.5, 0.0)).obstacles() != []


@pytest.mark.parametrize("scans", [1, 2, 4])
def test_who_walked_by_is_forgotten_within_a_second_of_being_seen_through(scans: int) -> None:
    layer = seen(ROOM, (3.0, 2.6, 0.15), scans=40)
    version = layer.version
    ranges = Eye(ROOM).scan(HERE)
    for _ in range(10 // scans):
        layer.see(ranges, BEAMS, HERE, scans)
    assert layer.obstacles() == []
    assert len(layer.cells(1)) == 0
    assert layer.version > version


def test_what_is_out_of_sight_is_not_forgotten() -> None:
    layer = seen(ROOM, (3.0, 2.6, 0.15))
    before = layer.obstacles()
    hidden = with_discs(Eye(ROOM).scan(HERE), HERE, (2.5, 2.55, 0.2))
    for ranges in (hidden, np.full(360, np.inf, np.float32), np.full(360, np.nan, np.float32)):
        for _ in range(30):
            layer.see(ranges, BEAMS, HERE)
        assert set(before) <= set(layer.obstacles())


def test_a_thin_leg_stays_though_beams_pass_beside_it() -> None:
    """Seen from a robot that turns and rolls about in front of it."""
    random = np.random.default_rng(2)
    for distance in (0.5, 1.0, 2.0):
        layer, leg = layer_of(ROOM), (2.0 + distance, 2.51, 0.02)
        stands = []
        for step in range(200):
            pose = Pose(2.0 + 0.05 * math.sin(0.3 * step), 2.5, float(random.uniform(-3.0, 3.0)))
            layer.see(with_discs(Eye(ROOM).scan(pose, random), pose, leg), BEAMS, pose)
            stands.append(bool(layer.obstacles()))
        assert np.mean(stands[10:]) > 0.97, distance


def test_it_can_be_told_to_forget() -> None:
    layer = seen(ROOM, (3.0, 2.6, 0.15), (2.0, 3.5, 0.1))
    version = layer.version
    layer.forget()
    assert layer.obstacles() == []
    assert layer.version == version + 1
    layer.forget()
    assert layer.version == version + 1
    layer.see(with_discs(Eye(ROOM).scan(HERE), HERE, (3.0, 2.6, 0.15)), BEAMS, HERE)
    assert len(layer.cells(1)) > 0


_UNSURE = 0.01
"""m; how unsure places are when nothing else is said."""


class Plain:
    """The same rules, cell by cell and slowly; the noise is what the layer measured."""

    def __init__(self, layer: ThingLayer) -> None:
        self.evidence = np.zeros(layer.field.values.shape, np.int64)
        self._layer, self._field, self._config = layer, layer.field, layer.config

    def see(self, ranges: Ranges, pose: Pose) -> None:
        config, frame = self._config, self._field.frame
        hit: Counter[tuple[int, int]] = Counter()
        behind: Counter[tuple[int, int]] = Counter()
        passed: set[tuple[int, int]] = set()
        for beam, length in enumerate(ranges.tolist()):
            if not 0.15 <= length < config.farthest:
                continue
            angle = pose.theta + beam * 2.0 * math.pi / len(ranges)
            way = np.array([math.cos(angle), math.sin(angle)])
            x, y = pose.x + length * way[0], pose.y + length * way[1]
            half_metre = min(int(length / 0.5), len(self._layer.arrays.noise) - 1)
            slack = config.sure * self._layer.arrays.noise["deviation"][half_metre]
            margin = config.map_error * frame.resolution + _UNSURE
            if self._off(x, y) <= margin + config.margin_share * length + slack:
                continue
            if is_mixed_by_itself(ranges, beam, slack):
                continue
            hit[frame.cell_of(x, y)] += 1
            half, most = 0.5 * frame.resolution, max(slack, config.clearly)
            ways = np.minimum(half * np.arange(1, math.ceil(most / half) + 1), most)
            cells = [frame.cell_of(x - back * way[0], y - back * way[1]) for back in ways]
            is_far = [bool(back >= slack + half) for back in ways]
            last = frame.cell_of(x, y)
            for cell, far in zip(cells, is_far, strict=True):
                if cell != last:
                    passed.add(cell)
                    behind[cell] += not far
                last = cell
        for row, column in np.argwhere(self.evidence > 0).tolist():
            cell = row, column
            if hit[cell] or cell in passed:
                less = 0 if hit[cell] >= max(behind[cell], 1) else config.behind
            else:
                less = config.loss if self._is_passed(ranges, pose, row, column) else 0
            self.evidence[cell] = max(0, self.evidence[cell] - less)
        for cell, beams in hit.items():
            if beams >= behind[cell]:
                self.evidence[cell] = min(self.evidence[cell] + config.gain, config.most)

    def _off(self, x: float, y: float) -> float:
        left, bottom, size = self._field.place.tolist()
        u, v = (x - left) / size, (y - bottom) / size
        column, row = math.floor(u), math.floor(v)
        rows, columns = self._field.values.shape
        if not (0 <= column < columns - 1 and 0 <= row < rows - 1):
            return -1.0
        a, b = u - column, v - row
        four = self._field.values[row : row + 2, column : column + 2].astype(np.float64)
        return float(np.array([1.0 - b, b]) @ four @ np.array([1.0 - a, a]))

    def _is_passed(self, ranges: Ranges, pose: Pose, row: int, column: int) -> bool:
        x, y = self._field.frame.centre_of(row, column)
        away, half = pose.distance_to(x, y), 0.7072 * self._field.frame.resolution
        if not half <= away <= self._config.farthest:
            return False
        step = 2.0 * math.pi / len(ranges)
        aside = int(half / (away * step)) + 1
        middle = round(pose.bearing_to(x, y) / step)
        beams = ranges[np.arange(middle - aside, middle + aside + 1) % len(ranges)]
        beams = beams[np.isfinite(beams)]
        return len(beams) > 0 and bool((beams > away + self._config.clearly).all())


def is_mixed_by_itself(ranges: Ranges, beam: int, slack: float) -> bool:
    """Whether a range lies behind a neighbour's, and on no line with two of its neighbours."""
    count, step = len(ranges), 2.0 * math.pi / len(ranges)
    length = float(ranges[beam])
    around = [float(ranges[(beam + k) % count]) for k in (-2, -1, 1, 2)]
    _, right, left, _ = around
    beside = math.sqrt(2.0) * slack
    if any(abs(other - length) <= beside + step * length for other in (right, left)):
        return False
    if not (right <= length or left <= length):
        return False
    for (i, j), times, tolerance in (
        ((1, 2), (0.5, 0.5), beside),
        ((1, 0), (2.0, -1.0), math.sqrt(6.0) * slack),
        ((2, 3), (2.0, -1.0), math.sqrt(6.0) * slack),
    ):
        is_steep = (i, j) == (1, 2) and not abs(left - right) <= 11.4 * step * length
        expected = times[0] / around[i] + times[1] / around[j]
        if not is_steep and abs(expected - 1.0 / length) * length**2 <= tolerance:
            return False
    return True


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=examples(40))
def test_evidence_is_that_of_the_same_rules_in_plain_python(seed: int) -> None:
    random = np.random.default_rng(seed)
    config = ThingConfig(gain=int(random.integers(1, 4)), loss=int(random.integers(1, 4)))
    layer, field = layer_of(FURNISHED, config), SurfaceField.of(FURNISHED.map)
    plain, eye = Plain(layer), Eye(FURNISHED)
    discs = [(*random.uniform(0.5, 4.0, 2).tolist(), 0.1) for _ in range(4)]
    poses = free_poses(FURNISHED, 3, random)
    for step in range(12):
        pose = poses[step % 3]
        ranges = with_discs(eye.scan(pose, random), pose, *discs[: random.integers(0, 5)])
        layer.see(ranges, BEAMS, pose)
        plain.see(ranges, pose)
        found = np.zeros(field.values.shape, np.int64)
        cells = layer.cells(1)
        found[tuple(cells.T)] = layer.arrays.evidence.reshape(found.shape)[tuple(cells.T)]
        assert (found == layer.arrays.evidence.reshape(found.shape)).all()
        # A beam at the very edge of a cell or of the margin may count on either side.
        assert (found != plain.evidence).sum() <= 2


@pytest.mark.parametrize("deviation", [0.005, 0.015, 0.03])
def test_a_thing_is_hardly_thicker_for_the_noise_of_ranges(deviation: float) -> None:
    """A round thing of 0.3 m is looked at from one side, 1 to 2 m away."""
    random, layer = np.random.default_rng(7), layer_of(ROOM)
    eye, disc = Eye(ROOM), (3.0, 2.5, 0.15)
    for _ in range(200):
        pose = Pose(random.uniform(0.8, 2.0), random.uniform(2.2, 2.8), 0.0)
        ranges = with_discs(eye.scan(pose), pose, disc)
        ranges += random.normal(0.0, deviation, len(ranges)).astype(np.float32)
        layer.see(ranges, BEAMS, pose)
    off = [math.hypot(x - 3.0, y - 2.5) - 0.15 for x, y, _ in layer.obstacles() if x < 2.95]
    assert len(off) >= 8
    assert max(off) < 1.2 * deviation
    assert abs(np.median(off)) < 0.01


def test_what_was_seen_too_near_from_afar_is_gone_when_it_is_seen_better() -> None:
    """A box whose side at x = 3 was seen 4 cm before it comes to stand where it is."""
    layer, angles = layer_of(ROOM), HERE.theta + np.arange(360) * (2.0 * np.pi / 360)
    room = Eye(ROOM).scan(HERE)

    def side(x: float) -> Ranges:
        with np.errstate(divide="ignore"):
            ways = (x - HERE.x) / np.cos(angles)
        meets = (ways > 0.0) & (np.abs(ways * np.sin(angles)) < 0.25)
        return np.where(meets, np.minimum(ways, room), room).astype(np.float32)

    for _ in range(8):
        layer.see(side(2.96), BEAMS, HERE)
    assert min(x for x, _, _ in layer.obstacles()) < 2.97
    for _ in range(30):
        layer.see(side(3.01), BEAMS, HERE)
    assert min(x for x, _, _ in layer.obstacles()) > 3.0


def test_between_an_edge_and_what_is_behind_it_nothing_stands() -> None:
    """One beam of each scan lies on the edge of a thing, and is sent back from in between."""
    random, layer = np.random.default_rng(3), layer_of(ROOM)
    eye, disc = Eye(ROOM), (3.0, 2.6, 0.15)
    for _ in range(200):
        ranges = with_discs(eye.scan(HERE, random), HERE, disc)
        last = int(np.flatnonzero(ranges < 1.2)[-1])
        share = random.uniform(0.3, 0.7)
        ranges[last + 1] = share * ranges[last] + (1.0 - share) * ranges[last + 2]
        layer.see(ranges, BEAMS, HERE)
    assert layer.obstacles()
    assert all(math.hypot(x - 3.0, y - 2.6) < 0.2 for x, y, _ in layer.obstacles())


def test_a_lidar_that_sees_ahead_alone_and_sits_at_the_front_marks_the_same_place() -> None:
    mount = Pose(0.1, 0.02, math.pi)
    lidar = LidarModel(np.linspace(-2.0, 2.0, 201), 0.1, 8.0, mount)
    layer = layer_of(ROOM)
    disc = (1.0, 2.4, 0.15)
    at = HERE.compose(mount)
    angles = at.theta + np.linspace(-2.0, 2.0, 201)
    ahead = (disc[0] - at.x) * np.cos(angles) + (disc[1] - at.y) * np.sin(angles)
    aside = (disc[1] - at.y) * np.cos(angles) - (disc[0] - at.x) * np.sin(angles)
    meets = (np.abs(aside) < disc[2]) & (ahead > 0.0)
    way = ahead - np.sqrt(np.maximum(disc[2] ** 2 - aside**2, 0.0))
    nothing = np.full(201, np.float32(np.inf))
    ranges = np.where(meets, way, nothing).astype(np.float32)
    for _ in range(5):
        layer.see(ranges, lidar.arrays(), HERE)
    assert layer.obstacles()
    for x, y, _ in layer.obstacles():
        assert math.hypot(x - disc[0], y - disc[1]) < 0.2
    # It is behind the lidar of a robot that has turned round.
    before = layer.obstacles()
    for _ in range(20):
        turned = HERE.compose(Pose(0.0, 0.0, math.pi))
        layer.see(np.full(201, 5.0, np.float32), lidar.arrays(), turned)
    assert layer.obstacles() == before
    for _ in range(20):
        layer.see(np.full(201, 5.0, np.float32), lidar.arrays(), HERE)
    assert not layer.obstacles()


def test_no_scan_at_all_breaks_it() -> None:
    random, layer = np.random.default_rng(4), layer_of(ROOM)
    choices = [np.nan, np.inf, -np.inf, -1.0, 0.0, 0.3, 2.0, 1e30]
    for _ in range(50):
        ranges = random.choice(choices, 360).astype(np.float32)
        layer.see(ranges, BEAMS, Pose(*random.uniform(-1.0, 6.0, 3).tolist()))
    count = int(layer.arrays.layer["count"][0])
    listed = layer.arrays.listed[:count]
    assert len(np.unique(listed)) == count == np.count_nonzero(layer.arrays.evidence)
    assert (layer.arrays.evidence[listed] > 0).all()


def blocked_by_sampling(
    layer: ThingLayer, points: NDArray[np.float64], first: float, last: float, radius: float
) -> float | None:
    legs = np.hypot(*np.diff(points, axis=0).T)
    stations = np.concatenate(([0.0], np.cumsum(legs)))
    for at in np.arange(first, min(last, stations[-1]), 0.002):
        x, y = (np.interp(at, stations, points[:, axis]) for axis in (0, 1))
        for spot_x, spot_y, size in layer.obstacles():
            if math.hypot(spot_x - x, spot_y - y) < radius + size:
                return float(at)
    return None


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=examples(40), deadline=None)
def test_a_path_is_blocked_where_something_is_near_it(seed: int) -> None:
    random = np.random.default_rng(seed)
    layer = seen(ROOM, (3.0, 2.6, 0.1), (2.0, 3.3, 0.1))
    points = random.uniform((1.0, 1.5), (4.0, 4.0), (4, 2))
    stations = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    first, last = sorted(random.uniform(0.0, stations[-1] + 1.0, 2).tolist())
    radius = float(random.uniform(0.05, 0.3))
    expected = blocked_by_sampling(layer, points, first, last, radius)
    found = layer.first_blocked(points, stations, first, last, radius)
    if expected is None:
        # Between two samples it may come a little nearer.
        assert (
            found is None
            or layer.first_blocked(points, stations, first, last, radius - 0.002) is None
        )
    else:
        assert found == pytest.approx(expected, abs=0.0021)


def test_only_what_is_surely_there_blocks() -> None:
    points, stations = np.array([[2.0, 2.5], [4.0, 2.7]]), np.array([0.0, math.hypot(2.0, 0.2)])

    def is_blocked(layer: ThingLayer) -> bool:
        return layer.first_blocked(points, stations, 0.0, 9.0, 0.17) is not None

    assert not is_blocked(seen(ROOM, (3.0, 2.6, 0.1), scans=2))
    assert is_blocked(seen(ROOM, (3.0, 2.6, 0.1), scans=3))
    assert not is_blocked(layer_of(ROOM))
