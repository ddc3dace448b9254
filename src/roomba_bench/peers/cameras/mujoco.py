"""mujoco's own renderer: flat colours, one light; shadows and reflections off."""

from __future__ import annotations

import math

import mujoco
import numpy as np

from roomba_bench.peers.cameras.views import FAR, NEAR, Film, Floats, metres, work_of
from roomba_bench.peers.protocol import Parameters, Work

DISTRIBUTION = "mujoco"

_MOST_SHAPES = 4000


def prepare(parameters: Parameters) -> Work:
    """Make the context, and put the home into it."""
    film = Film.of(parameters)
    model = mujoco.MjModel.from_xml_string(_xml(film))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    window = mujoco.GLContext(film.width, film.height)
    window.make_current()
    context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
    mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
    scene = mujoco.MjvScene(model, maxgeom=_MOST_SHAPES)
    for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
        scene.flags[flag] = 0
    option, camera = mujoco.MjvOption(), mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
    camera.fixedcamid = 0
    viewport = mujoco.MjrRect(0, 0, film.width, film.height)
    colours = np.empty((film.height, film.width, 3), np.uint8)
    depths = np.empty((film.height, film.width), np.float32)

    def draw(view: Floats) -> None:
        window.make_current()  # also keeps it: without a context every call below does nothing
        x, y, height, heading = view.tolist()
        data.mocap_pos[0] = (x, y, height)
        data.mocap_quat[0] = (math.cos(heading / 2.0), 0.0, 0.0, math.sin(heading / 2.0))
        mujoco.mj_kinematics(model, data)
        mujoco.mj_camlight(model, data)
        mujoco.mjv_updateScene(
            model, data, option, None, camera, mujoco.mjtCatBit.mjCAT_ALL.value, scene
        )
        mujoco.mjr_render(viewport, scene, context)
        mujoco.mjr_readPixels(colours, depths, viewport, context)

    # Newer versions keep the depth reversed, for precision.
    def depth() -> Floats:
        return metres(1.0 - depths if np.median(depths) < 0.5 else depths)

    return work_of(film, draw, depth)


def _xml(film: Film) -> str:
    boxes = "".join(
        f'<geom type="box" pos="{x} {y} {(bottom + top) / 2}" euler="0 0 {theta}" '
        f'size="{half_length} {half_width} {(top - bottom) / 2}" rgba="{red} {green} {blue} 1"/>'
        for x, y, theta, half_length, half_width, bottom, top, red, green, blue in film.boxes
    )
    return f"""
    <mujoco>
      <compiler angle="radian"/>
      <statistic extent="1"/>
      <visual>
        <global offwidth="{film.width}" offheight="{film.height}"/>
        <map znear="{NEAR}" zfar="{FAR}"/>
        <headlight ambient=".5 .5 .5"/>
      </visual>
      <worldbody>
        {boxes}
        <body mocap="true">
          <camera fovy="{math.degrees(film.vertical_field)}" xyaxes="0 -1 0 0 0 1"/>
        </body>
      </worldbody>
    </mujoco>
    """
