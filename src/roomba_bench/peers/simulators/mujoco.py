"""mujoco: a cylinder on two slides and a hinge among static boxes; all rays in one call.

``mj_multiRay`` is what 360 rangefinder sensors come to, and a little faster.
"""

from __future__ import annotations

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from roomba_bench.peers.protocol import Parameters, Work
from roomba_bench.peers.simulators.arena import Arena, work_of

DISTRIBUTION = "mujoco"

_LIDAR_HEIGHT = 0.05


class MujocoEngine:
    """The arena in mujoco."""

    def __init__(self, arena: Arena) -> None:
        """Build it."""
        self._arena = arena
        self._model = mujoco.MjModel.from_xml_string(_xml(arena))
        self._data = mujoco.MjData(self._model)
        mujoco.mj_forward(self._model, self._data)  # rays need to know where the walls are
        self._body = self._model.body("robot").id
        self._geoms = np.zeros(arena.beams, np.int32)
        self._ranges = np.zeros(arena.beams)
        self._rays = np.zeros((arena.beams, 3))

    def place(self, x: float, y: float, theta: float) -> None:
        self._data.qpos[:] = (x, y, theta)

    def pose(self) -> tuple[float, float, float]:
        x, y, theta = self._data.qpos.tolist()
        return x, y, theta

    def step(self, linear: float, angular: float) -> bool:
        theta = float(self._data.qpos[2])
        self._data.qvel[:] = (linear * math.cos(theta), linear * math.sin(theta), angular)
        mujoco.mj_step(self._model, self._data)
        return int(self._data.ncon) > 0

    def scan(self) -> NDArray[np.float64]:
        arena = self._arena
        x, y, theta = self.pose()
        self._rays[:, :2] = (arena.beams_from(x, y, theta) - (x, y)) / arena.reach
        eye = np.array([x, y, _LIDAR_HEIGHT])
        mujoco.mj_multiRay(
            self._model,
            self._data,
            eye,
            self._rays.ravel(),
            None,
            1,
            self._body,
            self._geoms,
            self._ranges,
            None,
            arena.beams,
            arena.reach,
        )
        return np.where(self._ranges < 0.0, arena.reach, self._ranges)


def _xml(arena: Arena) -> str:
    walls = "".join(
        f'<geom type="box" pos="{x} {y} .5" size="{half_x} {half_y} .5"/>'
        for x, y, half_x, half_y in arena.boxes.tolist()
    )
    return f"""
    <mujoco>
      <option timestep="{arena.dt}" gravity="0 0 0"/>
      <worldbody>
        {walls}
        <body name="robot" pos="0 0 .05">
          <joint type="slide" axis="1 0 0"/>
          <joint type="slide" axis="0 1 0"/>
          <joint type="hinge" axis="0 0 1"/>
          <geom type="cylinder" size="{arena.radius} .04" mass="3" friction="0 0 0"/>
        </body>
      </worldbody>
    </mujoco>
    """


def prepare(parameters: Parameters) -> Work:
    """Build the arena."""
    arena = Arena.of(parameters)
    return work_of(MujocoEngine(arena), arena, parameters)
