"""The output of a phase at a tick."""

from __future__ import annotations

from dataclasses import dataclass

from roomba.geometry import STANDSTILL, Twist
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.phases.machine import Event
from roomba.vocabulary import Reason


@dataclass(frozen=True, slots=True)
class Failure:
    """Why the robot cannot go on by itself, as an outcome and in words.

    ``awaits_beams``: it goes on as soon as it sees its station's beams.
    """

    outcome: CleanOutcome
    reason: str
    awaits_beams: bool = False


@dataclass(frozen=True, slots=True)
class PhaseStep:
    """The twist wanted, and what ends the phase: an ``event`` or a ``failure``.

    ``reason`` is what is told from now on; None leaves that as it is. ``wants_whole_map``: all
    that can be seen was seen, and it waits for the map to be finished. ``empties``: its
    station is to empty its bin.
    """

    twist: Twist = STANDSTILL
    event: Event | None = None
    failure: Failure | None = None
    reason: Reason | None = None
    wants_whole_map: bool = False
    empties: bool = False
