"""pyrender: OpenGL without a window; flat colours, no light."""

from __future__ import annotations

import numpy as np
import pyrender
import trimesh

from roomba_bench.peers.cameras.views import (
    FAR,
    NEAR,
    Film,
    Floats,
    pose_matrix,
    triangles,
    work_of,
)
from roomba_bench.peers.protocol import Parameters, Work

DISTRIBUTION = "pyrender"


def prepare(parameters: Parameters) -> Work:
    """Make the context, and put the home into it."""
    film = Film.of(parameters)
    corners = triangles(film.boxes)
    mesh = trimesh.Trimesh(
        corners[:, :3],
        np.arange(len(corners)).reshape(-1, 3),
        vertex_colors=(255 * corners[:, 6:]).astype(np.uint8),
        process=False,
    )
    scene = pyrender.Scene(ambient_light=[0.5, 0.5, 0.5])
    scene.add(pyrender.Mesh.from_trimesh(mesh, smooth=False))
    lens = pyrender.PerspectiveCamera(
        film.vertical_field, znear=NEAR, zfar=FAR, aspectRatio=film.width / film.height
    )
    camera = scene.add(lens)
    renderer = pyrender.OffscreenRenderer(film.width, film.height)
    depths = np.empty(0)

    def draw(view: Floats) -> None:
        nonlocal depths
        scene.set_pose(camera, pose_matrix(view))
        _, depths = renderer.render(scene, flags=pyrender.RenderFlags.FLAT)

    return work_of(film, draw, lambda: depths)
