"""What a user interface may ask of a robot: a protocol that ROS implements and a fake for tests.

Answers are immutable snapshots. Metres, m/s and seconds of the robot's clock; the map frame.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from roomba.clean_request import CleanRequest, Rectangle
from roomba.errors import RequestRefusedError as RequestRefusedError
from roomba.errors import RoombaError
from roomba.time_spent import NOT_COUNTED, TimeSpent
from roomba.vocabulary import (
    CarpetWay,
    CleanMode,
    EdgeOrder,
    FanLevel,
    Hindrance,
    OpenEdge,
    RoomDirt,
    RoomWay,
)
from roomba.vocabulary import MissedFloor as MissedFloor


class RobotUnavailableError(RoombaError):
    """The robot, or the part of it that was asked, does not answer."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Where and how fast the robot may go: both coordinates from ``low`` to ``high``."""

    low: float
    high: float
    max_speed: float


@dataclass(frozen=True, slots=True)
class RobotState:
    """The newest values that the robot reported; ``dirt`` in g under its body.

    ``doubt`` says why its place is not known well, and what helps; empty if it is.
    """

    x: float
    y: float
    speed: float
    dirt: float
    doubt: str = ""


class WalkOutcome(Enum):
    """How a walk ended."""

    ARRIVED = "arrived"
    CANCELLED = "cancelled"
    REFUSED = "refused"
    """Never begun: the destination cannot be walked to."""
    FAILED = "failed"
    """Given up on the way."""
    DISCONNECTED = "disconnected"
    """The connection to the action server was lost during the walk."""


@dataclass(frozen=True, slots=True)
class WalkReport:
    """The end of a walk; ``distance`` is what was really travelled, ``duration`` what it took."""

    outcome: WalkOutcome
    distance: float
    duration: float
    message: str


class WalkHandle(Protocol):
    """A walk under way."""

    def next_feedback(self, timeout: float) -> float | None:
        """Wait up to ``timeout`` s of wall time for news: the path distance left, m, else None.

        Returns None at once when the walk has ended; then there is a report.
        """

    def report(self) -> WalkReport | None:
        """Return the end of the walk, or None while it lasts."""

    def cancel(self) -> None:
        """Ask the robot to stop, without waiting; the report follows."""


class ErrandOutcome(Enum):
    """How an errand ended: a clean, or a way into or out of the station."""

    COMPLETED = "completed"
    """Done; after a clean the robot is back on its station."""
    STOPPED = "stopped"
    """The operator, or a program, ended it."""
    REFUSED = "refused"
    """Never begun: the robot cannot do it; the message says why."""
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
    DISCONNECTED = "disconnected"
    """The connection to the action server was lost. The robot itself resumes a clean once its
    mission node is back: :meth:`RobotClient.vacuum` reports it, this errand does not."""
    INTERRUPTED = "interrupted"
    """Only of a run in the history: the program that recorded it ended in the middle of it. No
    errand reports this."""


@dataclass(frozen=True, slots=True)
class CleanProgress:
    """How far a clean is: m2 of the wanted floor, its share 0..1, s to go without charging.

    ``state`` is cleaning, docked, paused, idle, returning or error; ``battery`` is 0..1; ``room``
    is where the robot is, empty for none.
    """

    state: str
    room: str
    covered: float
    wanted: float
    fraction: float
    seconds_to_go: float
    battery: float


@dataclass(frozen=True, slots=True)
class CleanReport:
    """The end of a clean: areas in m2, dirt in g, m, s of the robot's clock, Wh.

    What is not known, as after DISCONNECTED, is NaN; ``missed`` has the largest area first.
    ``times`` is what the duration went into; all 0 where that is not known. ``rooms`` are those
    that were swept, with their dirt. ``open_edges`` are where a map that was made on the way still
    ended when nothing was left to look for, the longest first. ``mapped`` is the floor on the map
    at the end of an exploration, m2; NaN of any other.
    """

    outcome: ErrandOutcome
    message: str
    covered: float
    wanted: float
    dirt: float
    distance: float
    duration: float
    energy: float
    missed: tuple[MissedFloor, ...] = ()
    times: TimeSpent = NOT_COUNTED
    rooms: tuple[RoomDirt, ...] = ()
    open_edges: tuple[OpenEdge, ...] = ()
    mapped: float = math.nan


