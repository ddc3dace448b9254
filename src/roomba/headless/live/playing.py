"""What can be done to the home of a live headless robot, for teaching; and the truth of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from roomba.client.observed import STATION_BOX
from roomba.client.view import DoorView, GridLayer, PlayAct, Point, TruthView
from roomba.geometry import Pose
from roomba.headless.cleaner import HeadlessMission
from roomba.world.engine.state.arrays import Fault
from roomba.world.home.home import Box, Home, MovingKind
from roomba.world.simulator import Simulator

_ROUND: Final = 12
"""Corners of what is round, as drawn."""
_DIRTIEST: Final = 6.0
"""g/m2 that are drawn as the dirtiest floor there is."""


class Playing:
    """Does to a home what a hand would do, and tells what is really so."""

    def __init__(self, home: Home) -> None:
        """Play in a home."""
        self._home = home
        own = home.exact
        self._doors = {door.name: door.opening for door in own.doors} if own is home else {}
        self._unmapped = tuple(
            tuple(_corners(box, Pose()))
            for piece in home.furniture
            if not piece.on_map
            for box in piece.boxes
        )

    @property
    def acts(self) -> tuple[str, ...]:
        """What is offered: values of :class:`roomba.client.view.PlayAct`."""
        leaves = any(thing.kind is MovingKind.DOOR for thing in self._home.moving)
        return tuple(act.value for act in PlayAct if act is not PlayAct.DOOR or leaves)

    # ---------------------------------------------------------------- acts, in the robot's thread

    def block_station(self, simulator: Simulator) -> None:
        """Put a box before the station; raises ValueError where the robot stands."""
        before, radius = STATION_BOX
        place = self._home.station.compose(Pose(-before, 0.0, 0.0))
        simulator.place_obstacle(place.x, place.y, radius)

    def lift(self, simulator: Simulator) -> None:
        """Lift the robot: its wheels hang."""
        simulator.inject(Fault.LIFTED, 1.0)

    def put_down(self, simulator: Simulator, pose: Pose) -> None:
        """Put the robot on the floor; raises HomeError where it does not fit."""
        simulator.put(pose)
        simulator.inject(Fault.LIFTED, 0.0)

    # ---------------------------------------------------------------- the truth

    def truth(self, robot: HeadlessMission) -> TruthView:
        """Return what is really so."""
        simulator = robot.simulator
        pose = robot.seen.pose
        return TruthView(
            (pose.x, pose.y, pose.theta),
            (*self._unmapped, *self._things(simulator), *map(_ring, simulator.discs.tolist())),
            tuple(self._doors_now(simulator)),
            simulator.numbers["lifted"] > 0.0,
        )

    def dirt(self, robot: HeadlessMission) -> GridLayer | None:
        """Return the dirt that lies on the floor; None for a home that was turned."""
        if self._home.turned is not None:
            return None
        dirt = robot.simulator.dirt
        cells = np.minimum(255.0 * dirt.density / _DIRTIEST, 255.0).astype(np.uint8)
        return GridLayer.over(dirt.frame, cells, 1)

    def _things(self, simulator: Simulator) -> Iterator[tuple[Point, ...]]:
        """Yield the outlines of what moves, doors apart."""
        for thing, (x, y, theta, is_present) in zip(
            self._home.moving, simulator.things.tolist(), strict=True
        ):
            if is_present and thing.kind is not MovingKind.DOOR:
                for box in thing.boxes:
                    yield tuple(_corners(box, Pose(x, y, theta)))

    def _doors_now(self, simulator: Simulator) -> Iterator[DoorView]:
        for thing, (_, _, _, is_present) in zip(
            self._home.moving, simulator.things.tolist(), strict=True
        ):
            opening = self._doors.get(thing.name)
            if thing.kind is MovingKind.DOOR and opening is not None:
                corners = opening.x_min, opening.y_min, opening.x_max, opening.y_max
                yield DoorView(thing.name, corners, bool(is_present))


def _corners(box: Box, pose: Pose) -> Iterator[Point]:
    placed = box.placed_at(pose)
    ahead = 0.5 * box.length * math.cos(placed.theta), 0.5 * box.length * math.sin(placed.theta)
    aside = -0.5 * box.width * math.sin(placed.theta), 0.5 * box.width * math.cos(placed.theta)
    for along, across in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        yield (
            placed.x + along * ahead[0] + across * aside[0],
            placed.y + along * ahead[1] + across * aside[1],
        )


def _ring(disc: list[float]) -> tuple[Point, ...]:
    x, y, radius = disc
    turns = (math.tau * part / _ROUND for part in range(_ROUND))
    return tuple((x + radius * math.cos(turn), y + radius * math.sin(turn)) for turn in turns)
