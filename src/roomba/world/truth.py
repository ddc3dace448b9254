"""The truth of a simulated home that its robot does not know, to be shown for teaching."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Point, Pose
from roomba.grid import GridFrame
from roomba.world.home.home import Box, Home, MovingKind
from roomba.world.home.raster import footprint
from roomba.world.simulator import Simulator

_ROUND: Final = 12
"""Corners of what is round, as drawn."""
_DIRTIEST: Final = 6.0
"""g/m2 that are drawn as the dirtiest floor there is."""


@dataclass(frozen=True, slots=True)
class DoorNow:
    """A door that can be shut: lowest x and y, highest x and y of its opening, m."""

    name: str
    opening: tuple[float, float, float, float]
    is_shut: bool


@dataclass(frozen=True, slots=True)
class HomeNow:
    """Outlines of what stands about besides the map, the doors, and whether the robot is lifted."""

    things: tuple[tuple[Point, ...], ...]
    doors: tuple[DoorNow, ...]
    is_lifted: bool


class HomeTruth:
    """Tells how a home really is, with all that was done to it."""

    def __init__(self, home: Home) -> None:
        """Tell of a home."""
        self._home = home
        self._is_turned = home.axes != Pose()
        doors = () if self._is_turned else home.doors
        self._openings = {door.name: door.opening for door in doors}
        self._unmapped = tuple(
            _corners(box, Pose())
            for piece in home.furniture
            if not piece.on_map
            for box in piece.boxes
        )

    @property
    def has_doors(self) -> bool:
        """Whether there are doors that can be moved."""
        return any(thing.kind is MovingKind.DOOR for thing in self._home.moving)

    def now(self, simulator: Simulator) -> HomeNow:
        """Return how the home is now."""
        return HomeNow(
            (*self._unmapped, *self._things(simulator), *map(_ring, simulator.discs.tolist())),
            tuple(self._doors(simulator)),
            simulator.numbers["lifted"] > 0.0,
        )

    def dirt(self, simulator: Simulator) -> tuple[GridFrame, NDArray[np.float64]] | None:
        """Return the dirt on the floor, float64 [rows, columns] of 0 clean to 1 the dirtiest.

        None for a home that was turned: its dirt lies in axes of its own.
        """
        if self._is_turned:
            return None
        dirt = simulator.dirt
        return dirt.frame, np.minimum(dirt.density / _DIRTIEST, 1.0)

    def _things(self, simulator: Simulator) -> Iterator[tuple[Point, ...]]:
        """Yield the outlines of what moves, doors apart."""
        for thing, (x, y, theta, is_present) in zip(
            self._home.moving, simulator.things.tolist(), strict=True
        ):
            if is_present and thing.kind is not MovingKind.DOOR:
                for box in thing.boxes:
                    yield _corners(box, Pose(x, y, theta))

    def _doors(self, simulator: Simulator) -> Iterator[DoorNow]:
        for thing, (_, _, _, is_present) in zip(
            self._home.moving, simulator.things.tolist(), strict=True
        ):
            opening = self._openings.get(thing.name)
            if thing.kind is MovingKind.DOOR and opening is not None:
                corners = opening.x_min, opening.y_min, opening.x_max, opening.y_max
                yield DoorNow(thing.name, corners, bool(is_present))


def _corners(box: Box, pose: Pose) -> tuple[Point, ...]:
    return tuple(footprint(box.placed_at(pose)).exterior.coords[:-1])


def _ring(disc: list[float]) -> tuple[Point, ...]:
    x, y, radius = disc
    turns = (math.tau * part / _ROUND for part in range(_ROUND))
    return tuple((x + radius * math.cos(turn), y + radius * math.sin(turn)) for turn in turns)
