"""A canvas in metres: shapes, lines and text on an RGB picture, drawn finer than it is shown.

Shapes are given in the map frame, m, x to the right and y up. What is drawn is twice as fine as the
finished picture, which gives smooth edges.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.geometry import Point

Colour = tuple[int, int, int]
Picture = NDArray[np.uint8]
Paint = Colour | Callable[[NDArray[np.float64], NDArray[np.float64]], Picture]

WHITE: Colour = (255, 255, 255)
FONT = cv2.FONT_HERSHEY_DUPLEX

FINENESS = 2
"""Drawn pixels per shown pixel, along each side."""
_SHIFT = 4
"""OpenCV's fixed point: 4 bits behind the point of a pixel."""


@dataclass(frozen=True, slots=True, eq=False)
class Canvas:
    """A picture over the area from (x_min, y_min) to (x_max, y_max), m; ``scale`` is drawn px/m."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float
    scale: float
    pixels: Picture

    @classmethod
    def over(
        cls, area: tuple[float, float, float, float], pixels_per_metre: float, paper: Colour
    ) -> Canvas:
        """Return an empty canvas over (x_min, y_min, x_max, y_max), m."""
        x_min, y_min, x_max, y_max = area
        width = max(1, round((x_max - x_min) * pixels_per_metre))
        height = max(1, round((y_max - y_min) * pixels_per_metre))
        pixels = np.empty((height * FINENESS, width * FINENESS, 3), np.uint8)
        pixels[:] = paper
        return cls(x_min, y_min, x_max, y_max, pixels_per_metre * FINENESS, pixels)

    def finished(self) -> Picture:
        """Return the picture, RGB uint8 [height, width, 3], at its shown size."""
        height, width = self.pixels.shape[:2]
        size = (width // FINENESS, height // FINENESS)
        return np.asarray(cv2.resize(self.pixels, size, interpolation=cv2.INTER_AREA), np.uint8)

    def metres(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the x of every column and the y of every row, m."""
        height, width = self.pixels.shape[:2]
        x = self.x_min + (np.arange(width) + 0.5) / self.scale
        y = self.y_max - (np.arange(height) + 0.5) / self.scale
        return x, y

    def mask(self) -> NDArray[np.uint8]:
        """Return an empty mask of the canvas' size."""
        return np.zeros(self.pixels.shape[:2], np.uint8)

    def fill(self, points: Sequence[Point], colour: Colour) -> None:
        """Fill a polygon."""
        cv2.fillPoly(self.pixels, [self._fixed(points)], colour, cv2.LINE_AA, _SHIFT)

    def fill_mask(self, mask: NDArray[np.uint8], points: Sequence[Point]) -> None:
        """Set a mask to 255 inside a polygon."""
        cv2.fillPoly(mask, [self._fixed(points)], (255,), cv2.LINE_8, _SHIFT)

    def line(
        self, points: Sequence[Point], colour: Colour, width: float, closed: bool = False
    ) -> None:
        """Draw a line of a width in m, at least a shown pixel wide."""
        thickness = max(FINENESS, round(width * self.scale))
        cv2.polylines(
            self.pixels, [self._fixed(points)], closed, colour, thickness, cv2.LINE_AA, _SHIFT
        )

    def disc(self, x: float, y: float, radius: float, colour: Colour) -> None:
        """Fill a circle."""
        self.fill(circle(x, y, radius), colour)

    def text(
        self, words: str, x: float, y: float, height: float, colour: Colour, raised: str = ""
    ) -> None:
        """Write words with their middle at a point, ``height`` m high, with a bright seam.

        ``raised`` follows, smaller and higher, as in m².
        """
        drawn = height * self.scale
        thickness = max(1, round(drawn / 14.0))
        (width, tall), _ = cv2.getTextSize(words, FONT, drawn / 22.0, thickness)
        column, row = self.pixel(x, y)
        left, base = round(column - width / 2.0), round(row + tall / 2.0)
        pieces = [(words, (left, base), drawn / 22.0, thickness)]
        if raised:
            place = (left + width, round(base - 0.45 * tall))
            pieces.append((raised, place, 0.62 * drawn / 22.0, max(1, thickness - 1)))
        mask = self.mask()
        for piece, place, size, thick in pieces:
            seam = thick + max(3, round(drawn / 4.5))
            cv2.putText(mask, piece, place, FONT, size, (150,), seam, cv2.LINE_AA)
        self.blend(WHITE, softened(mask, drawn / 20.0))
        for piece, place, size, thick in pieces:
            cv2.putText(self.pixels, piece, place, FONT, size, colour, thick, cv2.LINE_AA)

    def blend(self, over: Paint, mask: NDArray[np.uint8]) -> None:
        """Lay a colour over the picture, or what a function paints; ``mask`` 255 covers all of it.

        The function is given the x of the columns and the y of the rows that are needed, m.
        """
        window = _window_of(mask)
        if window is None:
            return
        part = self.pixels[window]
        if callable(over):
            x, y = self.metres()
            paint = over(x[window[1]], y[window[0]])
        else:
            paint = np.full_like(part, over)
        share = mask[window].astype(np.float32) * np.float32(1.0 / 255.0)
        self.pixels[window] = cv2.blendLinear(part, paint, 1.0 - share, share)

    def pixel(self, x: float, y: float) -> tuple[float, float]:
        """Return (column, row) of a point, in drawn pixels."""
        return (x - self.x_min) * self.scale, (self.y_max - y) * self.scale

    def _fixed(self, points: Sequence[Point]) -> NDArray[np.int32]:
        array = np.asarray(points, np.float64)
        column = (array[:, 0] - self.x_min) * self.scale - 0.5
        row = (self.y_max - array[:, 1]) * self.scale - 0.5
        fixed = np.rint(np.stack([column, row], axis=1) * (1 << _SHIFT))
        return np.asarray(fixed, np.int32)


