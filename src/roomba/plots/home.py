"""Draws a home as a plan picture: rooms, furniture, station, and what a robot did there."""

from __future__ import annotations

import math
from collections.abc import Sequence

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.plots.canvas import FINENESS, WHITE, Canvas, Colour, Picture, circle
from roomba.plots.floor import draw_carpets, draw_dirt, draw_floor
from roomba.plots.furniture import draw_furniture, draw_shadows, pieces_at_first
from roomba.plots.walls import LIGHT, draw_openings, draw_stairs, draw_station, draw_walls
from roomba.world.home.home import Home, Room
from roomba.world.home.raster import covered_cells, footprint, outline

PAPER: Colour = (250, 249, 246)
INK: Colour = (62, 60, 64)
FAINT: Colour = (126, 122, 122)
PATH: Colour = (36, 112, 226)
BODY: Colour = (44, 46, 52)

LONGEST_SIDE = 1600
"""px; of a picture whose scale is left open."""
FINEST = 130.0
"""px/m; finer is not asked for, however small the home."""
LABEL_ROOM = 0.55
"""m; height of bare floor that is enough for a name."""
BODY_RADIUS = 0.174
"""m; of the robot's disc as drawn."""
SMALLEST_BODY = 7.0
"""px; and its least radius."""


def draw_floor_plan(
    home: Home,
    *,
    pixels_per_metre: float | None = None,
    path: Sequence[tuple[float, float]] | None = None,
    dirt: NDArray[np.float64] | NDArray[np.float32] | None = None,
    robot: Pose | None = None,
    labels: bool = True,
) -> Picture:
    """Return a home seen from above as RGB uint8 [height, width, 3], north (+y) up.

    ``path`` is a line of points in the map frame, m, with the start as a ring. ``dirt`` is g/m² on
    the home's grid, [rows, columns]. ``robot`` is drawn where it is given; else at the path's end,
    or docked. ``pixels_per_metre`` is chosen for a side of 1600 px if left open. Raises ValueError
    for a dirt grid of another shape, or a scale that is not positive.
    """
    if dirt is not None and dirt.shape != home.frame.shape:
        raise ValueError(f"expected dirt of shape {home.frame.shape}, got {dirt.shape}")
    area = _area_of(home)
    scale = _scale_for(area) if pixels_per_metre is None else pixels_per_metre
    if not (math.isfinite(scale) and scale > 0.0):
        raise ValueError(f"expected a positive number of pixels per metre, got {pixels_per_metre}")
    canvas = Canvas.over(area, scale, PAPER)
    draw_floor(canvas, home)
    draw_carpets(canvas, home)
    if dirt is not None:
        draw_dirt(canvas, home.frame, dirt)
    draw_stairs(canvas, home)
    draw_shadows(canvas, home)
    draw_furniture(canvas, home)
    draw_walls(canvas, home)
    draw_openings(canvas, home)
    draw_station(canvas, home)
    if path is not None and len(path) > 1:
        _draw_path(canvas, path)
    _draw_robot(canvas, robot or _robot_after(path) or home.station)
    if labels:
        for room in home.rooms:
            _draw_name(canvas, home, room, path or ())
        _draw_scale_bar(canvas)
    return canvas.finished()


def _area_of(home: Home) -> tuple[float, float, float, float]:
    """Return what is known of the map with a margin, and a strip below for the scale bar, m."""
    rows, columns = np.nonzero(home.map.values >= 0)
    frame = home.frame
    if rows.size == 0:
        x_min, x_max, y_min, y_max = frame.extent
    else:
        x_min = frame.origin_x + int(columns.min()) * frame.resolution
        x_max = frame.origin_x + (int(columns.max()) + 1) * frame.resolution
        y_min = frame.origin_y + int(rows.min()) * frame.resolution
        y_max = frame.origin_y + (int(rows.max()) + 1) * frame.resolution
    margin = 0.03 * max(x_max - x_min, y_max - y_min)
    return x_min - margin, y_min - 2.0 * margin, x_max + margin, y_max + margin


def _scale_for(area: tuple[float, float, float, float]) -> float:
    longest = max(area[2] - area[0], area[3] - area[1])
    return min(FINEST, LONGEST_SIDE / longest)


def _draw_path(canvas: Canvas, path: Sequence[tuple[float, float]]) -> None:
    canvas.line(path, WHITE, 0.075)
    canvas.line(path, PATH, 0.04)
    x, y = path[0]
    canvas.disc(x, y, 0.09, WHITE)
    canvas.line(circle(x, y, 0.075), PATH, 0.035, closed=True)


