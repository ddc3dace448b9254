"""The battery's voltage, current and temperature, and the robot's noise level."""

from __future__ import annotations

import math
from dataclasses import dataclass

from roomba.configuration.simulation import SimulationConfig


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
    cells: int,
    *,
    charge: float,
    power: float,
    temperature: float,
    is_docked: bool,
) -> BatteryState:
    """Return the state at a charge, Wh, while ``power`` W are taken out (negative: brought in).

    ``capacity`` is in Wh, the inner ``resistance`` in ohm, ``cells`` are in series, and
    ``temperature`` is in degrees Celsius.
    The current I solves power = (open voltage - I resistance) I.
    """
    level = min(1.0, charge / capacity)
    open_voltage = open_circuit_voltage(level, cells)
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


def open_circuit_voltage(level: float, cells: int) -> float:
    """Return the voltage, V, of so many cells in series at rest, at a charge of 0..1.

    A usual lithium-ion curve: 3.0 V a cell when empty, steep below 20 %, 3.7 V in the middle,
    4.2 V when full.
    """
    cell = 3.0 + 0.55 * (1.0 - math.exp(-15.0 * level)) + 0.65 * level**2
    return cells * cell


def noise_level(truth: SimulationConfig, duty: tuple[float, float]) -> float:
    """Return how loud a robot that drives is, dB(A) at 1 m, at the duty of brush and fan, 0..1.

    Powers of sound add up; that of a fan goes with the fifth power of its speed (fan laws).
    """
    sound = 10.0 ** (truth.wheels.noise_level / 10.0)
    for level, share in ((truth.brush.noise_level, duty[0]), (truth.fan.noise_level, duty[1])):
        if share > 0.0:
            sound += 10.0 ** ((level + 50.0 * math.log10(share)) / 10.0)
    return 10.0 * math.log10(sound)
