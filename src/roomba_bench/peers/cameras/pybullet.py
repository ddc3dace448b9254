"""pybullet's TinyRenderer: a renderer on the processor; shadows and segmentation off."""

from __future__ import annotations

import math

import numpy as np
import pybullet

from roomba_bench.peers.cameras.views import Film, Floats, metres, pose_matrix, work_of
from roomba_bench.peers.protocol import Parameters, Work

DISTRIBUTION = "pybullet"


def prepare(parameters: Parameters) -> Work:
    """Build the home."""
    film = Film.of(parameters)
    pybullet.connect(pybullet.DIRECT)
    for x, y, theta, half_length, half_width, bottom, top, *colour in film.boxes.tolist():
        extents = [half_length, half_width, 0.5 * (top - bottom)]
        shape = pybullet.createVisualShape(
            pybullet.GEOM_BOX, halfExtents=extents, rgbaColor=[*colour, 1.0]
        )
        turn = [0.0, 0.0, math.sin(theta / 2.0), math.cos(theta / 2.0)]
        place = [x, y, 0.5 * (top + bottom)]
        pybullet.createMultiBody(0.0, -1, shape, basePosition=place, baseOrientation=turn)
    projection = film.projection.T.ravel().tolist()
    depths = np.empty(0)

    def draw(view: Floats) -> None:
        nonlocal depths
        picture = pybullet.getCameraImage(
            film.width,
            film.height,
            np.linalg.inv(pose_matrix(view)).T.ravel().tolist(),
            projection,
            shadow=0,
            renderer=pybullet.ER_TINY_RENDERER,
            flags=pybullet.ER_NO_SEGMENTATION_MASK,
        )
        depths = np.asarray(picture[3])

    return work_of(film, draw, lambda: metres(depths))
