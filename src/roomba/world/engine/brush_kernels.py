"""Compiled brushes: what they pick up, what the dirt sensor counts, the motor's current."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import entry, inner_part, part
from roomba.world.engine.state.arrays import CARPET, Row
from roomba.world.engine.state.random_kernels import next_normal

_LEAST: Final = 20
"""Micrograms; a smaller amount is picked up completely."""


@inner_part
def sweep(
    dirt: NDArray[np.int32],
    first: int,
    shape: tuple[int, int],
    place: tuple[float, float, float],
    brush: tuple[float, float],
    keep_of_pass: float,
    middle: tuple[float, float, float],
    length: float,
    turn: float,
    room_in_bin: int,
) -> int:
    """Pick up dirt under the brush during one step; returns the micrograms taken from the floor.

    In the step the body goes ``length`` m and turns by ``turn`` rad, around the pose ``middle``.
    ``dirt`` holds the cells of a grid of ``shape`` from number ``first`` on; ``place`` is its
    resolution and lower left corner; ``brush`` width and depth. Every cell whose middle lies under
    the brush loses the share 1 - keep_of_pass**(way / depth), where ``way`` is what the bristles
    travel over it, so that a pass takes the same share in one step or in many.
    """
    if room_in_bin <= 0 or keep_of_pass >= 1.0 or (length == 0.0 and turn == 0.0):
        return 0
    resolution = place[0]
    half_width, half_depth = 0.5 * brush[0], 0.5 * brush[1]
    decay = math.log(max(keep_of_pass, 1e-12)) / brush[1]
    x, y, theta = middle
    cosine, sine = math.cos(theta), math.sin(theta)
    reach_x = half_depth * abs(cosine) + half_width * abs(sine)
    reach_y = half_depth * abs(sine) + half_width * abs(cosine)
    rows, columns = shape
    first_row = max(0, math.floor((y - reach_y - place[2]) / resolution))
    last_row = min(rows - 1, math.floor((y + reach_y - place[2]) / resolution))
    first_column = max(0, math.floor((x - reach_x - place[1]) / resolution))
    last_column = min(columns - 1, math.floor((x + reach_x - place[1]) / resolution))
    taken = 0
    for row in range(first_row, last_row + 1):
        dy = place[2] + (row + 0.5) * resolution - y
        for column in range(first_column, last_column + 1):
            cell = first + row * columns + column
            amount = dirt[cell]
            if amount == 0:
                continue
            dx = place[1] + (column + 0.5) * resolution - x
            ahead = cosine * dx + sine * dy
            aside = cosine * dy - sine * dx
            if abs(ahead) > half_depth or abs(aside) > half_width:
                continue
            along, across = length - turn * aside, turn * ahead
            way = math.sqrt(along * along + across * across)
            picked = amount
            if amount > _LEAST:
                picked = int(amount * (1.0 - math.exp(decay * way)))
            picked = min(picked, room_in_bin - taken)
            dirt[cell] = amount - picked
            taken += picked
    return taken


@entry
def amount_under_disc(
    dirt: NDArray[np.int32], place: Floats, x: float, y: float, radius: float
) -> int:
    """Return the micrograms in all cells whose middles lie under a disc.

    ``dirt`` is int32 [rows, columns]; ``place`` float64 [3], resolution and lower left corner, m.
    """
    resolution = place[0]
    u = (x - place[1]) / resolution - 0.5
    v = (y - place[2]) / resolution - 0.5
    reach = radius / resolution
    rows, columns = dirt.shape
    total = 0
    for row in range(max(0, math.ceil(v - reach)), min(rows - 1, math.floor(v + reach)) + 1):
        half = math.sqrt(max(0.0, reach * reach - (row - v) ** 2))
        first = max(0, math.ceil(u - half))
        last = min(columns - 1, math.floor(u + half))
        for column in range(first, last + 1):
            total += dirt[row, column]
    return total


@part
def duty_now(body: Row) -> tuple[float, float]:
    """Return the duty of brush and fan, 0..1: both rest while the wheels stand."""
    if body.linear == 0.0 and body.angular == 0.0:
        return 0.0, 0.0
    return body.brush_duty, body.fan_duty


@inner_part
def clean(
    dirt: NDArray[np.int32],
    home: Row,
    world: Row,
    body: Row,
    numbers: Row,
    quantiles: NDArray[np.float32],
    ground: int,
    middle: tuple[float, float, float],
    length: float,
    turn: float,
    dt: float,
) -> None:
    """Let brush and fan work for one step of ``length`` m and ``turn`` rad.

    ``middle`` is the pose in the middle of the way.
    """
    by_brush = numbers.carpet_pickup if ground == CARPET else numbers.pickup
    brush_duty, fan_duty = duty_now(body)
    keep = (1.0 - by_brush * brush_duty) * (1.0 - numbers.fan_pickup * fan_duty)
    taken = 0
    if body.lifted == 0.0:
        taken = sweep(
            dirt,
            world.dirt_at,
            (home.dirt_rows, home.dirt_columns),
            (home.dirt_resolution, home.left, home.bottom),
            (numbers.brush_width, numbers.brush_depth),
            keep,
            middle,
            length,
            turn,
            int(numbers.bin_capacity) - body.in_bin,
        )
    body.in_bin += taken
    sense_cleaning(body, numbers, quantiles, ground, taken, dt)


@inner_part
def sense_cleaning(
    body: Row,
    numbers: Row,
    quantiles: NDArray[np.float32],
    ground: int,
    taken: int,
    dt: float,
) -> None:
    """Count the grains that came in, and measure the brush motor's current."""
    power = numbers.carpet_power if ground == CARPET else numbers.brush_power
    current = power * duty_now(body)[0] / numbers.voltage
    grains = taken / numbers.grain
    if numbers.noisy > 0.0:
        current += numbers.current_noise * next_normal(body, quantiles)
        if grains > 0.0:
            # Few grains come by chance: a normal number is near enough to Poisson's.
            grains += math.sqrt(grains) * next_normal(body, quantiles)
            grains = max(0.0, math.floor(grains + 0.5))
    if body.dirt_sensor_blocked > 0.0:
        grains = 0.0
    newest = min(grains / dt, numbers.most_grains)
    body.grains += (newest - body.grains) * dt / (numbers.counting_time + dt)
    body.brush_current = max(current, 0.0)
