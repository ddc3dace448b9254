"""Box2D (pybox2d): a rigid disc among static boxes, one ray cast per beam."""

from __future__ import annotations

import math

import Box2D
import numpy as np
from numpy.typing import NDArray

from roomba_bench.peers.protocol import Parameters, Work
from roomba_bench.peers.simulators.arena import Arena, work_of

DISTRIBUTION = "Box2D"


class _Nearest(Box2D.b2RayCastCallback):  # type: ignore[misc]
    """Keeps the nearest hit of a ray, as a fraction of it."""

    fraction = 1.0

    def ReportFixture(  # noqa: N802
        self, fixture: object, point: object, normal: object, fraction: float
    ) -> float:
        self.fraction = fraction
        return fraction


class Box2dEngine:
    """The arena in Box2D."""

    def __init__(self, arena: Arena) -> None:
        """Build it."""
        self._arena = arena
        self._world = Box2D.b2World(gravity=(0.0, 0.0))
        for x, y, half_x, half_y in arena.boxes.tolist():
            shape = Box2D.b2PolygonShape(box=(half_x, half_y))
            self._world.CreateStaticBody(position=(x, y), shapes=shape)
        disc = Box2D.b2CircleShape(radius=arena.radius)
        self._body = self._world.CreateDynamicBody()
        self._body.CreateFixture(shape=disc, density=1.0, friction=0.0)
        self._callback = _Nearest()
        self._ranges = np.empty(arena.beams)

    def place(self, x: float, y: float, theta: float) -> None:
        self._body.transform = ((x, y), theta)

    def pose(self) -> tuple[float, float, float]:
        return self._body.position.x, self._body.position.y, self._body.angle

    def step(self, linear: float, angular: float) -> bool:
        body = self._body
        body.linearVelocity = (linear * math.cos(body.angle), linear * math.sin(body.angle))
        body.angularVelocity = angular
        body.awake = True
        self._world.Step(self._arena.dt, 6, 2)
        return any(edge.contact.touching for edge in body.contacts)

    def scan(self) -> NDArray[np.float64]:
        x, y, theta = self.pose()
        callback, ranges, cast = self._callback, self._ranges, self._world.RayCast
        for beam, end in enumerate(self._arena.beams_from(x, y, theta).tolist()):
            callback.fraction = 1.0
            cast(callback, (x, y), end)
            ranges[beam] = callback.fraction
        return ranges * self._arena.reach


def prepare(parameters: Parameters) -> Work:
    """Build the arena."""
    arena = Arena.of(parameters)
    return work_of(Box2dEngine(arena), arena, parameters)
