"""Walls on a plan, and what is set into them: doors with their swing, windows, the front door."""

from __future__ import annotations

import math

import numpy as np

from roomba.geometry import Pose
from roomba.plots.canvas import WHITE, Canvas, Colour, circle, mixed, rounded, softened
from roomba.plots.floor import upscaled
from roomba.plots.furniture import SHADOW
from roomba.world.catalogue.furniture import STATION_KIND
from roomba.world.home.home import Door, Furniture, Home, MovingKind, Rectangle
from roomba.world.home.raster import footprint
from roomba.world.home.surface import Finish

WALL: Colour = (66, 68, 76)
LEAF: Colour = (170, 120, 78)
GLASS: Colour = (150, 196, 216)
MIRROR: Colour = (176, 168, 214)
STATION: Colour = (52, 54, 60)
LIGHT: Colour = (72, 204, 128)
LEAF_THICKNESS = 0.045
"""m; of a door's leaf."""


def draw_walls(canvas: Canvas, home: Home) -> None:
    """Fill the walls, with a soft shadow at their feet; slanted ones as the home's map shows them.

    Those that stand free of the grid of a home that is not turned are drawn as they are.
    """
    exact = home.exact if home.axes.theta == 0.0 else home
    mask = upscaled(canvas, exact.frame, exact.walls)
    free = exact.free_walls.walls if exact.free_walls is not None else ()
    for wall in free:
        if wall.line:
            canvas.fill_mask(mask, list(wall.outline))
    soft = softened(mask, 0.06 * canvas.scale)
    canvas.blend(SHADOW, (soft * 0.30).astype(np.uint8))
    canvas.blend(WALL, mask)
    for wall in free:
        if wall.line and wall.surface is not None and wall.surface.is_clear:
            is_glass = wall.surface.finish is Finish.GLASS
            canvas.line(list(wall.line), GLASS if is_glass else MIRROR, 0.04)


def draw_openings(canvas: Canvas, home: Home) -> None:
    """Draw doors and windows."""
    for door in home.doors:
        _draw_door(canvas, home, door)
    for piece in home.furniture:
        if piece.kind == "window":
            _draw_window(canvas, piece)
        elif piece.kind == "front_door":
            _draw_front_door(canvas, piece)
        elif piece.kind == "picture":
            canvas.fill(list(footprint(piece.boxes[0]).exterior.coords), LEAF)


def draw_stairs(canvas: Canvas, home: Home) -> None:
    """Draw flights of stairs as treads."""
    for area in home.stairs:
        canvas.fill(_corners(area), mixed(LEAF, WHITE, 0.6))
        along_x = area.x_max - area.x_min >= area.y_max - area.y_min
        length = area.x_max - area.x_min if along_x else area.y_max - area.y_min
        for number in range(math.ceil(length / 0.27) + 1):
            at = min(number * 0.27, length)
            ends = (
                [(area.x_min + at, area.y_min), (area.x_min + at, area.y_max)]
                if along_x
                else [(area.x_min, area.y_min + at), (area.x_max, area.y_min + at)]
            )
            canvas.line(ends, WALL, 0.015)


def draw_station(canvas: Canvas, home: Home) -> None:
    """Draw the charging station with its light."""
    for piece in home.furniture:
        if piece.kind != STATION_KIND:
            continue
        canvas.fill(rounded(footprint(piece.boxes[0]), 0.02), STATION)
        canvas.disc(piece.pose.x, piece.pose.y, 0.028, LIGHT)


