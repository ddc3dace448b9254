"""A corridor that comes back to where it began after 100 m: does the map close?

The building is made up: a ring of corridor with doorways at irregular places. The robot is driven
around once by its true pose, so that all ways of mapping see the same.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from roomba.commands.map.blind_map import BlindMap
from roomba.commands.map.map_error import MapError, map_error
from roomba.commands.map.seen_floor import seen_floor
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import TimingConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator
from roomba_bench.ours_sim import ROBOT

LONG, SHORT = 30.0, 20.0
"""m; sides of the ring, along the corridor's middle."""
WAY: Final = 2.0 * (LONG + SHORT)
_HALF_WIDTH: Final = 0.8
_AROUND: Final = 1.5
"""m of wall around it."""
_CELL: Final = 0.05
_DOORWAY, _DEPTH = 0.9, 0.3
_APART: Final = (1.5, 6.0)
"""m; between two doorways, at random."""
_SPEED, _AHEAD = 0.4, 0.5
"""m/s; and m by which the point of the middle lies ahead to which the robot steers."""
_TIMING: Final = TimingConfig()
_CORNERS: Final = np.array([[0.0, 0.0], [LONG, 0.0], [LONG, SHORT], [0.0, SHORT], [0.0, 0.0]])
_BEGIN: Final = 5.0
"""m along the first side, where it begins and ends."""


@dataclass(frozen=True, eq=False)
class Looped:
    """The error of the final place, m: on the finished map, before finishing, and reckoned."""

    way: float
    end: float
    end_before: float
    end_blind: float
    error: MapError
    error_blind: MapError
    occupancy: OccupancyMap


def ring(seed: int) -> Home:
    """Return the building; its doorways are placed by the seed."""
    random = np.random.default_rng(seed)
    margin = _HALF_WIDTH + _AROUND
    rows, columns = round((SHORT + 2.0 * margin) / _CELL), round((LONG + 2.0 * margin) / _CELL)
    frame = GridFrame(_CELL, -margin, -margin, rows, columns)
    x = frame.origin_x + (np.arange(columns) + 0.5) * _CELL
    y = (frame.origin_y + (np.arange(rows) + 0.5) * _CELL)[:, None]
    outer = (np.abs(x - LONG / 2.0) < LONG / 2.0 + _HALF_WIDTH) & (
        np.abs(y - SHORT / 2.0) < SHORT / 2.0 + _HALF_WIDTH
    )
    inner = (np.abs(x - LONG / 2.0) < LONG / 2.0 - _HALF_WIDTH) & (
        np.abs(y - SHORT / 2.0) < SHORT / 2.0 - _HALF_WIDTH
    )
    free = outer & ~inner
    for along, length, is_upright in ((x, LONG, False), (y, SHORT, True)):
        across = y if not is_upright else x
        far = SHORT if not is_upright else LONG
        for side in (-_HALF_WIDTH, _HALF_WIDTH, far - _HALF_WIDTH, far + _HALF_WIDTH):
            at = random.uniform(*_APART)
            while at < length - 1.5:
                is_within = np.abs(across - side) < _DEPTH
                free |= is_within & (np.abs(along - at) < _DOORWAY / 2.0)
                at += _DOORWAY + random.uniform(*_APART)
    solid = ~free
    values = np.where(solid, np.int8(OCCUPIED), np.int8(FREE))
    return Home(
        "ring",
        OccupancyMap(frame, values),
        solid=solid,
        walls=solid,
        station=Pose(_BEGIN, 0.0, 0.0),
    )


def loop(seed: int) -> Looped:
    """Drive around it once, with the shipped noise."""
    home, config, mapping = ring(seed), ROBOT, MappingConfig()
    simulator = Simulator(home, config, seed=seed)
    numbers = config.localization, config.gyro, simulator.start
    mapper, blind = Mapper(mapping, *numbers), BlindMap(mapping, *numbers)
    lidar = LidarModel.all_around(
        config.lidar.beams, config.lidar.min_range, config.lidar.max_range
    )
    scans, driven, before = -1, 0.0, simulator.pose
    while driven < WAY + _BEGIN:
        seen = simulator.observe()
        for each in (mapper, blind):
            each.move(seen.time, seen.odometry, seen.angular_velocity)
            if seen.scans != scans:
                each.see(seen.time, simulator.ranges, lidar)
        scans = seen.scans
        true = seen.pose
        driven += true.distance_to(before.x, before.y)
        before = true
        simulator.advance(_steered(true), _TIMING.world_step, _TIMING.steps_per_tick)
    true = simulator.observe().pose
    end_before = mapper.pose.distance_to(true.x, true.y)
    made, guessed = mapper.finish(), blind.occupancy()
    place = (home.station.x, home.station.y)
    seen_cells = seen_floor(home.solid, home.frame, place, config)
    return Looped(
        driven,
        mapper.pose.distance_to(true.x, true.y),
        end_before,
        blind.pose.distance_to(true.x, true.y),
        map_error(made, home.frame, home.solid, seen_cells),
        map_error(guessed, home.frame, home.solid, seen_cells),
        made,
    )


def _steered(true: Pose) -> Twist:
    """Return the twist that follows the corridor's middle."""
    at_x, at_y = middle(along_of(true) + _AHEAD)
    turn = wrap_angle(math.atan2(at_y - true.y, at_x - true.x) - true.theta)
    return Twist(_SPEED * max(0.2, math.cos(turn)), max(-1.5, min(1.5, 3.0 * turn)))


def along_of(true: Pose) -> float:
    """Return how far along the ring the nearest point of its middle is, m."""
    best, found, start = math.inf, 0.0, 0.0
    for low, high in itertools.pairwise(_CORNERS):
        way = high - low
        length = math.hypot(*way)
        share = ((true.x - low[0]) * way[0] + (true.y - low[1]) * way[1]) / length**2
        share = min(max(share, 0.0), 1.0)
        away = math.hypot(*(low + share * way - (true.x, true.y)))
        if away < best - 1e-9:
            best, found = away, start + share * length
        start += length
    return found


def middle(along: float) -> tuple[float, float]:
    """Return the point of the corridor's middle that is so far along it, m."""
    along %= WAY
    for low, high in itertools.pairwise(_CORNERS):
        length = math.hypot(*(high - low))
        if along <= length:
            x, y = (low + (high - low) * along / length).tolist()
            return x, y
        along -= length
    return float(_CORNERS[0, 0]), float(_CORNERS[0, 1])
