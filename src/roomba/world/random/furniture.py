"""Furniture of a home that a seed makes: pieces along walls, tables with chairs."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import shapely

from roomba.geometry import Pose
from roomba.world.catalogue.furniture import KINDS, furniture_at
from roomba.world.home.home import Furniture, Rectangle

ALONG_WALLS: Final = (
    ("sofa", "tv_bench", "armchair", "bookshelf", "sideboard", "plant", "lamp", "box"),
    ("bed", "nightstand", "wardrobe", "desk", "plant", "lamp", "bag"),
    ("kitchen_counter", "sink_unit", "stove", "fridge", "waste_bin", "stool"),
    ("toilet", "washbasin", "bathtub", "washing_machine", "waste_bin"),
    ("shoe_cabinet", "coat_rack", "shoes", "plant"),
)
"""What stands at the walls of a room, for each use of a room."""
_SEVERAL: Final = ("plant", "lamp", "box", "nightstand", "kitchen_counter", "stool")
"""Kinds of which a room may have several."""
_TABLES: Final = ("dining_table", "table", "coffee_table")
_FULL: Final = 0.38
"""Share of a room that furniture covers at most."""
_TRIES: Final = 12
_DOOR_DEPTH: Final = 0.75
"""m; distance before a door that is kept free."""
_NEAREST: Final = 0.02
"""m; the least distance between pieces; the robot may fit through or not."""


def random_furniture(
    room: Rectangle, doors: list[Rectangle], random: np.random.Generator, prefix: str
) -> list[Furniture]:
    """Return pieces inside of a room, its bare floor, which keep ``doors`` clear."""
    clear = [
        shapely.box(*_bounds(door)).buffer(_DOOR_DEPTH, cap_style="square", join_style="mitre")
        for door in doors
    ]
    setting = _Setting(shapely.box(*_bounds(room)), clear)
    pieces: list[Furniture] = []
    kinds = list(ALONG_WALLS[int(random.integers(len(ALONG_WALLS)))])
    wanted = random.uniform(0.08, _FULL) * setting.room.area
    for _ in range(_TRIES):
        if setting.covered >= wanted or not kinds:
            break
        kind = str(random.choice(kinds))
        pose = _at_wall(room, kind, random)
        added = setting.added([furniture_at(f"{prefix} {kind} {len(pieces)}", kind, pose)])
        if added and kind not in _SEVERAL:
            kinds.remove(kind)
        pieces += added
    if setting.room.area > 8.0 and random.random() < 0.7:
        for _ in range(_TRIES):
            group = _table(room, random, prefix)
            if added := setting.added(group):
                pieces += added
                break
    return pieces


class _Setting:
    """The furniture of a room while it is being filled."""

    def __init__(self, room: shapely.Polygon, clear: list[shapely.Geometry]) -> None:
        self.room = room
        self.covered = 0.0
        self._taken = shapely.union_all(clear) if clear else shapely.Point()

    def added(self, group: list[Furniture]) -> list[Furniture]:
        """Return a group if it has room, and take that room; else nothing."""
        outlines = [_outline(piece) for piece in group]
        whole = shapely.union_all(outlines)
        if not self.room.buffer(1e-6).contains(whole):
            return []
        if whole.buffer(_NEAREST).intersects(self._taken):
            return []
        self._taken = shapely.union(self._taken, whole)
        self.covered += whole.area
        return group


def _bounds(area: Rectangle) -> tuple[float, float, float, float]:
    return area.x_min, area.y_min, area.x_max, area.y_max


def _outline(piece: Furniture) -> shapely.Geometry:
    """Return the rectangle that a piece of its kind takes."""
    size = KINDS[piece.kind].size
    corners = [
        piece.pose.compose(Pose(x * size.front, y * size.side, 0.0))
        for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))
    ]
    return shapely.Polygon([(corner.x, corner.y) for corner in corners])


def _at_wall(room: Rectangle, kind: str, random: np.random.Generator) -> Pose:
    """Return a pose with the back at one of the four walls."""
    size = KINDS[kind].size
    gap = size.front + float(random.choice((0.0, 0.0, 0.0, random.uniform(0.0, 0.3))))
    facing = int(random.integers(4))
    along = random.random()
    x = room.x_min + size.side + along * (room.x_max - room.x_min - 2.0 * size.side)
    y = room.y_min + size.side + along * (room.y_max - room.y_min - 2.0 * size.side)
    places = (
        (room.x_min + gap, y),
        (x, room.y_min + gap),
        (room.x_max - gap, y),
        (x, room.y_max - gap),
    )
    theta = (0.0, 0.5 * math.pi, math.pi, -0.5 * math.pi)[facing]
    return Pose(*places[facing], theta)


def _table(room: Rectangle, random: np.random.Generator, prefix: str) -> list[Furniture]:
    """Return a table somewhere in a room, with chairs that stand before it, not all in order."""
    kind = str(random.choice(_TABLES))
    size = KINDS[kind].size
    pose = Pose(
        random.uniform(room.x_min + 0.8, max(room.x_max - 0.8, room.x_min + 0.81)),
        random.uniform(room.y_min + 0.8, max(room.y_max - 0.8, room.y_min + 0.81)),
        float(random.choice((0.0, 0.5 * math.pi))) + random.normal(0.0, 0.05),
    )
    group = [furniture_at(f"{prefix} {kind}", kind, pose)]
    if kind == "coffee_table":
        return group
    reach = size.front + 0.5 * KINDS["chair"].size.depth + random.uniform(-0.02, 0.15)
    for number in range(int(random.integers(0, 5))):
        side = 1.0 if number % 2 else -1.0
        aside = (0.25 if number < 2 else -0.25) * size.width
        turned = (math.pi if side > 0.0 else 0.0) + random.normal(0.0, 0.12)
        place = pose.compose(Pose(side * reach, aside, turned))
        group.append(furniture_at(f"{prefix} chair {number}", "chair", place))
    return group