def _robot_after(path: Sequence[tuple[float, float]] | None) -> Pose | None:
    """Return the pose at the end of a path, heading along its last piece."""
    if not path:
        return None
    x, y = path[-1]
    for before_x, before_y in reversed(path[:-1]):
        if math.hypot(x - before_x, y - before_y) > 1e-6:
            return Pose(x, y, math.atan2(y - before_y, x - before_x))
    return Pose(x, y, 0.0)


def _draw_robot(canvas: Canvas, pose: Pose) -> None:
    """A dark disc with a bright rim, its bumper ahead, its button in the middle."""
    # In a large hall its true size would be a speck.
    radius = max(BODY_RADIUS, SMALLEST_BODY * FINENESS / canvas.scale)
    canvas.disc(pose.x, pose.y, radius, BODY)
    canvas.line(circle(pose.x, pose.y, 0.93 * radius), (112, 116, 124), 0.09 * radius, closed=True)
    left, right = pose.theta + math.pi / 3.0, pose.theta - math.pi / 3.0
    canvas.line(circle(pose.x, pose.y, 0.77 * radius, right, left), LIGHT, 0.13 * radius)
    canvas.disc(pose.x, pose.y, 0.26 * radius, (208, 212, 218))


def _draw_name(canvas: Canvas, home: Home, room: Room, path: Sequence[tuple[float, float]]) -> None:
    """Write the room's name and floor space where there is most room for a line of words."""
    polygon = shapely.Polygon(room.outline)
    x, y = _roomiest_place(home, polygon, path)
    height = max(0.15, 15.0 * 2.0 / canvas.scale)
    canvas.text(room.name.capitalize(), x, y + 0.55 * height, height, INK)
    space = np.count_nonzero(covered_cells(home.frame, [polygon]) & ~home.walls)
    square_metres = space * home.frame.resolution**2
    digits = 1 if square_metres < 1000.0 else 0
    words = f"{square_metres:.{digits}f} m"
    canvas.text(words, x, y - 0.85 * height, 0.68 * height, FAINT, raised="2")


def _roomiest_place(
    home: Home, polygon: shapely.Polygon, path: Sequence[tuple[float, float]]
) -> tuple[float, float]:
    """Return the middle of the widest place without furniture, best without path and carpets."""
    frame = home.frame
    taken = covered_cells(
        frame, (footprint(box) for piece in pieces_at_first(home) for box in piece.boxes)
    )
    floor = covered_cells(frame, [polygon]) & ~taken & ~home.solid & ~home.drop
    bare = floor & ~covered_cells(frame, (outline(carpet.area) for carpet in home.carpets))
    walked = covered_cells(frame, [shapely.LineString(path).buffer(0.1)] if len(path) > 1 else [])
    for open_floor in (bare & ~walked, floor & ~walked, floor, covered_cells(frame, [polygon])):
        room, x, y = _widest(home, open_floor)
        if room >= LABEL_ROOM:
            break
    return x, y


def _widest(home: Home, cells: NDArray[np.bool_]) -> tuple[float, float, float]:
    """Return how much height there is for a line of words, m, and where: (height, x, y).

    A line is about three times as wide as high, its two rows included, so breadth counts a third.
    """
    frame = home.frame
    narrow = cv2.resize(
        cells.astype(np.uint8),
        (max(1, frame.columns // 3), frame.rows),
        interpolation=cv2.INTER_NEAREST,
    )
    distance = cv2.distanceTransform(np.pad(narrow, 1), cv2.DIST_L2, 5)[1:-1, 1:-1]
    # The widest place is often a long one: of equal cells the middle one looks best.
    best = np.argwhere(distance >= 0.97 * distance.max())
    row, column = best[np.argmin(np.linalg.norm(best - best.mean(axis=0), axis=1))]
    x, y = frame.centre_of(int(row), int((column + 0.5) * frame.columns / narrow.shape[1]))
    return float(2.0 * distance.max() * frame.resolution), x, y


def _draw_scale_bar(canvas: Canvas) -> None:
    """Draw a length that reads well: 1, 2, 5, 10, 20 or 50 m."""
    wide = canvas.x_max - canvas.x_min
    length = max((n for n in (1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if n <= wide / 6.0), default=1.0)
    margin = 0.028 * wide
    x, y = canvas.x_min + margin, canvas.y_min + 0.55 * margin
    tick = 0.005 * wide
    canvas.line([(x, y + tick), (x, y), (x + length, y), (x + length, y + tick)], FAINT, 0.0)
    height = max(0.11, 12.0 * 2.0 / canvas.scale)
    canvas.text(f"{length:g} m", x + length + 2.2 * height, y + height / 2.0, height, FAINT)