class CleanHandle(Protocol):
    """A clean under way. It continues when the client goes away."""

    def next_feedback(self, timeout: float) -> CleanProgress | None:
        """Wait up to ``timeout`` s of wall time for news, else None; None at once at its end."""

    def report(self) -> CleanReport | None:
        """Return the end of the clean, or None while it lasts."""

    def cancel(self) -> None:
        """Ask the robot to stop and stay, without waiting; the report follows."""


@dataclass(frozen=True, slots=True)
class DockReport:
    """The end of a way into or out of the station; the message says why not, and what helps."""

    outcome: ErrandOutcome
    message: str


class DockingHandle(Protocol):
    """A way into or out of the station. It continues when the client goes away."""

    def next_feedback(self, timeout: float) -> str | None:
        """Wait up to ``timeout`` s of wall time for what it does: returning, docking, undocking.

        Returns None without news, and at once at its end.
        """

    def report(self) -> DockReport | None:
        """Return the end of it, or None while it lasts."""

    def cancel(self) -> None:
        """Ask the robot to stop and stay, without waiting; the report follows."""


@dataclass(frozen=True, slots=True)
class ExploreReport:
    """The end of an exploration: ``known`` m2 of floor, m, s of the robot's clock.

    What is not known, as after DISCONNECTED, is NaN. ``open_edges`` are where the map still ends,
    the longest first.
    """

    outcome: ErrandOutcome
    message: str
    known: float
    distance: float
    duration: float
    open_edges: tuple[OpenEdge, ...] = ()


class ExploringHandle(Protocol):
    """An exploration under way. It continues when the client goes away."""

    def next_feedback(self, timeout: float) -> float | None:
        """Wait up to ``timeout`` s of wall time for how much floor is known, m2.

        Returns None without news, and at once at its end.
        """

    def report(self) -> ExploreReport | None:
        """Return the end of it, or None while it lasts."""

    def cancel(self) -> None:
        """Ask the robot to stop and stay, without waiting; the report follows."""


@dataclass(frozen=True, slots=True)
class VacuumSnapshot:
    """The robot's state, in the words of smart homes, and its progress.

    ``phase`` is ``state`` in more detail; ``message`` says why it does not do what was asked, and
    what helps, empty when all is well. ``hindrance`` is the same for programs, and
    ``looks_within`` as in :class:`roomba.vocabulary.Reason`. ``queue`` are the rooms that a clean
    of rooms has still to do, the present one first, and ``queue_ways`` how each of them is cleaned.
    The rest is as in :class:`CleanProgress`; areas, share and time are 0 without a clean, a battery
    not heard of is not a number.
    """

    state: str
    phase: str
    message: str
    room: str
    covered: float
    wanted: float
    fraction: float
    seconds_to_go: float
    battery: float
    queue: tuple[str, ...] = ()
    is_on_carpet: bool = False
    hindrance: Hindrance = Hindrance.NONE
    looks_within: float = 0.0
    queue_ways: tuple[RoomWay, ...] = ()


