"""Compiled station: its halo and two infrared beams, and whether the contacts touch.

The station looks the way that the docked robot comes from. As it looks, red lies to its left and
green to its right, and both are seen in the middle.
"""

from __future__ import annotations

import math
from typing import Final

from roomba.angles import wrapped
from roomba.compilation import inner_part
from roomba.world.engine.lidar.face_kernels import ray_to_faces
from roomba.world.engine.state.arrays import Infrared, Row, Solid
from roomba.world.home.surface import Finish

_GLASS: Final = int(Finish.GLASS)
_LOW: Final = int(Finish.LOW)
_HALO, _RED, _GREEN = int(Infrared.HALO), int(Infrared.RED), int(Infrared.GREEN)


@inner_part
def sense_station(solid: Solid, home: Row, body: Row, numbers: Row) -> None:
    """Receive the station's beams, and feel its contacts."""
    body.beams = 0
    body.docked = 0.0
    dx, dy = body.x - home.station_x, body.y - home.station_y
    square = dx * dx + dy * dy
    reach = max(numbers.beam, numbers.halo) + numbers.station_ahead
    if square > reach * reach or body.station_dead > 0.0:
        return
    is_there = square <= numbers.position_tolerance * numbers.position_tolerance
    askew = body.theta - home.station_theta - numbers.contacts
    is_straight = abs(wrapped(askew)) <= numbers.angle_tolerance
    if is_there and is_straight and body.lifted == 0.0:
        body.docked = 1.0
    if body.infrared_blocked == 0.0:
        body.beams = seen_beams(solid, home, body, numbers)


@inner_part
def seen_beams(solid: Solid, home: Row, body: Row, numbers: Row) -> int:
    """Return the beams, see Infrared, that reach the receiver on top of the body."""
    cosine, sine = math.cos(home.station_theta), math.sin(home.station_theta)
    front_x = home.station_x + numbers.station_ahead * cosine
    front_y = home.station_y + numbers.station_ahead * sine
    away_x, away_y = body.x - front_x, body.y - front_y
    # In the direction in which the station looks, opposite to the docked robot's.
    ahead, aside = -cosine * away_x - sine * away_y, sine * away_x - cosine * away_y
    away = math.hypot(ahead, aside)
    seen = _HALO if away <= numbers.halo else 0
    if away <= numbers.beam and ahead > 0.0:
        angle = math.atan2(aside, ahead)
        if -numbers.half_overlap <= angle <= numbers.beam_angle:
            seen |= _RED
        if -numbers.beam_angle <= angle <= numbers.half_overlap:
            seen |= _GREEN
    if seen != 0 and not is_in_sight(solid, home, front_x, front_y, body.x, body.y):
        seen = 0
    return seen


@inner_part
def is_in_sight(solid: Solid, home: Row, from_x: float, from_y: float, x: float, y: float) -> bool:
    """Tell whether nothing of the home stands between the station's front and a point.

    The light passes through glass and over what is low; by way of a mirror it is too faint.
    """
    steps = math.ceil(2.0 * math.hypot(x - from_x, y - from_y) / home.resolution)
    # The front itself may lie in a cell of the station.
    for step in range(2, steps + 1):
        share = step / steps
        row = math.floor((from_y + share * (y - from_y) - home.bottom) / home.resolution)
        column = math.floor((from_x + share * (x - from_x) - home.left) / home.resolution)
        inside = 0 <= row < home.rows and 0 <= column < home.columns
        if not inside or solid.cells[home.cells_at + row * home.columns + column].solid:
            return False
    away = math.hypot(x - from_x, y - from_y)
    if home.faces_end > home.faces_at and away > 0.0:
        cosine, sine = (x - from_x) / away, (y - from_y) / away
        for index in range(home.faces_at, home.faces_end):
            finish = solid.faces[index].finish
            if finish not in (_GLASS, _LOW):
                way, _, _ = ray_to_faces(
                    solid.faces, index, index + 1, from_x, from_y, cosine, sine, -1
                )
                if way < away:
                    return False
    return True
