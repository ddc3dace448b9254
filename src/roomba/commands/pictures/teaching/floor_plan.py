"""A photo of a floor plan on paper, for the tutorial that makes a home of one."""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.plots.canvas import Picture
from roomba.world.home.home import Home
from roomba.world.home.raster import footprint

_PIXELS: Final = 100.0
"""Pixels of the plan on paper per m of the home."""
_MARGIN: Final = 0.6
"""m of the home's scale, of paper around the outer walls."""
_SIZE: Final = (1000, 860)
"""Pixels of the photo: width, height."""
_CORNERS: Final = ((92, 70), (930, 118), (962, 800), (40, 770))
"""Pixels: where the corners of the paper are, from the upper left one clockwise."""
_WALL, _THIN = 40, 110
"""Grey of walls, and of what is drawn thin: furniture and names."""
_TABLE: Final = (96.0, 120.0, 150.0)
"""RGB of what the paper lies on, before there is light on it."""
_LIGHT, _SHADE = 1.0, 0.52
"""Light in the upper left corner, and in the lower right one."""
_BLUR: Final = 1.1
"""Pixels; of the camera."""


def picture_of_floor_plan(home: Home) -> Picture:
    """Return the plan of a home as a camera sees it aslant, uint8 [height, width, 3] RGB."""
    paper = _paper(home)
    height, width = paper.shape
    from_paper = np.array([(0, 0), (width, 0), (width, height), (0, height)], np.float32)
    aslant = cv2.getPerspectiveTransform(from_paper, np.array(_CORNERS, np.float32))
    seen = cv2.warpPerspective(paper, aslant, _SIZE, flags=cv2.INTER_AREA)
    is_paper = cv2.warpPerspective(np.ones_like(paper), aslant, _SIZE)[:, :, None] > 0
    photo = np.where(is_paper, seen[:, :, None].astype(np.float64), _TABLE)
    down, across = np.mgrid[0 : _SIZE[1], 0 : _SIZE[0]]
    away = (down / _SIZE[1] + across / _SIZE[0]) / 2.0
    light = _LIGHT + (_SHADE - _LIGHT) * away
    blurred = cv2.GaussianBlur(photo * light[:, :, None], (0, 0), _BLUR)
    picture: Picture = np.clip(blurred, 0.0, 255.0).astype(np.uint8)
    return picture


def _paper(home: Home) -> NDArray[np.uint8]:
    """Return the plan as it was printed, grey: walls filled, furniture and names in thin lines."""
    frame = home.frame
    left, low = frame.origin_x - _MARGIN, frame.origin_y - _MARGIN
    width = frame.columns * frame.resolution + 2.0 * _MARGIN
    height = frame.rows * frame.resolution + 2.0 * _MARGIN
    paper = np.full((round(height * _PIXELS), round(width * _PIXELS)), 245, np.uint8)

    def pixels(shape: shapely.Polygon) -> NDArray[np.int32]:
        corners = shapely.get_coordinates(shape.exterior)
        places = np.stack([corners[:, 0] - left, low + height - corners[:, 1]], axis=1)
        rounded: NDArray[np.int32] = np.rint(places * _PIXELS).astype(np.int32)
        return rounded

    for piece in home.furniture:
        for box in piece.boxes:
            cv2.polylines(paper, [pixels(footprint(box))], True, _THIN, 1, cv2.LINE_AA)
    for row, column in np.argwhere(home.walls):
        x, y = frame.centre_of(int(row), int(column))
        half = frame.resolution / 2.0
        cell = shapely.box(x - half, y - half, x + half, y + half)
        cv2.fillConvexPoly(paper, pixels(cell), _WALL)
    for room in home.rooms:
        middle = shapely.Polygon(room.outline).centroid
        at = pixels(shapely.box(middle.x - 0.6, middle.y, middle.x, middle.y + 0.1))[0]
        cv2.putText(paper, room.name, at.tolist(), cv2.FONT_HERSHEY_SIMPLEX, 0.7, _THIN, 1)
    return paper