def softened(mask: NDArray[np.uint8], sigma: float) -> NDArray[np.uint8]:
    """Return a mask with blurred edges, ``sigma`` in drawn pixels."""
    window = _window_of(mask)
    if window is None:
        return mask
    reach = math.ceil(3.0 * max(1.0, sigma))
    rows, columns = (slice(max(part.start - reach, 0), part.stop + reach) for part in window)
    soft = np.zeros_like(mask)
    soft[rows, columns] = cv2.GaussianBlur(mask[rows, columns], (0, 0), max(1.0, sigma))
    return soft


def _window_of(mask: NDArray[np.uint8]) -> tuple[slice, slice] | None:
    """Return the rows and columns that hold all of a mask; None if it is empty."""
    x, y, width, height = cv2.boundingRect(mask)
    if width == 0:
        return None
    return slice(y, y + height), slice(x, x + width)


def circle(
    x: float, y: float, radius: float, start: float = 0.0, end: float = 2.0 * np.pi
) -> Sequence[Point]:
    """Return points along a circle's arc from angle ``start`` to ``end``, rad."""
    angles = np.linspace(start, end, 49)
    return [(float(x + radius * np.cos(a)), float(y + radius * np.sin(a))) for a in angles]


def rounded(polygon: shapely.Polygon, radius: float) -> Sequence[Point]:
    """Return the outline of a convex polygon with round corners."""
    inner = shapely.buffer(polygon, -radius, join_style="mitre")
    if radius <= 0.0 or inner.is_empty:
        return list(polygon.exterior.coords)
    return list(shapely.buffer(inner, radius, quad_segs=6).exterior.coords)


def mixed(colour: Colour, other: Colour, share: float) -> Colour:
    """Return a colour with a share 0..1 of another in it."""
    red, green, blue = (
        round(a * (1.0 - share) + b * share) for a, b in zip(colour, other, strict=True)
    )
    return red, green, blue
