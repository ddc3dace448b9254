"""The robot's camera: the home as seen from a low lens that looks level and turns left and right.

Pictures are RGB; depth is the distance along the optical axis, m, as in REP-118. The lens has no
distortion: a pixel (column, row) looks along ``(width / 2 - column - 0.5) / focal`` to the left and
``(height / 2 - row - 0.5) / focal`` up, per metre ahead.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.sensors import CameraConfig
from roomba.errors import PictureError
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.world.camera.kernels.film import develop
from roomba.world.camera.kernels.quick import render_quick
from roomba.world.camera.kernels.smooth import render_smooth
from roomba.world.camera.scene.arrays import FloorDirt, Ray, SceneArrays, ViewTables, Workspace
from roomba.world.camera.scene.scene import Scene
from roomba.world.camera.scene.texture_atlas import tone
from roomba.world.camera.view import view_tables, workspace

__all__ = ["Camera", "Picture", "Scene"]

SUPERSAMPLING = 2
"""Samples per pixel in each direction, unless asked otherwise."""


_DISC_HEIGHT = 0.25
"""m; height of round things that were put down."""


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
        self._scene = scene
        self._boxes = scene.boxes()
        self._quick = _Quick(config, len(self._boxes.shapes))
        self._smooth = _Smooth(config, len(self._boxes.shapes)) if supersampling == 2 else None

    @property
    def focal(self) -> float:
        """Focal length, pixels: the same in both directions."""
        return self._quick.view.focal

    def place_things(self, poses: NDArray[np.float64]) -> None:
        """Put what moves where it is now, for the pictures to come.

        ``poses`` is float64 [things, 4] in the order of the home's ``moving``: x, y, m, and theta,
        rad, in the map frame; and 1, or 0 for what is not there. Raises PictureError for another
        shape, or if a number is not finite.
        """
        self._scene.moving.place_things(self._boxes.shapes, self._own(poses, turns=True))

    def place_discs(self, discs: NDArray[np.float64]) -> None:
        """Show these round bodies, such as other robots, in the pictures to come.

        ``discs`` is float64 [up to MOST_DISCS, 4]: x, y in the map frame, radius, height; m.
        Upright cylinders from the floor up; the robot that carries the camera must not be one of
        them. Raises PictureError for another shape, or if a number is not finite.
        """
        self._scene.moving.place_discs(self._boxes.shapes, self._own(discs, turns=False))

    def place_all(self, things: NDArray[np.float64], round_things: NDArray[np.float64]) -> None:
        """Show what moves and what was put down as they are now, in the pictures to come.

        ``things`` are as for :meth:`place_things`; ``round_things`` is float64 [n, 3]: x, y in the
        map frame and radius, m. Raises PictureError as those two.
        """
        self.place_things(things)
        height = np.full((len(round_things), 1), _DISC_HEIGHT)
        self.place_discs(np.hstack([round_things, height]))

    def picture(
        self, pose: Pose, pan: float, dirt: NDArray[np.int32], dirt_frame: GridFrame
    ) -> NDArray[np.uint8]:
        """Return what the robot sees: uint8 [height, width, 3], RGB.

        ``pose`` is the body's in the map frame, ``pan`` the camera's turn to the left, rad.
        ``dirt`` is micrograms per cell of ``dirt_frame``, in the home's own axes. Raises
        PictureError if a number is not finite or the dirt does not fit its frame.
        """
        if self._smooth is not None:
            return self._smooth.taken(self._shot(pose, pan, dirt, dirt_frame))
        return self.render(pose, pan, dirt, dirt_frame).colour

    def depth(self, pose: Pose, pan: float) -> NDArray[np.float32]:
        """Return the distance along the optical axis, float32 [height, width], m.

        Exact in the middle of each pixel. Arguments and errors as for :meth:`picture`.
        """
        return self._quick.taken(self._shot(pose, pan, _NO_DIRT, _NO_DIRT_FRAME)).depth

    def render(
        self, pose: Pose, pan: float, dirt: NDArray[np.int32], dirt_frame: GridFrame
    ) -> Picture:
        """Return colour and depth; arguments and errors as for :meth:`picture`."""
        shot = self._shot(pose, pan, dirt, dirt_frame)
        picture = self._quick.taken(shot)
        if self._smooth is None:
            return picture
        return Picture(self._smooth.taken(shot), picture.depth)

    def _own(self, rows: NDArray[np.float64], turns: bool) -> NDArray[np.float64]:
        """Return rows x, y, ... in the axes of the scene; their third number may be an angle."""
        axes = self._scene.axes
        if axes is None or rows.ndim != 2 or rows.shape[1] < 3:
            return rows
        rows = axes.inverse().transform(rows)
        if turns:
            rows[:, 2] -= axes.theta
        return rows

    def _shot(
        self, pose: Pose, pan: float, dirt: NDArray[np.int32], dirt_frame: GridFrame
    ) -> _Shot:
        if not all(math.isfinite(value) for value in (pose.x, pose.y, pose.theta, pan)):
            raise PictureError(
                f"expected finite numbers for the camera's place, got x={pose.x} y={pose.y} "
                f"theta={pose.theta} pan={pan}"
            )
        if dirt.shape != dirt_frame.shape:
            raise PictureError(
                f"expected dirt of the frame's shape {dirt_frame.shape}, got {dirt.shape}"
            )
        if self._scene.axes is not None:
            pose = self._scene.axes.inverse().compose(pose)
        lens = pose.compose(Pose(self.config.mount_forward, 0.0, pan))
        place = np.array([dirt_frame.resolution, dirt_frame.origin_x, dirt_frame.origin_y])
        return _Shot(
            self._scene.arrays._replace(boxes=self._boxes),
            Ray(lens.x, lens.y, math.cos(lens.theta), math.sin(lens.theta)),
            FloorDirt(np.ascontiguousarray(dirt, np.int32), place),
        )


class _Shot(NamedTuple):
    """What to take a picture of, along which optical axis."""

    scene: SceneArrays
    axis: Ray
    dirt: FloorDirt


class _Quick:
    """Takes pictures of one sample per pixel."""

    def __init__(self, config: CameraConfig, boxes: int) -> None:
        self.view: ViewTables = view_tables(config, 1)
        self._config = config
        self._work: Workspace = workspace(self.view, boxes)

    def taken(self, shot: _Shot) -> Picture:
        scene, axis, dirt = shot
        height, width, columns = self._config.height, self._config.width, self.view.columns
        colour = np.empty((height, 3 * columns), np.uint8)
        depth = np.empty((height, columns), np.float32)
        render_quick(scene, self.view, axis, dirt, self._work, colour, depth)
        return Picture(
            np.ascontiguousarray(colour.reshape(height, columns, 3)[:, :width]),
            np.ascontiguousarray(depth[:, :width]),
        )


class _Smooth:
    """Takes pictures of four samples per pixel."""

    def __init__(self, config: CameraConfig, boxes: int) -> None:
        self._config = config
        self._view: ViewTables = view_tables(config, 2)
        self._work: Workspace = workspace(self._view, boxes)
        self._colours = np.zeros((self._view.columns // 2, config.height), np.uint32)
        self._tone = tone()

    def taken(self, shot: _Shot) -> NDArray[np.uint8]:
        scene, axis, dirt = shot
        render_smooth(scene, self._view, axis, dirt, self._work, self._colours)
        picture = np.empty((self._config.height, self._config.width, 3), np.uint8)
        develop(self._colours, self._tone, picture)
        return picture


_NO_DIRT = np.zeros((1, 1), np.int32)
_NO_DIRT_FRAME = GridFrame(1.0, 0.0, 0.0, 1, 1)
