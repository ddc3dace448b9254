"""The battery's voltage, current and temperature, and the robot's noise level."""

from __future__ import annotations

import math
from dataclasses import dataclass

from roomba.configuration.simulation import SimulatedBrush, SimulatedFan

CELLS = 4
"""In series, as in a pack of 14.4 V."""
STANDING_NOISE = 20.0
"""dB(A) of a robot that stands: a quiet room."""
_DRIVING_NOISE = 45.0
"""dB(A) of the wheels alone."""


@dataclass(frozen=True, slots=True)
class BatteryState:
    """``level`` is 0..1 of the ``capacity`` (Wh), ``voltage`` V at its poles, ``current`` A.

    The current is positive while it charges, as in ROS; ``temperature`` in degrees Celsius.
    """

    level: float
    capacity: float
    voltage: float
    current: float
    temperature: float
    is_docked: bool

    @property
    def is_charging(self) -> bool:
        """Whether energy comes in."""
        return self.current > 0.0

    @property
    def is_full(self) -> bool:
        """Whether no more goes in."""
        return self.level >= 1.0


def battery_state(
    capacity: float,
    resistance: float,
    *,
    charge: float,
    power: float,
    temperature: float,
    is_docked: bool,
) -> BatteryState:
    """Return the state at a charge, Wh, while ``power`` W are taken out (negative: brought in).

    ``capacity`` is in Wh, the inner ``resistance`` in ohm, ``temperature`` in degrees Celsius.
    The current I solves power = (open voltage - I resistance) I.
    """
    level = min(1.0, charge / capacity)
    open_voltage = open_circuit_voltage(level)
    if resistance > 0.0:
        most = open_voltage**2 / (4.0 * resistance)
        root = math.sqrt(max(0.0, open_voltage**2 - 4.0 * resistance * min(power, most)))
        drawn = (open_voltage - root) / (2.0 * resistance)
    else:
        drawn = power / open_voltage
    return BatteryState(
        level=level,
        capacity=capacity,
        voltage=open_voltage - drawn * resistance,
        current=-drawn,
        temperature=temperature,
        is_docked=is_docked,
    )


def open_circuit_voltage(level: float) -> float:
    """Return the voltage, V, of the pack at rest, at a charge of 0..1.

    A usual lithium-ion curve: 3.0 V a cell when empty, steep below 20 %, 3.7 V in the middle,
    4.2 V when full.
    """
    cell = 3.0 + 0.55 * (1.0 - math.exp(-15.0 * level)) + 0.65 * level**2
    return CELLS * cell


def noise_level(brush: SimulatedBrush, fan: SimulatedFan, duty: tuple[float, float]) -> float:
    """Return how loud a robot that drives is, dB(A) at 1 m, at the duty of brush and fan, 0..1.

    Powers of sound add up; that of a fan goes with the fifth power of its speed (fan laws).
    """
    sound = 10.0 ** (_DRIVING_NOISE / 10.0)
    for level, share in ((brush.noise_level, duty[0]), (fan.noise_level, duty[1])):
        if share > 0.0:
            sound += 10.0 ** ((level + 50.0 * math.log10(share)) / 10.0)
    return 10.0 * math.log10(sound)
