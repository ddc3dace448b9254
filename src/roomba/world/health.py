"""Health of the robot's parts by its own sensors, with what the owner can do about it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.body import HealthConfig
from roomba.world.observation import Observation


class Level(IntEnum):
    """How a part does; the values are those of diagnostic_msgs/DiagnosticStatus."""

    OK = 0
    WARN = 1
    """It works, but needs attention."""
    ERROR = 2
    """It does not work."""


@dataclass(frozen=True, slots=True)
class PartHealth:
    """A part by ``name``: how it does, why, and its ``values`` by name and unit."""

    name: str
    level: Level
    message: str
    values: dict[str, str]


def health_of(
    seen: Observation, ranges: NDArray[np.float32], bin_capacity: float, config: HealthConfig
) -> tuple[PartHealth, ...]:
    """Return the health of battery, drive, lidar and bin.

    ``ranges`` is the last scan, float32 [beams], m; ``bin_capacity`` in g.
    """
    fill = seen.in_bin / bin_capacity
    return _battery(seen, config), _drive(seen), _lidar(ranges, config), _bin(fill, config)


def _battery(seen: Observation, config: HealthConfig) -> PartHealth:
    battery = seen.battery
    level, message = Level.OK, "charging" if battery.is_charging else "ok"
    if not battery.is_docked and battery.level < config.empty_battery:
        level, message = Level.ERROR, "empty: carry the robot to its station"
    elif battery.temperature > config.hot_battery:
        level, message = Level.WARN, "hot: let it cool down"
    elif not battery.is_docked and battery.level < config.low_battery:
        level, message = Level.WARN, "low: the robot should go home"
    values = {
        "charge (0..1)": f"{battery.level:.3f}",
        "voltage (V)": f"{battery.voltage:.2f}",
        "current (A)": f"{battery.current:.2f}",
        "temperature (degrees C)": f"{battery.temperature:.1f}",
    }
    return PartHealth("battery", level, message, values)


def _drive(seen: Observation) -> PartHealth:
    level, message = Level.OK, "ok"
    if seen.wheels.dropped:
        level, message = Level.ERROR, "a wheel hangs in the air: put the robot on the floor"
    elif seen.wheels.stalled:
        level, message = Level.ERROR, "a wheel is held: free it"
    values = {"wheel drop": str(seen.wheels.dropped), "stall": str(seen.wheels.stalled)}
    return PartHealth("drive", level, message, values)


def _lidar(ranges: NDArray[np.float32], config: HealthConfig) -> PartHealth:
    misses = float(np.mean(np.isposinf(ranges)))
    level, message = Level.OK, "ok"
    if misses == 1.0:
        level, message = Level.ERROR, "no beam comes back: look what covers it, if there are walls"
    elif misses > config.most_misses:
        level, message = Level.WARN, "many beams do not come back: clean it"
    return PartHealth("lidar", level, message, {"misses (0..1)": f"{misses:.3f}"})


def _bin(fill: float, config: HealthConfig) -> PartHealth:
    level, message = Level.OK, "ok"
    if fill >= config.full_bin:
        level, message = Level.WARN, "full: empty it"
    return PartHealth("bin", level, message, {"fill (0..1)": f"{fill:.3f}"})
