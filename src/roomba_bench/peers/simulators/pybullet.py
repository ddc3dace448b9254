"""pybullet: a rigid cylinder among static boxes, one batch of rays per scan."""

from __future__ import annotations

import math

import numpy as np
import pybullet
from numpy.typing import NDArray

from roomba_bench.peers.protocol import Parameters, Work
from roomba_bench.peers.simulators.arena import Arena, work_of

DISTRIBUTION = "pybullet"

_WALL_HEIGHT = 1.0
_BODY_HEIGHT = 0.1
_LIDAR_HEIGHT = 0.3
"""m; above the body, which the rays would hit as well."""


class PybulletEngine:
    """The arena in pybullet."""

    def __init__(self, arena: Arena) -> None:
        """Build it."""
        self._arena = arena
        pybullet.connect(pybullet.DIRECT)
        pybullet.setTimeStep(arena.dt)
        for x, y, half_x, half_y in arena.boxes.tolist():
            extents = [half_x, half_y, _WALL_HEIGHT / 2.0]
            shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=extents)
            pybullet.createMultiBody(0.0, shape, basePosition=[x, y, _WALL_HEIGHT / 2.0])
        cylinder = pybullet.createCollisionShape(
            pybullet.GEOM_CYLINDER, radius=arena.radius, height=_BODY_HEIGHT
        )
        self._body = pybullet.createMultiBody(1.0, cylinder)
        pybullet.changeDynamics(self._body, -1, lateralFriction=0.0)

    def place(self, x: float, y: float, theta: float) -> None:
        turn = [0.0, 0.0, math.sin(theta / 2.0), math.cos(theta / 2.0)]
        pybullet.resetBasePositionAndOrientation(self._body, [x, y, _BODY_HEIGHT], turn)

    def pose(self) -> tuple[float, float, float]:
        (x, y, _), turn = pybullet.getBasePositionAndOrientation(self._body)
        return x, y, 2.0 * math.atan2(turn[2], turn[3])

    def step(self, linear: float, angular: float) -> bool:
        _, _, theta = self.pose()
        velocity = [linear * math.cos(theta), linear * math.sin(theta), 0.0]
        pybullet.resetBaseVelocity(self._body, velocity, [0.0, 0.0, angular])
        pybullet.stepSimulation()
        return len(pybullet.getContactPoints(self._body)) > 0

    def scan(self) -> NDArray[np.float64]:
        x, y, theta = self.pose()
        beams = self._arena.beams
        ends = np.column_stack([self._arena.beams_from(x, y, theta), np.full(beams, _LIDAR_HEIGHT)])
        starts = [[x, y, _LIDAR_HEIGHT]] * beams
        hits = pybullet.rayTestBatch(starts, ends.tolist())
        return np.array([hit[2] for hit in hits]) * self._arena.reach


def prepare(parameters: Parameters) -> Work:
    """Build the arena."""
    arena = Arena.of(parameters)
    return work_of(PybulletEngine(arena), arena, parameters)
