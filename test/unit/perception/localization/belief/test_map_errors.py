"""On maps whose walls lie anywhere in their cells, the pose and its covariance are right."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from fixtures.drives.made_lidars import TICK, Floats, Lidar, outlines
from fixtures.robots.located import FURNISHED, LIDAR, Eye
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, wrap_angle
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.localization.belief.map_spread_kernels import (
    OFFSET,
    OFFSET_BEAMS,
    map_spread,
)
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.match_kernels import beam_ends
from roomba.perception.matching.surface_field import SurfaceField

CONFIG = RobotConfig()
CELL, SPAN = 0.1, 90
"""m, cells; of the map, whose corner lies at -1, -1."""
AHEAD = Lidar(fan=math.pi, turns=False, missed=0.0)
IN_95_PERCENT, IN_HALF = 7.815, 2.366
"""Of chi-squared with three degrees of freedom."""


@dataclass(frozen=True)
class Surveyed:
    """``walls`` [n, 4], m, and the map on which any cell that they touch is solid."""

    walls: Floats
    map: OccupancyMap

    @staticmethod
    def of(walls: Floats) -> Surveyed:
        middles = -1.0 + CELL * (np.arange(SPAN) + 0.5)
        x, y = np.meshgrid(middles, middles)
        left, low, right, high = walls[0, 0], walls[0, 1], walls[2, 0], walls[2, 1]
        is_in = (x > left) & (x < right) & (y > low) & (y < high)
        values = np.where(is_in, 0, -1).astype(np.int8)
        for x, y, to_x, to_y in walls:
            along = np.linspace(0.0, 1.0, 2000)
            columns = np.floor((x + along * (to_x - x) + 1.0) / CELL).astype(int)
            rows = np.floor((y + along * (to_y - y) + 1.0) / CELL).astype(int)
            values[rows, columns] = 100
        return Surveyed(walls, OccupancyMap(GridFrame(CELL, -1.0, -1.0, SPAN, SPAN), values))


def room(generator: np.random.Generator) -> Surveyed:
    """A room with two cupboards, no two sides of which lie alike in their cells."""
    low, high = generator.uniform(-0.3, 0.3, 2), generator.uniform(5.0, 6.5, 2)
    blocks = [(*low, *high)]
    for x, y in ((low[0], high[1]), (high[0], low[1])):
        wide, deep = generator.uniform(0.6, 1.4, 2)
        blocks.append(
            (min(x, x + wide), y - deep, max(x, x + wide), y)
            if y > x
            else (x - wide, y, x, y + deep)
        )
    return Surveyed.of(outlines(*blocks))


def ranges_at(pose: Pose, walls: Floats, generator: np.random.Generator) -> NDArray[np.float32]:
    return AHEAD.scan(lambda _: pose, 0.0, walls, generator)


def way(time: float) -> Pose:
    """It drives around the room, and looks to either side."""
    angle = 0.3 * time
    heading = angle + 0.5 * math.pi + 0.5 * math.sin(0.7 * time)
    return Pose(3.0 + math.cos(angle), 3.0 + math.sin(angle), heading)


def drive(surveyed: Surveyed, seconds: float, seed: int) -> tuple[Floats, Floats]:
    """Return errors, m, and squared Mahalanobis distances at the scans after the first 10 s."""
    generator, model = np.random.default_rng(seed), AHEAD.model()
    localizer = Localizer(
        surveyed.map, CONFIG.localization, CONFIG.gyro, CONFIG.body.radius, way(0.0)
    )
    errors, squares = [], []
    for tick in range(round(seconds / TICK)):
        now = TICK * tick
        true = way(now)
        localizer.move(now, way(0.0).inverse().compose(true))
        if tick % 10 == 0:
            localizer.see(now, ranges_at(true, surveyed.walls, generator), model)
        if tick % 10 == 0 and now > 10.0:
            estimate = localizer.estimate
            pose = estimate.pose
            off = np.array([pose.x - true.x, pose.y - true.y, wrap_angle(pose.theta - true.theta)])
            errors.append(float(np.hypot(off[0], off[1])))
            squares.append(float(off @ np.linalg.solve(estimate.covariance, off)))
    return np.array(errors), np.array(squares)


def test_the_covariance_covers_the_errors_of_the_map() -> None:
    generator = np.random.default_rng(5)
    drives = [drive(room(generator), 25.0, seed) for seed in range(12)]
    squares = np.concatenate([each[1] for each in drives])
    assert np.mean(squares < IN_95_PERCENT) > 0.9
    assert np.mean(squares < IN_HALF) < 0.95


def test_on_coarse_cells_a_wall_may_be_anywhere_in_its_cell() -> None:
    """Seen 9 cm off the map, a wall is in the next cell of 5 cm, and in the same one of 10 cm."""
    view = AHEAD.model().view(np.full(181, 2.0, np.float32))
    agreeing = []
    for cell in (0.05, 0.1):
        span = round(8.0 / cell)
        middles = cell * (np.arange(span) + 0.5) - 4.0
        away = np.hypot(middles[:, None], middles[None])
        values = np.where(away > 2.0 + 0.09, 100, 0).astype(np.int8)
        field = SurfaceField.of(OccupancyMap(GridFrame(cell, -4.0, -4.0, span, span), values))
        agreeing.append(view.fit(field, np.zeros(3)).agree)
    assert agreeing[0] < 0.6
    assert agreeing[1] > 0.9


def test_walls_are_looked_for_inside_of_their_cells() -> None:
    errors, _ = drive(Surveyed.of(outlines((0.05, 0.05, 6.05, 6.05))), 30.0, 3)
    assert np.median(errors) < 0.01


def test_what_stands_more_than_a_cell_before_walls_hardly_counts_as_walls() -> None:
    """A sixth of what is in sight was pushed by 7 cm; all walls are where the map shows them."""
    pose, beams = Pose(3.0, 1.3, 0.4), LIDAR.arrays()
    ranges = Eye(FURNISHED).scan(pose)
    ranges[100:160] -= 0.07
    count = beam_ends(
        ranges, beams.directions, beams.mount, beams.nearest, beams.farthest, beams.ends
    )
    field, told = SurfaceField.of(FURNISHED.map), np.empty(4)
    at, of_cell = np.array([pose.x, pose.y, pose.theta]), 0.05**2 / 12.0
    spread = np.empty((3, 3))
    assert map_spread(
        field.values, field.place, beams.ends, count, at, of_cell, of_cell, spread, told
    )
    assert abs(told[OFFSET] / told[OFFSET_BEAMS]) < 0.004
