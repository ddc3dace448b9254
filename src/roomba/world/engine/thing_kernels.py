"""Compiled moving things: doors, chairs and people go along their tracks, and wait for robots."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.compilation import inner_part
from roomba.world.engine.contact_kernels import way_to_box
from roomba.world.engine.state.arrays import Row, Solid

_MARGIN: Final = 2e-3
"""m; nothing moves nearer to a robot than this."""


@inner_part
def move_thing(
    solid: Solid,
    tracks: NDArray[np.float64],
    world: Row,
    thing: Row,
    radius: float,
    dt: float,
) -> None:
    """Let a thing go on by ``dt`` s of its track; it waits while a robot is in its way.

    ``radius`` is that of the robots' bodies, m.
    """
    time = thing.time + dt
    row = thing.row
    while row < thing.last_row and tracks[row + 1, 0] <= time:
        row += 1
    x, y, theta, present = tracks[row, 1], tracks[row, 2], tracks[row, 3], tracks[row, 4]
    if row < thing.last_row and time > tracks[row, 0]:
        share = (time - tracks[row, 0]) / (tracks[row + 1, 0] - tracks[row, 0])
        x += share * (tracks[row + 1, 1] - x)
        y += share * (tracks[row + 1, 2] - y)
        theta += share * wrapped(tracks[row + 1, 3] - theta)
    stays = thing.x == x and thing.y == y and thing.theta == theta and thing.present == present
    if present > 0.0 and not stays and robot_is_there(solid, world, thing, radius, x, y, theta):
        return
    thing.x, thing.y, thing.theta, thing.present = x, y, theta, present
    thing.time, thing.row = time, row


@inner_part
def robot_is_there(
    solid: Solid, world: Row, thing: Row, radius: float, x: float, y: float, theta: float
) -> bool:
    """Tell whether a thing that moves to a pose touches a robot there, other than moving away."""
    for number in range(world.robots_at, world.robots_end):
        body = solid.robots[number]
        away = way_to_thing(solid, thing, x, y, theta, body.x, body.y)
        if away < radius + _MARGIN:
            now = way_to_thing(solid, thing, thing.x, thing.y, thing.theta, body.x, body.y)
            if thing.present == 0.0 or away < now:
                return True
    return False


@inner_part
def way_to_thing(
    solid: Solid, thing: Row, x: float, y: float, theta: float, to_x: float, to_y: float
) -> float:
    """Return the distance from a thing, if it were at a pose, to a point."""
    cosine, sine = math.cos(theta), math.sin(theta)
    dx, dy = to_x - x, to_y - y
    ahead, aside = cosine * dx + sine * dy, cosine * dy - sine * dx
    nearest = math.inf
    for box in range(thing.boxes_at, thing.boxes_end):
        away, _, _ = way_to_box(solid.boxes[box], ahead, aside)
        nearest = min(nearest, away)
    return nearest
