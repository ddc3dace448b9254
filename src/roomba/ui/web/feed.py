"""One look at the robot for all viewers: its state, layers and home, ten times a second.

However many viewers there are, the robot is asked once. A viewer takes the newest when it is ready
for more; there is no queue.
"""

from __future__ import annotations

import asyncio
import math
from typing import Any, Final

from roomba.client.observed import ObservedRobot
from roomba.client.protocol import CleanReport, RobotUnavailableError
from roomba.client.view import HomeView, LayerName, RobotView
from roomba.errors import RoombaError
from roomba.ui.web.tiles import TiledLayer

PERIOD: Final = 0.1
"""s between two looks."""
_LAYERS_EVERY: Final = 3
"""Looks at the robot for one look at its layers."""
_STEP: Final = 0.03
"""m between two places of the trail."""
_MOST_TRAIL: Final = 20000
"""Places of the trail that are kept."""

Json = dict[str, Any]


class Feed:
    """What viewers are shown; ``number`` grows with each look."""

    def __init__(self, robot: ObservedRobot) -> None:
        """Begin with nothing."""
        self._robot = robot
        self._looked = asyncio.Condition()
        self._looks = 0
        self.number = 0
        self.state: Json = {"type": "state", "link": "connecting"}
        self.home: Json | None = None
        self.home_version = 0
        self.layers = {name: TiledLayer(name.value) for name in LayerName}
        self.trail: list[tuple[float, float]] = []
        self.trail_began = 0

    async def run(self) -> None:
        """Look at the robot for ever."""
        while True:
            await self.look()
            await asyncio.sleep(PERIOD)

    async def look(self) -> None:
        """Look at the robot once, and let waiting viewers know."""
        self._looks += 1
        try:
            view = await asyncio.to_thread(self._robot.robot)
            home = await asyncio.to_thread(self._robot.home)
            if self._looks % _LAYERS_EVERY == 1:
                await asyncio.to_thread(self._look_at_layers)
        except (RobotUnavailableError, RoombaError) as reason:
            # What was seen last stays on the page, greyed, with the reason.
            self.state = {**self.state, "link": "gone", "reason": str(reason)}
        else:
            self._follow(view.pose[0], view.pose[1])
            self.state = state_of(view)
            if home.version != self.home_version:
                self.home, self.home_version = home_of(home), home.version
        async with self._looked:
            self.number += 1
            self._looked.notify_all()

    async def newer(self, number: int) -> int:
        """Wait for a look after number ``number``; return the number of the newest."""
        async with self._looked:
            await self._looked.wait_for(lambda: self.number > number)
        return self.number

    def trail_since(self, count: int) -> Json | None:
        """Return the places of the trail after the first ``count`` of all that there ever were."""
        first = max(count - self.trail_began, 0)
        points = self.trail[first:]
        if not points and count >= self.trail_began:
            return None
        return {
            "type": "trail",
            "whole": count < self.trail_began or count == 0,
            "end": self.trail_began + len(self.trail),
            "points": points,
        }

    def _look_at_layers(self) -> None:
        for name, tiled in self.layers.items():
            layer = self._robot.layer(name)
            if layer is not None:
                tiled.update(layer)

    def _follow(self, x: float, y: float) -> None:
        if self.trail and math.dist(self.trail[-1], (x, y)) < _STEP:
            return
        self.trail.append((round(x, 3), round(y, 3)))
        surplus = len(self.trail) - _MOST_TRAIL
        if surplus > 0:
            del self.trail[:surplus]
            self.trail_began += surplus


def state_of(view: RobotView) -> Json:
    """Return a robot's state as JSON; what is not known is null."""
    vacuum = view.vacuum
    return {
        "type": "state",
        "link": "live",
        "time": round(view.time, 2),
        "pose": [round(value, 4) for value in view.pose],
        "doubt": view.doubt,
        "speed": round(view.speed, 3),
        "dirt": round(view.dirt, 2),
        "held": view.held,
        "vacuum": {
            "state": vacuum.state,
            "phase": vacuum.phase,
            "message": vacuum.message,
            "room": vacuum.room,
            "covered": round(vacuum.covered, 2),
            "wanted": round(vacuum.wanted, 2),
            "fraction": round(vacuum.fraction, 4),
            "seconds_to_go": round(vacuum.seconds_to_go, 1),
            "battery": known(vacuum.battery),
        },
        "scan": (view.scan * 100.0).round().astype(int).ravel().tolist(),
        "path": (view.path * 100.0).round().astype(int).ravel().tolist(),
        "last": None if view.last is None else report_of(view.last),
    }


def report_of(report: CleanReport) -> Json:
    """Return how an errand ended as JSON."""
    return {
        "outcome": report.outcome.value,
        "message": report.message,
        "covered": known(report.covered),
        "wanted": known(report.wanted),
        "dirt": known(report.dirt),
        "distance": known(report.distance),
        "duration": known(report.duration),
        "energy": known(report.energy),
        "missed": [
            {"area": miss.area, "x": miss.x, "y": miss.y, "room": miss.room, "reason": miss.reason}
            for miss in report.missed
        ],
    }


def home_of(view: HomeView) -> Json:
    """Return a home as JSON."""
    return {
        "type": "home",
        "version": view.version,
        "name": view.name,
        "station": view.station,
        "radius": view.radius,
        "tool": view.tool,
        "rooms": [
            {"name": room.name, "area": room.area, "anchor": room.anchor, "rings": room.rings}
            for room in view.rooms
        ],
        "zones": [
            {"name": zone.name, "kind": zone.kind, "points": zone.points} for zone in view.zones
        ],
        "furniture": view.furniture,
    }


def known(value: float) -> float | None:
    """Return a number as JSON has it: what is not finite is null."""
    return value if math.isfinite(value) else None
