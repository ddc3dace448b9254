"""How a clean ended, what it achieved, and what it missed."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from roomba.shares import share_of
from roomba.time_spent import NOT_COUNTED, TimeSpent
from roomba.vocabulary import OpenEdge, RoomDirt


class CleanOutcome(Enum):
    """How a clean ended."""

    COMPLETED = "completed"
    """All that could be reached is clean, and the robot is back on its station."""
    STOPPED = "stopped"
    """It was ended by a command."""
    BATTERY = "battery"
    """There was not enough energy to go on, and none to be had."""
    STUCK = "stuck"
    """It could not get free."""
    LOST = "lost"
    """It does not know where it is."""
    NOT_DOCKED = "not docked"
    """The floor is done, but it could not get onto its station."""
    FAULT = "fault"
    """Something else is wrong; the message says what."""


class MissReason(Enum):
    """Why floor was not cleaned."""

    THING = "something stands there that the map does not show"
    SHUT = "no way leads there: a door is shut, or something stands in the way"
    STOPPED = "it was stopped before"
    LEFT_OVER = "it was passed, but not all of it was met"
    EDGE = "the floor ends there"


@dataclass(frozen=True, slots=True)
class Missed:
    """Floor that was wanted and is not clean: ``area`` m2 around (x, y), m, and why."""

    area: float
    x: float
    y: float
    room: str
    reason: MissReason


@dataclass(frozen=True, slots=True)
class CleanResult:
    """What a clean achieved: areas m2, dirt g, distance m, duration s of robot time, energy Wh.

    ``open_edges`` are where the map that it made on the way still ended when nothing was left to
    look for, the longest first.
    """

    outcome: CleanOutcome
    message: str
    wanted: float
    covered: float
    dirt: float
    distance: float
    duration: float
    energy: float
    missed: tuple[Missed, ...] = field(default=())
    times: TimeSpent = NOT_COUNTED
    rooms: tuple[RoomDirt, ...] = ()
    open_edges: tuple[OpenEdge, ...] = ()

    @property
    def fraction(self) -> float:
        """Share of the wanted floor that is clean, 0..1."""
        return share_of(self.covered, self.wanted)
