"""Rooms of a home that a seed makes: a rectangle cut again and again, with a door to each room."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from roomba.world.home.home import Rectangle

GRID: Final = 0.05
"""m; all walls lie on this grid."""
WALL: Final = 0.10
"""m; thickness of inner walls, whose middles are the borders of rooms."""
_LEAST_SIDE: Final = 2.0
_LARGE: Final = 22.0
"""m2; a room that is larger is cut in any case."""
_SMALL: Final = 9.0
"""m2; a room that is smaller is not cut."""
_LEAST_DOOR: Final = 0.70
_WIDEST_DOOR: Final = 1.05
_JAMB: Final = 0.15
"""m; from a door to the end of its piece of wall: half a crossing wall, and a little."""
_SECOND_DOOR: Final = 0.25
"""Probability of a door between rooms that are connected already."""


@dataclass(frozen=True, slots=True)
class WallOpening:
    """A door's opening in the wall between two rooms, by their numbers."""

    first: int
    second: int
    area: Rectangle


def random_rooms(random: np.random.Generator) -> list[Rectangle]:
    """Return rooms that touch, the borders between them being the middles of walls, m."""
    width, height = _snapped(random.uniform(4.5, 13.0)), _snapped(random.uniform(4.0, 9.5))
    return _cut(Rectangle(0.0, 0.0, width, height), random)


def random_openings(rooms: list[Rectangle], random: np.random.Generator) -> list[WallOpening]:
    """Return doors that lead to every room, and some more."""
    shared = [
        (first, second, wall)
        for first in range(len(rooms))
        for second in range(first + 1, len(rooms))
        if (wall := _shared_wall(rooms[first], rooms[second])) is not None
    ]
    random.shuffle(shared)  # type: ignore[arg-type]
    group = list(range(len(rooms)))
    openings = []
    for first, second, wall in shared:
        is_needed = group[first] != group[second]
        if not is_needed and random.random() > _SECOND_DOOR:
            continue
        old, new = group[second], group[first]
        group = [new if member == old else member for member in group]
        openings.append(WallOpening(first, second, _door_in(wall, random)))
    return openings


def _snapped(length: float) -> float:
    return round(round(length / GRID) * GRID, 6)


def _cut(area: Rectangle, random: np.random.Generator) -> list[Rectangle]:
    width, height = area.x_max - area.x_min, area.y_max - area.y_min
    space, longer = width * height, max(width, height)
    if longer < 2.0 * _LEAST_SIDE or space < _SMALL:
        return [area]
    if space < _LARGE and random.random() < (_LARGE - space) / (_LARGE - _SMALL):
        return [area]
    share = random.uniform(0.35, 0.65)
    at = min(max(_snapped(share * longer), _LEAST_SIDE), _snapped(longer - _LEAST_SIDE))
    if width >= height:
        middle = area.x_min + at
        parts = (
            Rectangle(area.x_min, area.y_min, middle, area.y_max),
            Rectangle(middle, area.y_min, area.x_max, area.y_max),
        )
    else:
        middle = area.y_min + at
        parts = (
            Rectangle(area.x_min, area.y_min, area.x_max, middle),
            Rectangle(area.x_min, middle, area.x_max, area.y_max),
        )
    return [room for part in parts for room in _cut(part, random)]


def _shared_wall(one: Rectangle, other: Rectangle) -> Rectangle | None:
    """Return the line that two rooms share, if it is long enough for a door."""
    x_min, x_max = max(one.x_min, other.x_min), min(one.x_max, other.x_max)
    y_min, y_max = max(one.y_min, other.y_min), min(one.y_max, other.y_max)
    touches = abs(x_max - x_min) < 1e-6 or abs(y_max - y_min) < 1e-6
    long = max(x_max - x_min, y_max - y_min) >= _LEAST_DOOR + 2.0 * _JAMB
    return Rectangle(x_min, y_min, x_max, y_max) if touches and long else None


def _door_in(wall: Rectangle, random: np.random.Generator) -> Rectangle:
    along_x = wall.x_max - wall.x_min > wall.y_max - wall.y_min
    low, high = (wall.x_min, wall.x_max) if along_x else (wall.y_min, wall.y_max)
    room = high - low - 2.0 * _JAMB
    width = _snapped(min(room, random.uniform(_LEAST_DOOR, _WIDEST_DOOR)))
    start = _snapped(low + _JAMB + random.uniform(0.0, max(room - width, 0.0)))
    half = 0.5 * WALL
    if along_x:
        return Rectangle(start, wall.y_min - half, start + width, wall.y_min + half)
    return Rectangle(wall.x_min - half, start, wall.x_min + half, start + width)
