"""Compiled lidar that turns while it measures: each beam from its own pose, with its own errors.

A sweep begins at the lidar's rhythm; in each step of the world those beams are measured that are
due by then. A whole sweep waits for the delay of the line, and then becomes the newest scan; its
stamp is the time of its first beam.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.angles import wrapped
from roomba.arrays import Floats32
from roomba.compilation import inner_part
from roomba.world.engine.lidar.bundle_kernels import BUNDLE, aim, draw
from roomba.world.engine.lidar.light_kernels import (
    Met,
    Surroundings,
    is_echo,
    lidar_at,
    ray_at,
    ray_with_cell,
)
from roomba.world.engine.lidar.march_kernels import march
from roomba.world.engine.state.arrays import Row, Rows
from roomba.world.engine.state.random_kernels import next_bits

_SLACK: Final = 1e-9
"""s; a beam is due when the time is as near to it as this."""
_FLATTEST: Final = 0.1
"""Cosine; no beam counts as more grazing than this."""
_UNIT_16: Final = 1.0 / (1 << 16)
_UNIT_20: Final = 1.0 / (1 << 20)


@inner_part
def sweep(
    around: Surroundings, bundles: Rows, scans: tuple[Floats32, Floats32, Floats32], dt: float
) -> None:
    """Measure what is due in the step of ``dt`` s that ends now; deliver what has waited.

    ``scans``, float32 [robots, beams] each: the sweep that is made, one that is on the line, and
    the newest that arrived. ``bundles`` is BEAMS [1], to work in.
    """
    world, robot, numbers = around.world, around.robot, around.numbers
    body = around.solid.robots[robot]
    made, underway, arrived = scans
    beams = made.shape[1]
    while True:
        if body.sweeps == 0.0 and not begin_sweep(world, body, numbers, dt):
            break
        due = beams
        if numbers.time_increment > 0.0:
            due = math.floor((world.time - body.sweep_start + _SLACK) / numbers.time_increment) + 1
            due = min(due, beams)
        measure_beams(around, bundles, made, due, dt)
        if due < beams:
            break
        # The delay is no longer than the period: what was on the line has arrived by now.
        if body.is_underway > 0.0:
            deliver(body, robot, underway, arrived)
        for beam in range(beams):
            underway[robot, beam] = made[robot, beam]
        body.is_underway, body.underway_stamp = 1.0, body.sweep_start
        body.arrival = body.sweep_start + numbers.sweep_time + numbers.scan_delay
        body.sweeps = 0.0
    if body.is_underway > 0.0 and body.arrival <= world.time + _SLACK:
        deliver(body, robot, underway, arrived)


@inner_part
def begin_sweep(world: Row, body: Row, numbers: Row, dt: float) -> bool:
    """Begin a sweep if it is time for one.

    Sweeps that should have begun before this step are left out; so are, in a long step, those that
    a newer one replaces before the step ends: nothing sees them.
    """
    period = numbers.scan_period
    since = min(dt, numbers.sweep_time + numbers.scan_delay + period)
    late = world.time - since - body.next_scan
    if late > _SLACK:
        body.next_scan += math.ceil((late - _SLACK) / period) * period
    if body.next_scan > world.time + _SLACK:
        return False
    body.sweeps, body.sweep_start, body.next_beam = 1.0, body.next_scan, 0.0
    body.next_scan += period
    body.last_range = math.inf
    body.sweep_key = next_bits(body) if numbers.noisy > 0.0 else np.uint64(0)
    return True


@inner_part
def deliver(body: Row, robot: int, underway: Floats32, arrived: Floats32) -> None:
    """Let the sweep on the line be the newest scan."""
    for beam in range(arrived.shape[1]):
        arrived[robot, beam] = underway[robot, beam]
    body.scans += 1
    body.scan_stamp = body.underway_stamp
    body.is_underway = 0.0


@inner_part
def measure_beams(
    around: Surroundings, bundles: Rows, ranges: Floats32, due: int, dt: float
) -> None:
    """Measure the beams from the next one to before ``due``, each where the lidar was at its time.

    Between its poses before and after the step the lidar goes along an arc.
    """
    world, numbers = around.world, around.numbers
    body = around.solid.robots[around.robot]
    first_x, first_y, first_theta = lidar_at(
        body, numbers, body.before_x, body.before_y, body.before_theta
    )
    last_x, last_y, last_theta = lidar_at(body, numbers, body.x, body.y, body.theta)
    way = last_x - first_x, last_y - first_y, wrapped(last_theta - first_theta)
    start, bundle = (first_x, first_y, first_theta), bundles[0]
    for first in range(int(body.next_beam), due, BUNDLE):
        draw(bundle, np.uint32(body.sweep_key & np.uint64(0xFFFFFFFF)), first)
        aim(bundle, (body.sweep_start, world.time - dt), dt, numbers, first, start, way)
        march(bundle, around.solid.squares, around.home, numbers.max_range)
        for beam in range(first, min(first + BUNDLE, due)):
            ranges[around.robot, beam] = measure(around, bundle, beam - first)
    body.next_beam = due


@inner_part
def with_noise(found: float, facing: float, numbers: Row, chance: float) -> float:
    """Return a range, m, with noise and rounding: ``chance`` is a normal random number."""
    sigma = numbers.range_noise + numbers.noise_growth * found * found
    sigma *= 1.0 + numbers.grazing_noise * (1.0 / max(facing, _FLATTEST) - 1.0)
    found += sigma * chance
    if numbers.range_step > 0.0:
        found = numbers.range_step * math.floor(found / numbers.range_step + 0.5)
    return found


@inner_part
def measure(around: Surroundings, beams: Row, number: int) -> float:
    """Return what a beam of a bundle measures, m: inf without an echo, -inf too near."""
    numbers, quantiles = around.numbers, around.quantiles
    body = around.solid.robots[around.robot]
    if body.lidar_blocked > 0.0:
        return math.inf
    first, second, third = beams.first[number], beams.second[number], beams.third[number]
    x, y, angle = beams.x[number], beams.y[number], beams.angle[number]
    chance = 1.0
    if numbers.noisy > 0.0:
        chance = float(third >> np.uint32(12)) * _UNIT_20
    cell = beams.way[number], beams.facing[number]
    met = ray_with_cell(around, x, y, beams.cosine[number], beams.sine[number], chance, cell)
    found = met.way
    last, body.last_range = body.last_range, found
    if numbers.spot > 0.0 and abs(found - last) > numbers.edge:
        right = ray_at(around, x, y, angle - numbers.spot, chance).way
        left = ray_at(around, x, y, angle + numbers.spot, chance).way
        if abs(left - right) > numbers.edge and left + right < math.inf:
            # The spot lies on both sides of an edge: chance decides how much of either counts.
            share = float(second >> np.uint32(16)) * _UNIT_16
            found = share * left + (1.0 - share) * right
            farther = found - met.way
            x, y = met.x + farther * beams.cosine[number], met.y + farther * beams.sine[number]
            met = Met(found, met.facing, met.what, x, y, met.light)
    if found > numbers.max_range:
        return math.inf
    if numbers.noisy > 0.0:
        if float(first >> np.uint32(12)) * _UNIT_20 < numbers.misses:
            return math.inf
        if numbers.white_reach > 0.0:
            fading = float(quantiles[third & np.uint32(4095)])
            if not is_echo(around, met, fading):
                return math.inf
        found = with_noise(found, met.facing, numbers, float(quantiles[first & np.uint32(4095)]))
    if found < numbers.min_range:
        return -math.inf
    return found if found < numbers.max_range else math.inf