def _draw_door(canvas: Canvas, home: Home, door: Door) -> None:
    """Show the opening, and the leaf: open with its swing where there is most room, or shut."""
    area = door.opening
    canvas.fill(_corners(area), mixed((214, 200, 178), WHITE, 0.35))
    along_x = area.x_max - area.x_min >= area.y_max - area.y_min
    middle_x, middle_y = (area.x_min + area.x_max) / 2.0, (area.y_min + area.y_max) / 2.0
    if not door.is_open or _is_leaf_shut(home, door):
        half = LEAF_THICKNESS / 2.0
        leaf = (
            Rectangle(area.x_min, middle_y - half, area.x_max, middle_y + half)
            if along_x
            else Rectangle(middle_x - half, area.y_min, middle_x + half, area.y_max)
        )
        canvas.fill(_corners(leaf), LEAF)
        return
    swings = [
        (Pose(x, y, side + theta), -side)
        for x, y, theta in (
            ((area.x_min, middle_y, 0.0), (area.x_max, middle_y, math.pi))
            if along_x
            else ((middle_x, area.y_min, math.pi / 2.0), (middle_x, area.y_max, -math.pi / 2.0))
        )
        for side in (math.pi / 2.0, -math.pi / 2.0)
    ]
    width = max(area.x_max - area.x_min, area.y_max - area.y_min)
    hinge, turn = max(swings, key=lambda swing: _free_share(home, swing[0], swing[1], width))
    _draw_swing(canvas, hinge, turn, width)


def _is_leaf_shut(home: Home, door: Door) -> bool:
    """Whether a leaf that moves stands in the opening at first."""
    return any(
        thing.kind is MovingKind.DOOR and thing.name == door.name and thing.is_present
        for thing in home.moving
    )


def _free_share(home: Home, hinge: Pose, turn: float, width: float) -> float:
    """Return how much of a leaf's swing is floor without furniture, 0..1."""
    floor = ~home.solid & ~home.drop
    free = total = 0
    for radius in (0.3 * width, 0.6 * width, 0.95 * width):
        for number in range(10):
            angle = hinge.theta + turn * number / 10.0
            x, y = hinge.x + radius * math.cos(angle), hinge.y + radius * math.sin(angle)
            row, column = home.frame.cell_of(x, y)
            total += 1
            free += home.frame.contains(x, y) and bool(floor[row, column])
    return free / total


def _draw_swing(canvas: Canvas, hinge: Pose, turn: float, width: float) -> None:
    """Draw a leaf that stands open along the hinge's heading, and the arc to where it shuts."""
    arc = circle(hinge.x, hinge.y, width, hinge.theta, hinge.theta + turn)
    canvas.line(arc, mixed(LEAF, WHITE, 0.35), 0.012)
    end = hinge.compose(Pose(width, 0.0, 0.0))
    canvas.line([(hinge.x, hinge.y), (end.x, end.y)], LEAF, LEAF_THICKNESS)


def _draw_window(canvas: Canvas, piece: Furniture) -> None:
    """Panes and frame in the wall; the piece's own depth is the wall's."""
    glass = footprint(piece.boxes[0])
    canvas.fill(list(glass.exterior.coords), WHITE)
    canvas.line(list(glass.exterior.coords), WALL, 0.015, closed=True)
    box = piece.boxes[0]
    ends = [
        Pose(box.x, box.y, box.theta).compose(Pose(0.0, share * box.width)) for share in (-0.5, 0.5)
    ]
    canvas.line([(end.x, end.y) for end in ends], GLASS, 0.05)


def _draw_front_door(canvas: Canvas, piece: Furniture) -> None:
    """A threshold in the wall, the shut leaf on its inner face, and the swing into the home."""
    box = piece.boxes[0]
    canvas.fill(list(footprint(box).exterior.coords), mixed((214, 200, 178), WHITE, 0.35))
    inner = piece.pose.compose(Pose(box.length / 2.0 - LEAF_THICKNESS / 2.0, 0.0, 0.0))
    across = [inner.compose(Pose(0.0, share * box.width)) for share in (-0.5, 0.5)]
    canvas.line([(end.x, end.y) for end in across], LEAF, LEAF_THICKNESS)
    hinge = across[0]
    arc = circle(hinge.x, hinge.y, box.width, piece.pose.theta, piece.pose.theta + math.pi / 2.0)
    canvas.line(arc, mixed(LEAF, WHITE, 0.35), 0.012)


def _corners(area: Rectangle) -> list[tuple[float, float]]:
    return [
        (area.x_min, area.y_min),
        (area.x_max, area.y_min),
        (area.x_max, area.y_max),
        (area.x_min, area.y_max),
    ]
