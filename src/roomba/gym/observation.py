"""The observation of an agent: the robot's own sensors and nothing of the truth.

An observation is one flat float32 array, so that a network takes it as it is, and a thousand robots
are one array [robots, SIZE]; the slices below name its parts, ``observation[..., LIDAR]``. Numbers
are in SI units, ratios 0..1, and switches 0 or 1; all lie within :func:`observation_space`, so
``gymnasium.wrappers.RescaleObservation`` can bring them to -1..1.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.world.engine.state.arrays import Infrared
from roomba.world.fleet import Fleet
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM

SECTORS: Final = 36

LIDAR: Final = slice(0, SECTORS)
"""The nearest range in each sector, m; sector 0 looks ahead, others follow counter-clockwise.

A sector without an echo has the greatest range, one with something too near to measure has 0.
"""
BUMPER: Final = slice(36, 38)
"""Left and right half of the bumper, 1 if pressed."""
CLIFF: Final = slice(38, 42)
"""Left, front left, front right, right: 1 if there is no floor."""
VELOCITY: Final = slice(42, 44)
"""By the wheel encoders: m/s ahead, rad/s counter-clockwise."""
GYRO: Final = slice(44, 45)
"""rad/s counter-clockwise."""
BATTERY: Final = slice(45, 46)
"""Charge, 0..1."""
GRAINS: Final = slice(46, 47)
"""What the dirt sensor counts, 1/s."""
BIN: Final = slice(47, 48)
"""How full the bin is, 0..1."""
STATION: Final = slice(48, 51)
"""The station's halo, its green and its red beam: 1 if received; see Infrared."""
SIZE: Final = 51

_BEAMS = (Infrared.HALO, Infrared.GREEN, Infrared.RED)
_NAMES: Final = {
    36: "bumper_left",
    37: "bumper_right",
    38: "cliff_left",
    39: "cliff_front_left",
    40: "cliff_front_right",
    41: "cliff_right",
    42: "odometry_linear",
    43: "odometry_angular",
    44: "gyro",
    45: "charge",
    46: "grains",
    47: "in_bin",
}
"""By place in an observation: the field of a robot's row that goes there."""
_MARGIN: Final = 2.0
"""Measured speeds are clipped at this multiple of the greatest true speeds."""


def observation_space(config: RobotConfig, max_speed: float) -> Box:
    """Return the bounds of an observation; ``max_speed`` in m/s."""
    low, high = np.zeros(SIZE, np.float32), np.ones(SIZE, np.float32)
    high[LIDAR] = config.lidar.max_range
    high[VELOCITY] = _MARGIN * max_speed, _MARGIN * config.body.max_angular_speed
    high[GYRO] = _MARGIN * config.body.max_angular_speed
    low[VELOCITY], low[GYRO] = -high[VELOCITY], -high[GYRO]
    high[GRAINS] = config.dirt_sensor.most
    return Box(low, high, dtype=np.float32)


class Observer:
    """Reads the observations of all robots of a fleet."""

    def __init__(self, fleet: Fleet, max_speed: float) -> None:
        """Raises ValueError for a lidar whose beams cannot be shared out evenly."""
        beams = fleet.config.lidar.beams
        if beams % SECTORS:
            raise ValueError(f"expected a lidar with a multiple of {SECTORS} beams, got {beams}")
        self.space = observation_space(fleet.config, max_speed)
        self._fleet = fleet
        width = beams // SECTORS
        # One row for each beam of a sector: the least of long rows is found faster than of short.
        within = np.arange(width)[:, None] - width // 2
        self._beams = (width * np.arange(SECTORS) + within) % beams
        self._scale = np.ones(SIZE, np.float32)
        self._scale[BATTERY] = 1.0 / fleet.config.battery.capacity
        self._scale[BIN] = 1.0 / (fleet.config.brush.bin_capacity * MICROGRAMS_PER_GRAM)

    def read(self) -> NDArray[np.float32]:
        """Return what the robots sense now, float32 [robots, SIZE]."""
        robots = self._fleet.robots
        sensed = np.empty((len(robots), SIZE), np.float32)
        self._fleet.ranges[:, self._beams].min(axis=1, out=sensed[:, LIDAR])
        for place, name in _NAMES.items():
            sensed[:, place] = robots[name]
        beams = robots["beams"]
        for place, beam in enumerate(_BEAMS, STATION.start):
            sensed[:, place] = (beams & int(beam)) != 0
        sensed *= self._scale
        np.clip(sensed, self.space.low, self.space.high, out=sensed)
        return sensed
