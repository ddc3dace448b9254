"""The input and output of docking at a tick, and the reasons of failures."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from roomba.geometry import Pose, Twist
from roomba.mission.docking.beams import StationBeams


class DockState(Enum):
    """The state of docking."""

    SEARCHING = "searching"
    """It sees no beam, and looks for them."""
    APPROACHING = "approaching"
    """It drives at the station."""
    TOUCHING = "touching"
    """It stands at the contacts and waits for current, or for current to last."""
    BACKING_OFF = "backing off"
    """It goes back for another attempt."""
    WAITING = "waiting"
    """It waits at a distance for what is in its way to leave."""
    DOCKED = "docked"
    """Current comes."""
    FAILED = "failed"
    """Given up; the reason is told."""


class Trouble(Enum):
    """Why an attempt, or all of docking, failed; the value says what is wrong and what helps."""

    BLOCKED = "the station is blocked: something stands before it; clear the way to it"
    NO_CURRENT = (
        "contact, but no charging current: clean the contacts of robot and station, and see that "
        "nothing lies between them"
    )
    NO_CONTACT = (
        "nothing was touched where the station should stand: put it back to its place on the map"
    )
    BEAMS_LOST = "the station's beams vanished on the way: see that it has power, and clear the way"
    NO_POWER = (
        "no beams, and no current at the station's contacts: the station has no power, see that it "
        "is plugged in; or the robot's infrared receiver is covered, wipe it"
    )
    NOT_THERE = (
        "no beams: the station has no power or does not stand where the map says; plug it in, or "
        "put it back to its place"
    )
    HIDDEN = (
        "no beams, and something stands where the way to the station should be: clear the way, and "
        "see that the station has power and stands where the map says"
    )
    CLIFF = (
        "no floor is seen before the station: set the robot down, clear the floor, or wipe the "
        "cliff sensors"
    )
    BUMPER_STUCK = "the bumper stays pressed: free it"
    STUCK = "the robot does not move: see whether something holds it or its wheels"
    LOST = "the robot does not know where it is and sees no beams: bring it before its station"
    FAR = "the robot is too far away from its station: bring it near first"
    TIMEOUT = "it took too long"

    @property
    def may_end_with_beams(self) -> bool:
        """Whether docking may succeed once beams are seen again; a lost robot must be brought."""
        return self in (Trouble.NO_POWER, Trouble.NOT_THERE, Trouble.HIDDEN)


@dataclass(frozen=True, slots=True)
class DockSenses:
    """What docking needs to know at a tick: time in s, believed pose in the map frame.

    ``is_charging``: current comes from the station, or its contacts are felt in another way (a
    full battery draws none). ``is_known``: the pose can be used.
    """

    now: float
    pose: Pose
    halo: bool = False
    green: bool = False
    red: bool = False
    bumper_left: bool = False
    bumper_right: bool = False
    cliff: bool = False
    is_charging: bool = False
    is_known: bool = True

    @property
    def beams(self) -> StationBeams:
        """The beams alone."""
        return StationBeams(self.halo, self.green, self.red)

    @property
    def bumper(self) -> bool:
        """Whether any part of the bumper is pressed."""
        return self.bumper_left or self.bumper_right


@dataclass(frozen=True, slots=True)
class DockStep:
    """What docking wants at a tick, and its ``attempts`` so far.

    ``reason`` says why it failed, or what is to be done though it docked; ``trouble`` is what ended
    the last attempt that failed.
    """

    state: DockState
    twist: Twist
    reason: str = ""
    attempts: int = 0
    trouble: Trouble | None = None
