"""The robot's camera: the home as seen from a low lens that looks level and turns left and right.

Pictures are RGB; depth is the distance along the optical axis, m, as in REP-118. The lens has no
distortion: a pixel (column, row) looks along ``(width / 2 - column - 0.5) / focal`` to the left and
``(height / 2 - row - 0.5) / focal`` up, per metre ahead.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.config import CameraConfig
from roomba.errors import PictureError
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.world.camera_film_kernels import develop, turn
from roomba.world.camera_kernels import render
from roomba.world.scene import Scene
from roomba.world.scene_arrays import ViewTables

__all__ = ["Camera", "Picture", "Scene"]

SUPERSAMPLING = 2
"""Samples per pixel in each direction, unless asked otherwise."""
KNOT_SPACING = 0.05
"""m; the floor's light and dirt are felt at least so finely near the camera."""
KNOT_ROWS = 16
"""Rows of samples; and not more of them apart than this."""
MOST_TAPS = 5
FINEST_CRUMB = 0.0012
"""m; a sample larger than this begins to miss single crumbs."""


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """``colour`` uint8 [height, width, 3] RGB, and ``depth`` float32 [height, width] in metres."""

    colour: NDArray[np.uint8]
    depth: NDArray[np.float32]


class Camera:
    """Takes pictures of a scene. Not for two threads at once: the buffers are its own."""

    def __init__(
        self, scene: Scene, config: CameraConfig, supersampling: int = SUPERSAMPLING
    ) -> None:
        """Make a camera; ``supersampling`` 1 is fast, 2 smooth. Raises PictureError for others."""
        if supersampling not in (1, 2):
            raise PictureError(f"expected a supersampling of 1 or 2, got {supersampling}")
        self.config = config
        self._scene = scene.arrays
        self._factor = supersampling
        self._view = _view(config, supersampling)
        self._exact = self._view if supersampling == 1 else _view(config, 1)
        self._colours = np.zeros((config.width, config.height), np.uint32)
        self._depths = np.zeros((config.width, config.height), np.float32)
        # A smooth picture's samples are many: only the columns that are being painted are kept.
        self._pair = np.zeros((2, self._view.rows), np.uint32)
        self._column_depths = np.zeros((1, self._view.rows), np.float32)
        self._hits = np.zeros((self._view.columns, 3), np.float64)
        self._seen = np.zeros((max(1, len(scene.arrays.boxes.shapes)), 4), np.float64)
        self._knots = np.zeros((len(self._view.knots), 3), np.float32)
        self._tone = _tone()

    @property
    def focal(self) -> float:
        """Focal length, pixels: the same in both directions."""
        return self._exact.focal

    def picture(
        self, pose: Pose, pan: float, dirt: NDArray[np.int32], dirt_frame: GridFrame
    ) -> NDArray[np.uint8]:
        """Return what the robot sees: uint8 [height, width, 3], RGB.

        ``pose`` is the body's in the map frame, ``pan`` the camera's turn to the left, rad.
        ``dirt`` is micrograms per cell of ``dirt_frame``. Raises PictureError if a number is
        not finite or the dirt does not fit its frame.
        """
        self._render(self._view, pose, pan, dirt, dirt_frame)
        return self._developed()

    def depth(self, pose: Pose, pan: float) -> NDArray[np.float32]:
        """Return the distance along the optical axis, float32 [height, width], m.

        Exact in the middle of each pixel. Arguments and errors as for :meth:`picture`.
        """
        self._render(self._exact, pose, pan, _NO_DIRT, _NO_DIRT_FRAME)
        return self._turned()

    def render(
        self, pose: Pose, pan: float, dirt: NDArray[np.int32], dirt_frame: GridFrame
    ) -> Picture:
        """Return colour and depth; arguments and errors as for :meth:`picture`."""
        colour = self.picture(pose, pan, dirt, dirt_frame)
        if self._factor == 1:
            return Picture(colour, self._turned())
        return Picture(colour, self.depth(pose, pan))

    def _render(
        self,
        view: ViewTables,
        pose: Pose,
        pan: float,
        dirt: NDArray[np.int32],
        dirt_frame: GridFrame,
    ) -> None:
        if not all(math.isfinite(value) for value in (pose.x, pose.y, pose.theta, pan)):
            raise PictureError(
                f"expected finite numbers for the camera's place, got x={pose.x} y={pose.y} "
                f"theta={pose.theta} pan={pan}"
            )
        if dirt.shape != dirt_frame.shape:
            raise PictureError(
                f"expected dirt of the frame's shape {dirt_frame.shape}, got {dirt.shape}"
            )
        lens = pose.compose(Pose(self.config.mount_forward, 0.0, pan))
        render(
            self._scene,
            view,
            lens.x,
            lens.y,
            math.cos(lens.theta),
            math.sin(lens.theta),
            np.ascontiguousarray(dirt, np.int32),
            np.array([dirt_frame.resolution, dirt_frame.origin_x, dirt_frame.origin_y]),
            self._colours,
            self._depths if view is self._exact else self._column_depths,
            self._pair,
            self._hits,
            self._seen,
            self._knots,
        )

    def _developed(self) -> NDArray[np.uint8]:
        picture = np.empty((self.config.height, self.config.width, 3), np.uint8)
        develop(self._colours, self._tone, picture)
        return picture

    def _turned(self) -> NDArray[np.float32]:
        picture = np.empty((self.config.height, self.config.width), np.float32)
        turn(self._depths, picture)
        return picture


