"""Compiled sensors that look down: cliff sensors, wheel drops, and what ground is under a point."""

from __future__ import annotations

import math

from roomba.compilation import inner_part, part
from roomba.world.engine.state.arrays import DROP, FLOOR, Row, Rows


@inner_part
def ground_at(cells: Rows, home: Row, x: float, y: float) -> int:
    """Return what the ground is at a point: FLOOR, CARPET or DROP; FLOOR outside of the home."""
    row = math.floor((y - home.bottom) / home.resolution)
    column = math.floor((x - home.left) / home.resolution)
    if not (0 <= row < home.rows and 0 <= column < home.columns):
        return FLOOR
    return int(cells[home.cells_at + row * home.columns + column].ground)


@part
def is_drop(
    cells: Rows, home: Row, body: Row, cosine: float, sine: float, ahead: float, aside: float
) -> float:
    """Return 1 if there is no floor at a point of the body, 0 if there is."""
    x = body.x + cosine * ahead - sine * aside
    y = body.y + sine * ahead + cosine * aside
    return 1.0 if ground_at(cells, home, x, y) == DROP else 0.0


@inner_part
def feel_ground(cells: Rows, home: Row, body: Row, numbers: Row) -> None:
    """Let cliff sensors and wheel drops feel what is below them."""
    if home.has_drops == 0.0:
        # Most homes have no drop: nothing to look for.
        blind = max(body.lifted, body.cliff_dirty)
        body.cliff_left = body.cliff_front_left = blind
        body.cliff_front_right = body.cliff_right = blind
        body.drop_left = body.drop_right = body.lifted
        return
    cosine, sine = math.cos(body.theta), math.sin(body.theta)
    blind = max(body.lifted, body.cliff_dirty)
    body.cliff_left = max(
        blind,
        is_drop(cells, home, body, cosine, sine, numbers.cliff_a_ahead, numbers.cliff_a_aside),
    )
    body.cliff_front_left = max(
        blind,
        is_drop(cells, home, body, cosine, sine, numbers.cliff_b_ahead, numbers.cliff_b_aside),
    )
    body.cliff_front_right = max(
        blind,
        is_drop(cells, home, body, cosine, sine, numbers.cliff_c_ahead, numbers.cliff_c_aside),
    )
    body.cliff_right = max(
        blind,
        is_drop(cells, home, body, cosine, sine, numbers.cliff_d_ahead, numbers.cliff_d_aside),
    )
    half = 0.5 * numbers.track
    body.drop_left = max(body.lifted, is_drop(cells, home, body, cosine, sine, 0.0, half))
    body.drop_right = max(body.lifted, is_drop(cells, home, body, cosine, sine, 0.0, -half))
