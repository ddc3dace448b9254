"""What the packets of a Create 2 say, as readings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from roomba.drivers.create2.open_interface import OpenMode, Packet
from roomba.mission.docking.beams import StationBeams
from roomba.robot.readings import CliffReading

Told = Mapping[int, int]
FAST: Final = (
    Packet.BUMPS_AND_DROPS,
    Packet.CLIFF_LEFT,
    Packet.CLIFF_FRONT_LEFT,
    Packet.CLIFF_FRONT_RIGHT,
    Packet.CLIFF_RIGHT,
    Packet.INFRARED_OMNI,
    Packet.CHARGING_SOURCES,
    Packet.MODE,
    Packet.LEFT_ENCODER,
    Packet.RIGHT_ENCODER,
)
"""25 bytes as a frame: fewer than the 28 that 19200 baud can send in 15 ms."""
SLOW: Final = (
    Packet.BUMPS_AND_DROPS,
    Packet.DIRT,
    Packet.WALL_SIGNAL,
    Packet.INFRARED_OMNI,
    Packet.CHARGING_STATE,
    Packet.CHARGE,
    Packet.CAPACITY,
    Packet.INFRARED_LEFT,
    Packet.INFRARED_RIGHT,
)
"""24 bytes as a frame."""
ALL: Final = tuple(dict.fromkeys((*FAST, *SLOW)))
_CHARGES: Final = frozenset({1, 2, 3, 4})
"""Charging states: reconditioning, full, trickle, waiting."""
_MODES: Final = frozenset(int(mode) for mode in OpenMode)
_DIRT_WINDOW: Final = 0.1
"""s over which the dirt sensor counts what it tells (assumed)."""
_MOST_WALL: Final = 1023
_STATION_600: Final = {161: 1, 164: 4, 165: 5, 168: 8, 169: 9, 172: 12, 173: 13}
_STATION_500: Final = {242: 1, 244: 4, 246: 5, 248: 8, 250: 9, 252: 12, 254: 13}
_BEAMS: Final = _STATION_600 | _STATION_500
"""Infrared characters of older and newer stations, as bits: 1 halo, 4 green, 8 red."""


@dataclass(frozen=True, slots=True)
class Create2State:
    """What the robot told last; ``charge`` and ``capacity`` are in mAh, ``grains`` in 1/s.

    ``wall`` is how near a wall on its right is, from 0, out of reach, to 1;
    ``has_power``: it stands on its station, or a cable is in it; ``has_cable``: the latter.
    """

    mode: OpenMode = OpenMode.OFF
    bumper_left: bool = False
    bumper_right: bool = False
    dropped_left: bool = False
    dropped_right: bool = False
    cliff: CliffReading = field(default_factory=CliffReading)
    beams: StationBeams = field(default_factory=StationBeams)
    has_power: bool = False
    has_cable: bool = False
    charge: int = 0
    capacity: int = 0
    grains: float = 0.0
    wall: float = 0.0

    @property
    def level(self) -> float:
        """How full the battery is, 0..1; 1 as long as it is not told."""
        return min(1.0, self.charge / self.capacity) if self.capacity > 0 else 1.0


def state_of(told: Told) -> Create2State:
    """Return the state; a packet that was not told counts as nothing sensed."""
    bumps = told.get(Packet.BUMPS_AND_DROPS, 0)
    mode = told.get(Packet.MODE, 0)
    sources = told.get(Packet.CHARGING_SOURCES, 0)
    return Create2State(
        OpenMode(mode) if mode in _MODES else OpenMode.OFF,
        bool(bumps & 2),
        bool(bumps & 1),
        bool(bumps & 8),
        bool(bumps & 4),
        CliffReading(*(bool(told.get(Packet.CLIFF_LEFT + place, 0)) for place in range(4))),
        _beams_of(told),
        bool(sources) or told.get(Packet.CHARGING_STATE, 0) in _CHARGES,
        bool(sources & 1),
        told.get(Packet.CHARGE, 0),
        told.get(Packet.CAPACITY, 0),
        told.get(Packet.DIRT, 0) / _DIRT_WINDOW,
        min(1.0, told.get(Packet.WALL_SIGNAL, 0) / _MOST_WALL),
    )


def _beams_of(told: Told) -> StationBeams:
    receivers = (Packet.INFRARED_OMNI, Packet.INFRARED_LEFT, Packet.INFRARED_RIGHT)
    seen = 0
    for receiver in receivers:
        seen |= _BEAMS.get(told.get(receiver, 0), 0)
    return StationBeams(bool(seen & 1), bool(seen & 4), bool(seen & 8))