_NO_DIRT = np.zeros((1, 1), np.int32)
_NO_DIRT_FRAME = GridFrame(1.0, 0.0, 0.0, 1, 1)


def _view(config: CameraConfig, factor: int) -> ViewTables:
    columns, rows = config.width * factor, config.height * factor
    focal = 0.5 * columns / math.tan(math.radians(config.horizontal_field) / 2.0)
    below = np.abs(np.arange(rows) + 0.5 - 0.5 * rows)
    # An odd number of rows has one that looks exactly level: it meets no floor.
    reach = focal / np.maximum(below, 1e-3)
    distance = config.mount_height * reach
    across = distance / focal
    along = distance**2 / (config.mount_height * focal)
    smooth = factor > 1
    taps = np.ones(rows, np.int32)
    if smooth:
        taps = np.clip(np.ceil(along / across), 1, MOST_TAPS).astype(np.int32)
    footprint = np.maximum(across, np.sqrt(across * along / taps))
    crispness = np.clip(FINEST_CRUMB / footprint * 1.4, 0.0, 1.0)
    crispness[crispness < 0.05] = 0.0
    return ViewTables(
        columns=columns,
        rows=rows,
        focal=focal,
        eye=config.mount_height,
        smooth=smooth,
        reach=reach.astype(np.float32),
        knots=_knots(distance, rows, factor),
        octave=np.log2(footprint).astype(np.float32),
        taps=taps,
        crispness=crispness.astype(np.float32),
    )


def _knots(distance: NDArray[np.float64], rows: int, step: int) -> NDArray[np.int32]:
    """Return rows of the floor, top to bottom, between which light and dirt hardly bend.

    They lie ``step`` rows apart or a multiple of that.
    """
    knots = [(rows + 1) // 2]
    while knots[-1] < rows:
        row = knots[-1]
        until = min(row + step, rows)
        while (
            until < rows
            and until - row < KNOT_ROWS
            and distance[row] - distance[until] < KNOT_SPACING
        ):
            until = min(until + step, rows)
        knots.append(until)
    return np.array(knots, np.int32)


def _tone() -> NDArray[np.uint8]:
    """Return a gentle film curve: brighter middles, more contrast at the ends."""
    light = np.arange(256) / 255.0
    lifted = light**0.76
    curve = lifted + 0.10 * lifted * (1.0 - lifted) * (2.0 * lifted - 1.0) * 2.0
    return np.asarray(np.clip(curve * 255.0 + 0.5, 0.0, 255.0), np.uint8)
