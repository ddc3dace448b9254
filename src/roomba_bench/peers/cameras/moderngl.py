"""moderngl: OpenGL without a window; flat colours, one light, no textures."""

from __future__ import annotations

import moderngl
import numpy as np

from roomba_bench.peers.cameras.views import Film, Floats, metres, pose_matrix, triangles, work_of
from roomba_bench.peers.protocol import Parameters, Work

DISTRIBUTION = "moderngl"

_VERTEX = """
#version 330
uniform mat4 view;
in vec3 place;
in vec3 direction;
in vec3 colour;
out vec3 shade;
void main() {
    gl_Position = view * vec4(place, 1.0);
    shade = colour * (0.7 + 0.3 * dot(direction, vec3(0.48, 0.36, 0.8)));
}
"""
_FRAGMENT = """
#version 330
in vec3 shade;
out vec3 pixel;
void main() { pixel = shade; }
"""


def prepare(parameters: Parameters) -> Work:
    """Make the context, and put the home into it."""
    film = Film.of(parameters)
    context = moderngl.create_context(standalone=True, backend="egl")
    context.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
    program = context.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT)
    corners = context.buffer(triangles(film.boxes).astype("f4").tobytes())
    home = context.simple_vertex_array(program, corners, "place", "direction", "colour")
    size = (film.width, film.height)
    frame = context.framebuffer(
        [context.renderbuffer(size, components=3)], context.depth_renderbuffer(size)
    )
    frame.use()
    colours = np.empty((film.height, film.width, 3), np.uint8)
    depths = np.empty((film.height, film.width), np.float32)

    def draw(view: Floats) -> None:
        matrix = film.projection @ np.linalg.inv(pose_matrix(view))
        program["view"].write(matrix.T.astype("f4").tobytes())
        frame.clear(0.5, 0.5, 0.5)
        home.render()
        frame.read_into(colours, components=3, alignment=1)
        frame.read_into(depths, attachment=-1, components=1, dtype="f4", alignment=1)

    return work_of(film, draw, lambda: metres(depths))
