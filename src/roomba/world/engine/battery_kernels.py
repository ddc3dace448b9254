"""Compiled battery: the load, the charger's power, and the temperature."""

from __future__ import annotations

from roomba.compilation import inner_part
from roomba.world.engine.brush_kernels import duty_now
from roomba.world.engine.state.arrays import CARPET, Row

_HOUR = 3600.0


@inner_part
def drawn_power(body: Row, numbers: Row, ground: int) -> float:
    """Return what the robot draws, W."""
    half_turn = 0.5 * numbers.track * body.angular
    wheels = abs(body.linear - half_turn) + abs(body.linear + half_turn)
    brush = numbers.carpet_power if ground == CARPET else numbers.brush_power
    brush_duty, fan_duty = duty_now(body)
    return float(
        numbers.idle_power
        + numbers.drive_power * wheels
        + numbers.stall_power * (body.stall_left + body.stall_right)
        + brush * brush_duty
        + numbers.fan_power * fan_duty * fan_duty * fan_duty
    )


@inner_part
def offered_power(charge: float, numbers: Row) -> float:
    """Return what the station's charger brings at a charge (Wh), W: ever less when nearly full."""
    over = (charge / numbers.capacity - numbers.taper_from) / (1.0 - numbers.taper_from)
    return float(numbers.charge_power * (1.0 - (1.0 - numbers.taper_to) * min(max(over, 0.0), 1.0)))


@inner_part
def use_battery(body: Row, numbers: Row, ground: int, dt: float) -> None:
    """Take and bring energy for one step: charge = first charge - used + charged, to rounding.

    On the station the charger feeds the robot and the battery is charged; an empty battery gives
    nothing.
    """
    if body.docked > 0.0:
        energy = offered_power(body.charge, numbers) * dt / _HOUR
        energy = min(energy, numbers.capacity - body.charge)
        body.charged += energy
        body.charge += energy
        body.power = -energy * _HOUR / dt
    else:
        energy = drawn_power(body, numbers, ground) * dt / _HOUR
        energy = min(energy, body.charge)
        body.used += energy
        body.charge -= energy
        body.power = energy * _HOUR / dt
    warm = numbers.ambient + numbers.heating * abs(body.power)
    share = dt / (numbers.heating_time + dt)
    body.temperature += (warm - body.temperature) * share
