"""What a Create 2 in a simulated home tells in its packets.

Packets of sensors that the simulated robot does not have are those of a healthy robot that senses
nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.drivers.create2.open_interface import ENCODER_SPAN, Packet
from roomba.geometry import Pose
from roomba.world.engine.state.arrays import code_of
from roomba.world.observation import Observation

Told = Mapping[int, int]
_FLOOR, _NO_FLOOR = 2800, 150
"""Signals of a cliff sensor, of 4095 (assumed)."""
_LIGHT_REACH: Final = 0.12
"""m before the bumper; from there on the light bumper sees something (assumed)."""
_MOST_LIGHT: Final = 4095
_LEAST_LIGHT: Final = 120
"""The signal from which on a light bumper's bit is set (assumed)."""
_LIGHTS: Final[Mapping[Packet, float]] = {
    Packet.LIGHT_LEFT: 65.0,
    Packet.LIGHT_FRONT_LEFT: 35.0,
    Packet.LIGHT_CENTER_LEFT: 12.0,
    Packet.LIGHT_CENTER_RIGHT: -12.0,
    Packet.LIGHT_FRONT_RIGHT: -35.0,
    Packet.LIGHT_RIGHT: -65.0,
}
"""Where they look, degrees to the left (assumed)."""
_WALL: Final = -90.0
"""degrees; the wall sensor looks to the right."""
_WALL_REACH: Final = 0.06
"""m (assumed)."""
MOST_WALL: Final = 1023
"""The wall sensor's strongest signal."""
_SPREAD: Final = 10.0
"""degrees, to each side of where they look (assumed)."""
_SIDE_SIGHT: Final = (math.radians(-30.0), math.radians(130.0))
"""Of the left receiver, to the left; the right one's is mirrored (assumed)."""


@dataclass(frozen=True, slots=True)
class SensingContext:
    """What packets need beside the observation: configuration, encoders, and station.

    ``encoders`` are the wheels' angles that count as 0, left and right, rad; ``station`` is the
    station's pose in the robot's frame.
    """

    config: SimulatedRobotConfig
    encoders: tuple[float, float]
    station: Pose


def sensed(seen: Observation, ranges: NDArray[np.float32], about: SensingContext) -> dict[int, int]:
    """Return the packets that tell what is sensed; ``ranges``, m, counter-clockwise from ahead."""
    config = about.config
    return {
        **_touched(seen),
        **_lights(ranges, config.body.radius),
        **_infrared(code_of(seen.infrared), about.station),
        **_power(seen, config),
        **_wheels(seen, about),
        Packet.DIRT: min(255, round(seen.grains * config.dirt_sensor.window)),
    }


def wall_signal(ranges: NDArray[np.float32], radius: float) -> int:
    """Return how strong the wall's light comes back, 0 to :data:`MOST_WALL`.

    ``ranges`` as above; the body's ``radius``, m.
    """
    return _signal(ranges, _WALL, radius + _WALL_REACH, radius, MOST_WALL)


def encoder_angles(seen: Observation) -> tuple[float, float]:
    """Return how far the wheels turned, left and right, rad."""
    return seen.wheels.left, seen.wheels.right


def _touched(seen: Observation) -> Told:
    bumper, cliff, wheels = seen.bumper, seen.cliff, seen.wheels
    floors = (cliff.left, cliff.front_left, cliff.front_right, cliff.right)
    flags = (bumper.right, bumper.left, wheels.dropped_right, wheels.dropped_left)
    return {
        Packet.BUMPS_AND_DROPS: _bits(flags),
        **{Packet.CLIFF_LEFT + place: int(is_gone) for place, is_gone in enumerate(floors)},
        **{
            Packet.CLIFF_LEFT_SIGNAL + place: _NO_FLOOR if is_gone else _FLOOR
            for place, is_gone in enumerate(floors)
        },
        Packet.OVERCURRENTS: _bits((0, 0, 0, wheels.stalled_right, wheels.stalled_left)),
    }


def _lights(ranges: NDArray[np.float32], radius: float) -> Told:
    signals: dict[int, int] = {
        light: _signal(ranges, angle, radius + _LIGHT_REACH, radius, _MOST_LIGHT)
        for light, angle in _LIGHTS.items()
    }
    wall = wall_signal(ranges, radius)
    return {
        **signals,
        Packet.LIGHT_BUMPER: _bits(signal >= _LEAST_LIGHT for signal in signals.values()),
        Packet.WALL_SIGNAL: wall,
        Packet.WALL: int(wall > 0),
    }


def _signal(
    ranges: NDArray[np.float32], angle: float, farthest: float, nearest: float, most: int
) -> int:
    """Return how strong the light is that comes back from what is nearer than ``farthest``, m."""
    beams = len(ranges)
    middle, half = round(angle / 360.0 * beams), max(1, round(_SPREAD / 360.0 * beams))
    found = float(np.min(np.take(ranges, range(middle - half, middle + half + 1), mode="wrap")))
    share = (farthest - found) / (farthest - nearest) if math.isfinite(found) else 0.0
    return round(most * max(0.0, min(1.0, share)))


def _infrared(code: int, station: Pose) -> Told:
    """Return what the three receivers hear of a station that stands at ``station``."""
    bearing = math.atan2(station.y, station.x)
    least, most = _SIDE_SIGHT
    return {
        Packet.INFRARED_OMNI: code,
        Packet.INFRARED_LEFT: code if least <= bearing <= most else 0,
        Packet.INFRARED_RIGHT: code if least <= -bearing <= most else 0,
    }


def _power(seen: Observation, config: SimulatedRobotConfig) -> Told:
    battery = seen.battery
    capacity = 1e3 * battery.capacity / config.battery.nominal_voltage
    charging = 0 if not battery.is_docked else 3 if battery.is_full else 2
    return {
        Packet.CHARGING_STATE: charging,
        Packet.VOLTAGE: round(1e3 * battery.voltage),
        Packet.CURRENT: round(1e3 * battery.current),
        Packet.TEMPERATURE: round(battery.temperature),
        Packet.CHARGE: round(battery.level * capacity),
        Packet.CAPACITY: round(capacity),
        Packet.CHARGING_SOURCES: 2 * int(battery.is_docked),
        Packet.MAIN_BRUSH_CURRENT: round(1e3 * seen.brush_current),
    }


def _wheels(seen: Observation, about: SensingContext) -> Told:
    scale = about.config.wheels.counts_per_turn / (2.0 * math.pi)
    left, right = (
        round(scale * (angle - zero)) % ENCODER_SPAN
        for angle, zero in zip(encoder_angles(seen), about.encoders, strict=True)
    )
    return {
        Packet.LEFT_ENCODER: left,
        Packet.RIGHT_ENCODER: right,
        Packet.STASIS: int(seen.odometry_twist.linear > 0.0),
    }


def _bits(flags: Iterable[object]) -> int:
    return sum(1 << place for place, flag in enumerate(flags) if flag)
