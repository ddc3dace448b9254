"""The compiled step of the world: its parts, one after the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry, inner_part
from roomba.world.engine.battery_kernels import use_battery
from roomba.world.engine.brush_kernels import clean
from roomba.world.engine.contact_kernels import feel_bumper
from roomba.world.engine.drive_kernels import drive
from roomba.world.engine.fall_kernels import let_dirt_fall
from roomba.world.engine.ground_kernels import feel_ground, ground_at
from roomba.world.engine.lidar.light_kernels import Surroundings
from roomba.world.engine.lidar.projection import ScanBuffers
from roomba.world.engine.lidar.scan_kernels import is_scan_due, scan
from roomba.world.engine.lidar.sweep_kernels import sweep
from roomba.world.engine.state.arrays import Row, Rows, State
from roomba.world.engine.station_kernels import sense_station
from roomba.world.engine.thing_kernels import move_thing


@entry
def advance(
    state: State,
    first: int,
    last: int,
    numbers: Rows,
    quantiles: NDArray[np.float32],
    buffers: ScanBuffers,
    dt: float,
    steps: int,
) -> None:
    """Let so many steps of ``dt`` s pass in the worlds from ``first`` to before ``last``.

    In each world things move, then one robot after the other, then dirt falls; then they scan.
    """
    row = numbers[0]
    for number in range(first, last):
        world = state.worlds[number]
        home = state.homes[world.home]
        for _ in range(steps):
            for thing in range(world.things_at, world.things_end):
                moving = state.solid.things[thing]
                move_thing(state.solid, state.tracks, world, moving, row.radius, dt)
            for robot in range(world.robots_at, world.robots_end):
                step_robot(state, home, world, robot, row, quantiles, dt)
            world.time += dt
            let_dirt_fall(state.dirt, home, world, int(row.crumb))
            for robot in range(world.robots_at, world.robots_end):
                if row.is_swept > 0.0:
                    around = Surroundings(state.solid, home, world, robot, row, quantiles)
                    scans = state.made, state.underway, state.ranges
                    sweep(around, buffers.bundles, scans, dt)
                elif is_scan_due(world, state.solid.robots[robot], row.scan_period):
                    scan(
                        state.solid,
                        state.edges,
                        home,
                        world,
                        robot,
                        row,
                        quantiles,
                        buffers,
                        state.ranges,
                    )


@inner_part
def step_robot(
    state: State,
    home: Row,
    world: Row,
    robot: int,
    numbers: Row,
    quantiles: NDArray[np.float32],
    dt: float,
) -> None:
    """Let a robot drive, feel and clean for ``dt`` s."""
    solid = state.solid
    body = solid.robots[robot]
    x, y, theta = body.x, body.y, body.theta
    body.before_x, body.before_y, body.before_theta = x, y, theta
    ground = ground_at(solid.cells, home, x, y)
    length, turn = drive(solid, home, world, robot, numbers, quantiles, ground, dt)
    feel_bumper(solid, home, world, robot, numbers.radius)
    feel_ground(solid.cells, home, body, numbers)
    middle = 0.5 * (x + body.x), 0.5 * (y + body.y), theta + 0.5 * turn
    clean(
        state.dirt.micrograms,
        home,
        world,
        body,
        numbers,
        quantiles,
        ground,
        middle,
        length,
        turn,
        dt,
    )
    sense_station(solid, home, body, numbers)
    use_battery(body, numbers, ground, dt)
