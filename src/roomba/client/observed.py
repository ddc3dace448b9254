"""A robot as a page sees and commands it: the protocol that each kind of robot implements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol, runtime_checkable

from roomba.clean_request import CleanRequest
from roomba.client import view
from roomba.geometry import Point
from roomba.vocabulary import RoomWay

HAND_SILENCE: Final = 0.5
"""s of wall time; a drive by hand ends when no new command came for so long."""
SPILL: Final = (0.25, 6.0)
"""m and g of a heap of dirt."""
STATION_BOX: Final = (0.6, 0.15)
"""m; how far before the docked robot's middle a box blocks the station, and its radius."""


class ObservedRobot(Protocol):
    """One robot, observed ten times a second and commanded now and then.

    Each method returns at once, or within 5 s of wall time; then it raises RobotUnavailableError.
    Commands raise RequestRefusedError with the reason when the robot will not obey.
    """

    def limits(self) -> view.PageLimits:
        """Return what may be asked for."""

    def robot(self) -> view.RobotView:
        """Return the newest state; raises RobotUnavailableError before the first one."""

    def home(self) -> view.HomeView:
        """Return what seldom changes."""

    def layer(self, name: view.LayerName) -> view.GridLayer | None:
        """Return a layer as it is now, or None while there is none."""

    def clean(self, request: CleanRequest) -> None:
        """Begin a clean."""

    def change_rooms(self, rooms: tuple[str, ...], each: tuple[RoomWay, ...] = ()) -> None:
        """Let the clean of rooms under way go on with ``rooms``, as in RobotClient."""

    def explore(self) -> None:
        """Begin to look at what the map does not show yet."""

    def go_to(self, x: float, y: float) -> None:
        """Walk to a point, m; an errand under way is paused."""

    def dock(self) -> None:
        """Go to the charging station."""

    def pause(self) -> None:
        """Stand until told to go on."""

    def resume(self) -> None:
        """Go on."""

    def stop(self) -> None:
        """End the errand, and stay."""

    def locate(self) -> None:
        """Beep."""

    def empty_bin(self) -> None:
        """Tell that the dust bin was emptied; a simulated one is emptied."""

    def empty_at_station(self) -> None:
        """Let its station empty its bin; refused where the station cannot."""

    def replace_bag(self) -> None:
        """Put an empty bag into its simulated station; refused where there is none."""

    def emergency_stop(self, reason: str) -> None:
        """Hold the drive until it is released."""

    def release(self) -> None:
        """Release the emergency stop."""

    def drive(self, linear: float, angular: float) -> None:
        """Drive by hand, m/s and rad/s; without another call for 0.5 s the robot stands."""

    def set_top_speed(self, speed: float) -> None:
        """Set how fast it may drive, m/s."""

    def put_zone(self, zone: view.ZoneView) -> None:
        """Add a zone, or replace the one of the same name."""

    def remove_zone(self, name: str) -> None:
        """Remove a zone."""

    def rename_room(self, name: str, new_name: str) -> None:
        """Give a room another name."""

    def join_rooms(self, names: tuple[str, ...]) -> None:
        """Make rooms that touch one, by the first one's name."""

    def split_room(self, name: str, start: Point, end: Point) -> None:
        """Cut a room along a line between two points."""

    def undo_rooms(self) -> None:
        """Take back the newest edit of the rooms."""


@dataclass(frozen=True, slots=True)
class TimelineView:
    """Where a replay is: ``at`` of ``duration``, s; ``speed`` is recorded seconds per second.

    ``jumps`` grows by one whenever another time was chosen.
    """

    duration: float
    at: float
    speed: float
    is_playing: bool
    jumps: int


@runtime_checkable
class Timeline(Protocol):
    """What a recorded robot can do in addition: its time can be chosen."""

    def timeline(self) -> TimelineView:
        """Return where the recording is."""

    def play(self, *, is_playing: bool) -> None:
        """Go on, or stand."""

    def seek(self, at: float) -> None:
        """Show another time, s."""

    def set_speed(self, speed: float) -> None:
        """Play ``speed`` seconds of the recording per second."""

    def way(self) -> list[Point]:
        """Return the places up to now, m."""


@dataclass(frozen=True, slots=True)
class TickTimes:
    """Wall time that the robot's ticks took to compute since it began, ``seconds`` in all.

    Each of ``counts`` is how many ticks took at most the bound of the same place, s, and more than
    the bound before; the last count is of ticks above all bounds.
    """

    bounds: tuple[float, ...]
    counts: tuple[int, ...]
    seconds: float


@runtime_checkable
class Timed(Protocol):
    """What a robot that knows how long its ticks take can tell in addition."""

    def tick_times(self) -> TickTimes:
        """Return how long they took."""


@dataclass(frozen=True, slots=True)
class MapsView:
    """Names of the saved maps, and of the one that the robot goes by; empty if it is not saved."""

    names: tuple[str, ...]
    selected: str


@runtime_checkable
class MapKeeper(Protocol):
    """What a robot that keeps maps of its own can do in addition.

    What it would change of its map is in :attr:`roomba.client.view.HomeView.changes`.
    """

    def maps(self) -> MapsView:
        """Return the saved maps."""

    def save_map(self, name: str) -> None:
        """Save the map by a name."""

    def load_map(self, name: str) -> None:
        """Go by a saved map."""

    def remove_map(self, name: str) -> None:
        """Forget a saved map."""

    def change_map(self, *, is_accepted: bool) -> None:
        """Change the map as it is offered, or leave it and do not ask again."""

    def undo_change(self) -> None:
        """Take back the change of the map that was accepted last."""


@runtime_checkable
class FeelsLowThings(Protocol):
    """What a robot that offers no-go zones of its own can do in addition.

    The offers are in :attr:`roomba.client.view.HomeView.low_things`; one is accepted by putting it
    as any zone.
    """

    def ignore_low_thing(self, x: float, y: float) -> None:
        """Offer no zone any more of what was felt at a point, m."""


@runtime_checkable
class Playground(Protocol):
    """What can be done to a simulated home and robot, for teaching.

    Which of it a robot offers is in :attr:`roomba.client.view.PageLimits.play`.
    """

    def spill_dirt(self, x: float, y: float) -> None:
        """Spill a heap of dirt."""

    def place_chair(self, x: float, y: float) -> None:
        """Put a chair where it stands in the way."""

    def block_station(self) -> None:
        """Put a box before the station."""

    def clear_away(self) -> None:
        """Take away all that was put down."""

    def set_door(self, name: str, *, is_shut: bool) -> None:
        """Shut or open a door."""

    def lift(self) -> None:
        """Lift the robot: its wheels hang."""

    def put_down(self, x: float, y: float, theta: float) -> None:
        """Put the robot on the floor, m and rad."""
