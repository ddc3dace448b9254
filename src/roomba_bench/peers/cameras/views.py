"""Code that the drawing peers share: a home of boxes, the cameras' poses, and the checks.

Boxes are float64 [n, 10]: middle x, y, turn about the vertical, half length, half width, bottom,
top (m, rad), red, green, blue (0..1); views float64 [n, 4]: x, y, height and heading of a level
lens.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from roomba_bench.peers.protocol import Parameters, Work

NEAR, FAR = 0.02, 50.0
"""m; what is drawn."""
_CHECKED_VIEWS = 4

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Film:
    """The case."""

    boxes: Floats
    views: Floats
    width: int
    height: int
    horizontal_field: float

    @classmethod
    def of(cls, parameters: Parameters) -> Film:
        """Read the case; ``horizontal_field`` is in degrees."""
        return cls(
            np.load(parameters["boxes"]),
            np.load(parameters["views"]),
            parameters["width"],
            parameters["height"],
            math.radians(parameters["horizontal_field"]),
        )

    @property
    def vertical_field(self) -> float:
        """Angle from the lowest to the highest row, rad."""
        half = math.tan(self.horizontal_field / 2.0) * self.height / self.width
        return 2.0 * math.atan(half)

    @property
    def projection(self) -> Floats:
        """OpenGL's projection matrix, float64 [4, 4]."""
        focal = 1.0 / math.tan(self.vertical_field / 2.0)
        depth = NEAR - FAR
        return np.array(
            [
                [focal * self.height / self.width, 0.0, 0.0, 0.0],
                [0.0, focal, 0.0, 0.0],
                [0.0, 0.0, (FAR + NEAR) / depth, 2.0 * FAR * NEAR / depth],
                [0.0, 0.0, -1.0, 0.0],
            ]
        )


def work_of(film: Film, draw: Callable[[Floats], None], depth: Callable[[], Floats]) -> Work:
    """Return the work of drawing colour and depth of one view after the other.

    ``draw`` does a view and fetches both pictures; ``depth`` returns the last one's, in m along
    the optical axis, and is only for checking.
    """
    forever = itertools.cycle(film.views)

    def frame() -> float:
        draw(next(forever))
        return 1.0

    medians = []
    for view in film.views[:_CHECKED_VIEWS]:
        draw(view)
        medians.append(float(np.median(depth())))
    return Work(frame, {"median depth": float(np.mean(medians))})


def pose_matrix(view: Floats) -> Floats:
    """Return the camera's pose, float64 [4, 4], in OpenGL's axes: x right, y up, z back."""
    x, y, height, heading = view.tolist()
    cosine, sine = math.cos(heading), math.sin(heading)
    return np.array(
        [
            [sine, 0.0, -cosine, x],
            [-cosine, 0.0, -sine, y],
            [0.0, 1.0, 0.0, height],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def metres(depth: NDArray[np.floating[Any]]) -> Floats:
    """Return distances along the optical axis of what OpenGL's depth buffer holds (0..1)."""
    return NEAR * FAR / (FAR - depth.astype(np.float64) * (FAR - NEAR))


_FACES = (
    ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    ((-1, 0, 0), (0, 0, 1), (0, 1, 0)),
    ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
    ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
)
"""Outward direction of each face of a cube, and two edges that turn counter-clockwise around it."""
_TRIANGLES = ((-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1))


def triangles(boxes: Floats) -> Floats:
    """Return the boxes' corners, three to a triangle: float64 [36 n, 9].

    Columns: place x, y, z, direction of the face x, y, z, and red, green, blue.
    """
    rows = []
    for x, y, theta, half_length, half_width, bottom, top, *colour in boxes.tolist():
        cosine, sine = math.cos(theta), math.sin(theta)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        half = np.array([half_length, half_width, 0.5 * (top - bottom)])
        middle = np.array([x, y, 0.5 * (top + bottom)])
        for out, along, across in np.array(_FACES, np.float64):
            for a, b in _TRIANGLES:
                place = middle + turn @ (half * (out + a * along + b * across))
                rows.append([*place, *(turn @ out), *colour])
    return np.array(rows)
