"""Compiled sources of dirt: now and then a crumb falls around them."""

from __future__ import annotations

import math
from typing import Final

from roomba.compilation import inner_part
from roomba.world.engine.state.arrays import Dirt, Row
from roomba.world.engine.state.random_kernels import next_exponential, next_uniform
from roomba.world.home.dirt import FULL_CELL

_TRIES: Final = 64
"""Attempts to find a place on the floor before a crumb counts as fallen on the furniture."""


@inner_part
def let_dirt_fall(dirt: Dirt, home: Row, world: Row, crumb: int) -> None:
    """Let fall what is due in a world by now, crumbs of ``crumb`` micrograms."""
    for number in range(world.falls_at, world.falls_end):
        fall = dirt.falls[number]
        source = dirt.sources[fall.source]
        while fall.time <= world.time:
            drop_crumb(dirt, home, world, source, crumb)
            fall.time += source.mean_wait * next_exponential(world)


@inner_part
def drop_crumb(dirt: Dirt, home: Row, world: Row, source: Row, crumb: int) -> None:
    """Let a crumb fall as the Gaussian of its source says, on floor; else it lands nowhere."""
    size, reach = home.dirt_resolution, 3.0 * source.radius
    rows, columns = home.dirt_rows, home.dirt_columns
    left, bottom = home.left, home.bottom
    low_x, high_x = max(left, source.x - reach), min(left + columns * size, source.x + reach)
    low_y, high_y = max(bottom, source.y - reach), min(bottom + rows * size, source.y + reach)
    for _ in range(_TRIES):
        x = low_x + (high_x - low_x) * next_uniform(world)
        y = low_y + (high_y - low_y) * next_uniform(world)
        away = math.hypot(x - source.x, y - source.y) / source.radius
        if next_uniform(world) >= math.exp(-0.5 * away * away):
            continue
        row = min(max(math.floor((y - bottom) / size), 0), rows - 1)
        column = min(max(math.floor((x - left) / size), 0), columns - 1)
        cell = row * columns + column
        if not dirt.floors[home.floors_at + cell]:
            continue
        if dirt.micrograms[world.dirt_at + cell] <= FULL_CELL - crumb:
            dirt.micrograms[world.dirt_at + cell] += crumb
            world.brought_in += crumb
            return
