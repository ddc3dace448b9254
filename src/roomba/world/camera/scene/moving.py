"""What moves before the camera: boxes of a scene that are put elsewhere between two pictures."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.errors import PictureError
from roomba.world.engine.state.arrays import MOST_DISCS
from roomba.world.home.home import Box, MovingThing

DISC_MATERIAL = "station"
X, Y, COSINE, SINE, HALF_LENGTH, HALF_WIDTH, BOTTOM, TOP = range(8)
"""Columns of the shapes of boxes: see :class:`roomba.world.camera.scene.arrays.Boxes`."""


def box_shapes(boxes: Iterable[Box]) -> NDArray[np.float32]:
    """Return the shapes of boxes, float32 [boxes, 8]."""
    rows = [
        (
            box.x,
            box.y,
            math.cos(box.theta),
            math.sin(box.theta),
            0.5 * box.length,
            0.5 * box.width,
            box.bottom,
            box.top,
        )
        for box in boxes
    ]
    return np.array(rows, np.float32).reshape(-1, 8)


@dataclass(frozen=True, slots=True, eq=False)
class MovingBoxes:
    """The boxes of everything that moves, which come after ``first`` others in a scene.

    ``own`` [boxes, 8] are their shapes in their thing's own frame, ``thing`` [boxes] is which
    thing, of ``things``, each belongs to. After them there is room for ``MOST_DISCS`` discs.
    """

    first: int
    own: NDArray[np.float64]
    thing: NDArray[np.intp]
    things: int

    @staticmethod
    def of(things: tuple[MovingThing, ...], first: int) -> MovingBoxes:
        """Return the boxes of these things."""
        own = box_shapes(box for thing in things for box in thing.boxes).astype(np.float64)
        counts = [len(thing.boxes) for thing in things]
        return MovingBoxes(first, own, np.repeat(np.arange(len(things)), counts), len(things))

    def place_things(self, shapes: NDArray[np.float32], poses: NDArray[np.float64]) -> None:
        """Write the shapes of all things at these poses; see :meth:`Camera.place_things`."""
        if poses.shape != (self.things, 4) or not np.isfinite(poses).all():
            raise PictureError(
                f"expected finite poses of the {self.things} things that move, with x, y, theta "
                f"and presence, got {_told(poses)}"
            )
        x, y, theta, present = poses[self.thing].T
        cosine, sine = np.cos(theta), np.sin(theta)
        own = self.own.T
        placed = shapes[self.first : self.first + len(self.own)].T
        placed[X] = x + own[X] * cosine - own[Y] * sine
        placed[Y] = y + own[X] * sine + own[Y] * cosine
        placed[COSINE] = own[COSINE] * cosine - own[SINE] * sine
        placed[SINE] = own[SINE] * cosine + own[COSINE] * sine
        placed[HALF_LENGTH] = np.where(present > 0.5, own[HALF_LENGTH], 0.0)

    def place_discs(self, shapes: NDArray[np.float32], discs: NDArray[np.float64]) -> None:
        """Write the shapes of these discs; see :meth:`Camera.place_discs`."""
        if discs.shape[1:] != (4,) or len(discs) > MOST_DISCS or not np.isfinite(discs).all():
            raise PictureError(
                f"expected finite numbers for up to {MOST_DISCS} discs, with x, y, radius and "
                f"height, got {_told(discs)}"
            )
        placed = shapes[self.first + len(self.own) :].T
        count = len(discs)
        placed[HALF_LENGTH] = 0.0
        placed[[X, Y, HALF_LENGTH, TOP], :count] = discs.T


def no_discs() -> NDArray[np.float32]:
    """Return the shapes of discs that are not there: cylinders without a size."""
    shapes = np.zeros((MOST_DISCS, 8), np.float32)
    shapes[:, COSINE] = 1.0
    return shapes


def _told(rows: NDArray[np.float64]) -> str:
    return f"an array of shape {rows.shape}" + (
        "" if np.isfinite(rows).all() else " with numbers that are not finite"
    )
