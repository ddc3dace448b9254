"""Homes that differ from their maps: furniture moved, things put down, doors shut."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Final

import numpy as np

from roomba.arrays import Mask
from roomba.configuration.body import BodyConfig
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.world.home.home import Door, Furniture, Home, MovingKind
from roomba.world.home.raster import cells_within, covered_cells, outline
from roomba.world.layers.assembly import standing_cells
from roomba_bench.coverage.floor import Disc

MOVABLE: Final = (
    "armchair",
    "bookshelf",
    "chair",
    "coffee_table",
    "desk",
    "dining_table",
    "lamp",
    "nightstand",
    "office_chair",
    "plant",
    "shoe_cabinet",
    "sideboard",
    "sofa",
    "table",
    "waste_bin",
)
"""Kinds of furniture that people push about."""
_FROM_STATION: Final = 1.2
"""m; no thing stands nearer to the station."""
_PUSHED: Final = (0.15, 1.2)
"""m; how far furniture is pushed."""
_CHAIR: Final = 0.4
"""m between the legs of a chair that is put down; each leg has a radius of _LEG."""
_LEG: Final = 0.02
_ROUND: Final = (0.06, 0.20)
"""m; radii of round things."""
_APART: Final = 0.02
"""m; the least gap between things."""
_BLOCK: Final = 0.12
"""m; radius of the things in a row across a doorway."""
_BLOCKS_APART: Final = 0.30
_ATTEMPTS: Final = 300


class Change(Enum):
    """How a home differs from its map."""

    FURNITURE = "moved furniture"
    """Two or three pieces stand elsewhere, and four to six chairs and round things stand about."""
    DOORS = "shut doors"
    """One or two doors are shut, or a row of things stands across the doorway."""


@dataclass(frozen=True, eq=False)
class Changed:
    """A home as it really is; its map shows it as it was. ``what`` was done, in words."""

    home: Home
    things: tuple[Disc, ...] = ()
    what: str = ""


def changed(home: Home, change: Change, seed: int) -> Changed:
    """Return the home with a change that depends on the seed."""
    random = np.random.default_rng([seed, list(Change).index(change)])
    if change is Change.DOORS:
        return _with_doors_shut(home, random)
    return _with_things(*_with_furniture_moved(home, random), random)


def _with_furniture_moved(home: Home, random: np.random.Generator) -> tuple[Home, list[str]]:
    pieces = [piece for piece in home.furniture if piece.on_map and piece.kind in MOVABLE]
    wanted = int(random.integers(2, 4))
    moved: list[str] = []
    for index in random.permutation(len(pieces)).tolist():
        if len(moved) == wanted:
            break
        elsewhere = _pushed(home, pieces[index], random)
        if elsewhere is not None:
            home = elsewhere
            moved.append(pieces[index].name)
    return home, moved


def _pushed(home: Home, piece: Furniture, random: np.random.Generator) -> Home | None:
    """Return the home with a piece of furniture moved a bit, or None if it fits nowhere."""
    height = BodyConfig().height
    others = [other for other in home.furniture if other is not piece]
    own = _grown(standing_cells(home.frame, [piece], height))
    rest = home.solid & (~own | home.walls | standing_cells(home.frame, others, height))
    taken = rest | home.drop | _near_station(home)
    for _ in range(_ATTEMPTS):
        way, course = random.uniform(*_PUSHED), random.uniform(-math.pi, math.pi)
        turn = random.uniform(-0.6, 0.6)
        there = pushed_by(piece, way * math.cos(course), way * math.sin(course), turn)
        cells = standing_cells(home.frame, [there], height)
        if cells.any() and not (cells & taken).any() and _is_inside(home.frame, there):
            furniture = (*others, there)
            return replace(home, solid=rest | cells, furniture=furniture)
    return None


def pushed_by(piece: Furniture, x: float, y: float, turn: float) -> Furniture:
    """Return a piece that was pushed by so much, m, and turned on the spot, rad."""
    at = piece.pose
    there = Pose(at.x + x, at.y + y, at.theta + turn)
    boxes = []
    for box in piece.boxes:
        away_x, away_y = box.x - at.x, box.y - at.y
        cosine, sine = math.cos(turn), math.sin(turn)
        boxes.append(
            replace(
                box,
                x=there.x + cosine * away_x - sine * away_y,
                y=there.y + sine * away_x + cosine * away_y,
                theta=box.theta + turn,
            )
        )
    return replace(piece, pose=there, boxes=tuple(boxes))


def _with_things(home: Home, moved: list[str], random: np.random.Generator) -> Changed:
    things: list[Disc] = []
    chairs, count = int(random.integers(1, 3)), int(random.integers(4, 7))
    for number in range(count):
        for _ in range(_ATTEMPTS):
            one = _chair(home, random) if number < chairs else [_round(home, random)]
            if all(_has_room(home, thing, things) for thing in one):
                things += one
                break
    what = f"{', '.join(moved)} moved; {chairs} chairs and {count - chairs} round things"
    return Changed(home, tuple(things), what)


def _anywhere(home: Home, random: np.random.Generator) -> tuple[float, float]:
    x_min, x_max, y_min, y_max = home.frame.extent
    return random.uniform(x_min, x_max), random.uniform(y_min, y_max)


def _round(home: Home, random: np.random.Generator) -> Disc:
    return (*_anywhere(home, random), round(random.uniform(*_ROUND), 3))


def _chair(home: Home, random: np.random.Generator) -> list[Disc]:
    middle = Pose(*_anywhere(home, random), random.uniform(-math.pi, math.pi))
    half = 0.5 * _CHAIR
    legs = [
        middle.compose(Pose(ahead, aside, 0.0))
        for ahead in (-half, half)
        for aside in (-half, half)
    ]
    return [(leg.x, leg.y, _LEG) for leg in legs]


def _has_room(home: Home, thing: Disc, others: Sequence[Disc]) -> bool:
    """Whether a thing would stand on free floor and away from the station."""
    x, y, radius = thing
    if not home.frame.contains(x, y):
        return False
    if math.hypot(x - home.station.x, y - home.station.y) < _FROM_STATION + radius:
        return False
    apart = (math.hypot(x - other[0], y - other[1]) - radius - other[2] for other in others)
    if any(gap < _APART for gap in apart):
        return False
    taken = home.solid | home.drop | home.map.solid
    return not (taken & cells_within(home.frame, radius + _APART, x, y)).any()


def _with_doors_shut(home: Home, random: np.random.Generator) -> Changed:
    doors = [home.doors[index] for index in random.permutation(len(home.doors)).tolist()]
    chosen = doors[: int(random.integers(1, 3))]
    names = ", ".join(door.name for door in chosen)
    if random.random() < 0.5:
        return Changed(with_shut(home, chosen), (), f"{names} shut")
    things = tuple(thing for door in chosen for thing in row_across(door))
    return Changed(home, things, f"things across {names}")


def with_shut(home: Home, doors: Sequence[Door]) -> Home:
    """Return a home whose doors are shut and stay so, while its map shows them open."""
    shut = covered_cells(home.frame, [outline(door.opening) for door in doors])
    names = {door.name for door in doors}
    moving = tuple(
        thing
        for thing in home.moving
        if not (thing.kind is MovingKind.DOOR and thing.name in names)
    )
    return replace(home, solid=home.solid | shut, moving=moving)


def row_across(door: Door) -> list[Disc]:
    """Return round things in a row across a doorway, too close together to pass between."""
    opening = door.opening
    x, y = 0.5 * (opening.x_min + opening.x_max), 0.5 * (opening.y_min + opening.y_max)
    across_x = opening.x_max - opening.x_min > opening.y_max - opening.y_min
    width = max(opening.x_max - opening.x_min, opening.y_max - opening.y_min)
    count = max(1, round(width / _BLOCKS_APART))
    offsets = (np.arange(count) + 0.5) * width / count - 0.5 * width
    return [
        (x + offset, y, _BLOCK) if across_x else (x, y + offset, _BLOCK)
        for offset in offsets.tolist()
    ]


def _near_station(home: Home) -> Mask:
    return cells_within(home.frame, _FROM_STATION, home.station.x, home.station.y)


def _is_inside(frame: GridFrame, piece: Furniture) -> bool:
    reaches = [math.hypot(box.length, box.width) / 2.0 for box in piece.boxes]
    return all(
        frame.contains(box.x + sign * reach, box.y + sign * reach)
        for box, reach in zip(piece.boxes, reaches, strict=True)
        for sign in (-1.0, 1.0)
    )


def _grown(mask: Mask) -> Mask:
    """Return a mask grown by one cell to all sides, since maps blur furniture a bit."""
    padded = np.pad(mask, 1)
    rows, columns = mask.shape
    grown = np.zeros_like(mask)
    for down in range(3):
        for right in range(3):
            grown |= padded[down : down + rows, right : right + columns]
    return grown