class CleaningClient(Protocol):
    """A robot that cleans, by a request or by keywords that are made into one."""

    def begin_clean(self, request: CleanRequest) -> CleanHandle:
        """Start cleaning; another clean, or a way to the station, ends.

        Raises RequestRefusedError for what this robot cannot be asked, and RobotUnavailableError.
        If the robot refuses by its map or state, as for an unknown room, the handle's report says
        so.
        """

    def clean(
        self,
        mode: CleanMode = CleanMode.WHOLE,
        *,
        rooms: Sequence[str] = (),
        in_order: bool = False,
        zones: Sequence[Rectangle] = (),
        spot: tuple[float, float] | None = None,
        passes: int = 1,
        fan: FanLevel = FanLevel.STANDARD,
        each: Sequence[RoomWay] = (),
        carpets: CarpetWay = CarpetWay.BOOST,
        edges: EdgeOrder = EdgeOrder.ANY,
    ) -> CleanHandle:
        """Start the clean of a :class:`roomba.clean_request.CleanRequest` of these words.

        ``rooms`` are for ROOMS, ``in_order`` or else the shortest way; ``zones`` for ZONES, lowest
        x and y, highest x and y, m; ``spot`` for SPOT, None for where the robot is; ``passes`` 1
        to 5. ``each`` is how each of the rooms is cleaned, else ``passes`` and ``fan`` hold for
        all. Raises RequestRefusedError for what cannot be asked at all, RobotUnavailableError.
        """
        return self.begin_clean(
            CleanRequest(
                mode,
                rooms=tuple(rooms),
                zones=tuple(zones),
                spot=spot,
                passes=passes,
                fan=fan,
                in_order=in_order,
                each=tuple(each),
                carpets=carpets,
                edges=edges,
            )
        )


class RobotClient(CleaningClient, Protocol):
    """A robot as its user interfaces see it.

    Every call has a deadline of wall time and raises RobotUnavailableError after it.
    """

    def limits(self) -> Limits:
        """Return the limits in force now."""

    def station(self) -> tuple[float, float]:
        """Return where the charging station is."""

    def state(self, timeout: float = 5.0) -> RobotState:
        """Return the newest state; RobotUnavailableError when none comes in ``timeout`` s.

        A value that is a few seconds old counts as missing.
        """

    def path_length(self, x: float, y: float) -> float:
        """Return the length of the way to a point, m.

        Raises RequestRefusedError with the reason, RobotUnavailableError without an answer.
        """

    def walk_to(self, x: float, y: float) -> WalkHandle:
        """Start walking; raises RobotUnavailableError when no action server answers."""

    def change_rooms(self, rooms: Sequence[str], each: Sequence[RoomWay] = ()) -> None:
        """Let the clean of rooms under way go on with ``rooms``, in this order, the first at once.

        ``rooms`` are all that are still to be cleaned. ``each`` is how each of them is cleaned;
        without it, rooms of before stay as they were, and new ones are cleaned as the request says
        for all. Raises RequestRefusedError with the reason, RobotUnavailableError.
        """

    def dock(self) -> DockingHandle:
        """Start for the charging station, by its beams; raises RobotUnavailableError."""

    def undock(self) -> DockingHandle:
        """Start backing out of the charging station; raises RobotUnavailableError."""

    def explore(self) -> ExploringHandle:
        """Start looking at what the robot's own map does not show yet; then it goes home.

        Raises RobotUnavailableError.
        """

    def pause(self) -> None:
        """Let the robot stand until it is told to go on; RequestRefusedError with the reason."""

    def resume(self) -> None:
        """Let a paused robot go on; RequestRefusedError with the reason."""

    def stop(self) -> None:
        """End what it does, and stay; RequestRefusedError with the reason."""

    def locate(self) -> None:
        """Let the robot beep, so that a person finds it."""

    def empty_bin(self) -> None:
        """Tell the robot that its dust bin was emptied; RequestRefusedError with the reason.

        A simulated bin is emptied by that.
        """

    def vacuum(self, timeout: float = 5.0) -> VacuumSnapshot:
        """Return what it does now; RobotUnavailableError when it does not tell in ``timeout`` s."""

    def rooms(self, timeout: float = 5.0) -> tuple[str, ...]:
        """Return the names of the rooms; RobotUnavailableError when there are none yet."""


@runtime_checkable
class CameraClient(Protocol):
    """The robot's camera as its users see it."""

    def picture(self, degrees: float) -> NDArray[np.uint8]:
        """Return the picture nearest to an angle, uint8 [height, width, 3] RGB.

        Raises RobotUnavailableError (no camera service within 5 s) or RequestRefusedError.
        """
