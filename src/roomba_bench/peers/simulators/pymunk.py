"""pymunk (Chipmunk): a rigid disc among static boxes, one segment query per beam."""

from __future__ import annotations

import math

import numpy as np
import pymunk
from numpy.typing import NDArray

from roomba_bench.peers.protocol import Parameters, Work
from roomba_bench.peers.simulators.arena import Arena, work_of

DISTRIBUTION = "pymunk"

_WALLS, _ROBOT = 0b01, 0b10


class PymunkEngine:
    """The arena in pymunk."""

    def __init__(self, arena: Arena) -> None:
        """Build it."""
        self._arena = arena
        self._space = pymunk.Space()
        for x, y, half_x, half_y in arena.boxes.tolist():
            corners = [(x - half_x, y - half_y), (x + half_x, y - half_y)]
            corners += [(x + half_x, y + half_y), (x - half_x, y + half_y)]
            wall = pymunk.Poly(self._space.static_body, corners)
            wall.filter = pymunk.ShapeFilter(categories=_WALLS)
            self._space.add(wall)
        self._body = pymunk.Body(1.0, 1.0)
        disc = pymunk.Circle(self._body, arena.radius)
        disc.filter = pymunk.ShapeFilter(categories=_ROBOT)
        self._space.add(self._body, disc)
        self._sees = pymunk.ShapeFilter(mask=_WALLS)
        self._ranges = np.empty(arena.beams)
        self._touches = 0

    def place(self, x: float, y: float, theta: float) -> None:
        self._body.position = (x, y)
        self._body.angle = theta

    def pose(self) -> tuple[float, float, float]:
        return self._body.position.x, self._body.position.y, self._body.angle

    def step(self, linear: float, angular: float) -> bool:
        body = self._body
        body.velocity = (linear * math.cos(body.angle), linear * math.sin(body.angle))
        body.angular_velocity = angular
        self._space.step(self._arena.dt)
        self._touches = 0
        body.each_arbiter(self._count)
        return self._touches > 0

    def _count(self, arbiter: object) -> None:
        self._touches += 1

    def scan(self) -> NDArray[np.float64]:
        x, y, theta = self.pose()
        ranges, query, sees = self._ranges, self._space.segment_query_first, self._sees
        for beam, (end_x, end_y) in enumerate(self._arena.beams_from(x, y, theta).tolist()):
            hit = query((x, y), (end_x, end_y), 0.0, sees)
            ranges[beam] = 1.0 if hit is None else hit.alpha
        return ranges * self._arena.reach


def prepare(parameters: Parameters) -> Work:
    """Build the arena."""
    arena = Arena.of(parameters)
    return work_of(PymunkEngine(arena), arena, parameters)
