"""A live headless robot as the menu and programs see it: errands that can be waited for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

from roomba.clean_request import CleanRequest
from roomba.client.protocol import (
    CleanHandle,
    CleaningClient,
    DockingHandle,
    ExploringHandle,
    Limits,
    RobotState,
    RobotUnavailableError,
    VacuumSnapshot,
    WalkHandle,
)
from roomba.configuration.seed import SeedParameters
from roomba.headless.embodied import Embodied
from roomba.headless.live.client import LiveClient
from roomba.headless.live.errand import LiveErrand
from roomba.headless.live.errands import LiveClean, LiveDocking, LiveExploring, LiveWalk
from roomba.headless.live.snapshots import ErrandsEnded
from roomba.headless.live.views import vacuum_snapshot
from roomba.mission.phases.machine import Event
from roomba.perception.localization.estimate import Knowledge
from roomba.vocabulary import RoomWay

_AnyErrand = LiveErrand[Any, Any]
_Begun = TypeVar("_Begun", bound=_AnyErrand)


class LiveRobotClient(CleaningClient):
    """A :class:`roomba.client.protocol.RobotClient` of a robot that lives in this process.

    One walk and one errand can be under way: a walk pauses the errand.
    """

    def __init__(self, client: LiveClient) -> None:
        """Take the robot; this object neither starts nor ends it."""
        self._client = client
        self._begun: _AnyErrand | None = None
        self._under_way: list[_AnyErrand] = []
        self._parts = client.obey, lambda: client.ending, client.speed
        client.watch(self._follow)

    def limits(self) -> Limits:
        """Return the coordinates that the report allows, and the body's top speed."""
        seed = SeedParameters()
        return Limits(seed.min_cordinate, seed.max_cordinate, self._client.limits().max_speed)

    def station(self) -> tuple[float, float]:
        """Return where the robot stands when it is docked."""
        station = self._client.ask(lambda robot: robot.mission.context.station)
        return station.x, station.y

    def state(self, timeout: float = 5.0) -> RobotState:
        """Return the state as it is now."""
        return self._client.ask(_state, timeout)

    def path_length(self, x: float, y: float) -> float:
        """Return the length of the way to a point, m."""
        return self._client.ask(lambda robot: robot.brain.way_to(x, y).length)

    def walk_to(self, x: float, y: float) -> WalkHandle:
        """Start walking; an errand under way pauses."""
        return self._begin(LiveWalk(*self._parts, (x, y)))

    def begin_clean(self, request: CleanRequest) -> CleanHandle:
        """Start cleaning."""
        return self._begin(LiveClean(*self._parts, request))

    def change_rooms(self, rooms: Sequence[str], each: Sequence[RoomWay] = ()) -> None:
        """Let the clean of rooms under way go on with these."""
        self._client.change_rooms(tuple(rooms), tuple(each))

    def dock(self) -> DockingHandle:
        """Start for the charging station."""
        return self._begin(LiveDocking(*self._parts))

    def undock(self) -> DockingHandle:
        """Start backing out of the charging station."""
        return self._begin(LiveDocking(*self._parts, Event.UNDOCK))

    def explore(self) -> ExploringHandle:
        """Start looking at what the robot's own map does not show yet."""
        return self._begin(LiveExploring(*self._parts))

    def pause(self) -> None:
        """Let the robot stand until it is told to go on."""
        self._client.pause()

    def resume(self) -> None:
        """Let a paused robot go on."""
        self._client.resume()

    def stop(self) -> None:
        """End what it does, and stay."""
        self._client.stop()

    def locate(self) -> None:
        """Let the robot beep."""
        self._client.locate()

    def empty_bin(self) -> None:
        """Empty the dust bin, and tell the robot."""
        self._client.empty_bin()

    def vacuum(self, timeout: float = 5.0) -> VacuumSnapshot:
        """Return what it does now."""
        return self._client.ask(vacuum_snapshot, timeout)

    def rooms(self, timeout: float = 5.0) -> tuple[str, ...]:
        """Return the names of the rooms."""
        names = tuple(room.name for room in self._client.home().rooms)
        if not names:
            raise RobotUnavailableError("there are no rooms yet: explore the home first")
        return names

    def _begin(self, errand: _Begun) -> _Begun:
        def begin(robot: Embodied) -> None:
            if errand.begin(robot):
                self._begun = errand

        self._client.obey(begin)
        return errand

    def _follow(self, robot: Embodied, ended: ErrandsEnded) -> None:
        """Follow what is under way; what began just now ends others of its kind."""
        for errand in self._still_under_way():
            errand.follow(robot, ended)
        begun, self._begun = self._begun, None
        if begun is not None:
            for errand in self._still_under_way():
                if isinstance(errand, LiveWalk) is isinstance(begun, LiveWalk):
                    errand.give_way()
            begun.follow(robot, ErrandsEnded())
            self._under_way.append(begun)

    def _still_under_way(self) -> list[_AnyErrand]:
        self._under_way = [errand for errand in self._under_way if not errand.has_ended]
        return self._under_way


def _state(robot: Embodied) -> RobotState:
    estimate = robot.brain.keeper.place.estimate
    doubt = "" if estimate.knowledge is Knowledge.KNOWN else estimate.reason
    speed, dirt = abs(robot.now.twist.linear), robot.dirt_under
    return RobotState(estimate.pose.x, estimate.pose.y, speed, dirt, doubt)
