"""ir-sim: a circle of a differential drive with a lidar, on a grid map or among rectangles."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import irsim
import numpy as np
import yaml
from numpy.typing import NDArray
from PIL import Image

from roomba_bench.peers.protocol import Parameters, Work
from roomba_bench.peers.simulators.arena import Arena, work_of

DISTRIBUTION = "ir-sim"

_TOUCH = 0.03
"""m; a wall so near ahead counts as a bump, as a real collision would stop ir-sim's robot."""


class IrsimEngine:
    """The arena in ir-sim."""

    def __init__(self, arena: Arena, as_boxes: bool) -> None:
        """Build it, as rectangles or as a grid map."""
        self._arena = arena
        description = arena.path.with_suffix(f".{'boxes' if as_boxes else 'grid'}.yaml")
        world = _rectangles(arena) if as_boxes else _grid_map(arena)
        description.write_text(yaml.safe_dump({**world, "robot": [_robot(arena)]}))
        self._world = irsim.make(str(description), headless=True, log_level="ERROR")
        logging.disable(logging.CRITICAL)
        self._robot = self._world.robot
        self._sensors = self._robot.sensors
        half = arena.beams // 2
        self._front = slice(half - half // 2, half + half // 2)

    def place(self, x: float, y: float, theta: float) -> None:
        low_x, low_y = self._arena.origin
        self._robot.set_state([x - low_x, y - low_y, theta])

    def pose(self) -> tuple[float, float, float]:
        x, y, theta = np.ravel(self._robot.state)[:3].tolist()
        return x + self._arena.origin[0], y + self._arena.origin[1], theta

    def step(self, linear: float, angular: float) -> bool:
        self._robot.sensors = []  # scanning is counted where it is asked for, in scan()
        self._world.step([linear, angular])
        self._robot.sensors = self._sensors
        ahead = self._sensors[0].range_data[self._front]
        return float(np.min(ahead)) < self._arena.radius + _TOUCH

    def scan(self) -> NDArray[np.float64]:
        self._robot.sensor_step()
        ranges: NDArray[np.float64] = self._sensors[0].range_data
        return ranges


def _robot(arena: Arena) -> Mapping[str, Any]:
    x, y, theta = arena.start
    lidar = {
        "name": "lidar2d",
        "range_min": 0.0,
        "range_max": arena.reach,
        "angle_range": 2.0 * math.pi,
        "number": arena.beams,
    }
    return {
        "kinematics": {"name": "diff"},
        "shape": {"name": "circle", "radius": arena.radius},
        "state": [x - arena.origin[0], y - arena.origin[1], theta],
        "vel_max": [1.0, 4.0],
        "sensors": [lidar],
    }


def _world(arena: Arena) -> dict[str, Any]:
    height, width = (cells * arena.resolution for cells in arena.solid.shape)
    return {
        "width": width,
        "height": height,
        "step_time": arena.dt,
        "collision_mode": "unobstructed",
    }


def _grid_map(arena: Arena) -> dict[str, Any]:
    picture: Path = arena.path.with_suffix(".png")
    Image.fromarray(np.where(arena.solid, 0, 255).astype(np.uint8)[::-1]).save(picture)
    return {"world": {**_world(arena), "obstacle_map": str(picture)}}


def _rectangles(arena: Arena) -> dict[str, Any]:
    obstacles = [
        {
            "shape": {"name": "rectangle", "length": 2.0 * half_x, "width": 2.0 * half_y},
            "state": [x - arena.origin[0], y - arena.origin[1], 0.0],
        }
        for x, y, half_x, half_y in arena.boxes.tolist()
    ]
    return {"world": _world(arena), "obstacle": obstacles}


def prepare(parameters: Parameters) -> Work:
    """Build the arena."""
    arena = Arena.of(parameters)
    return work_of(IrsimEngine(arena, bool(parameters["as_boxes"])), arena, parameters)
