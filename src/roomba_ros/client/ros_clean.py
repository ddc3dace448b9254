"""Cleaning and docking as user interfaces ask for it, over ROS: that half of a RobotClient."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Sequence
from typing import Final

import rospy
from roomba_robot.msg import (
    CleanAction,
    DockAction,
    DockGoal,
    ExploreAction,
    ExploreGoal,
    RoomArray,
    UndockAction,
    UndockGoal,
    VacuumState,
)
from roomba_robot.srv import ChangeRooms
from std_srvs.srv import Trigger

from roomba.clean_request import CleanRequest
from roomba.client.protocol import (
    CleanHandle,
    CleaningClient,
    DockingHandle,
    ExploringHandle,
    RequestRefusedError,
    RobotUnavailableError,
    VacuumSnapshot,
)
from roomba.vocabulary import AT_REST, HELD, Phase, RoomWay
from roomba_ros.client.ros_errands import RosClean, RosDocking, RosExploring, Server
from roomba_ros.convert.clean_action import goal_of, way_codes
from roomba_ros.convert.client import room_names_of, vacuum_of
from roomba_ros.runtime.calls import call_service
from roomba_ros.runtime.subscriptions import subscribe

OLDEST_VACUUM_STATE: Final = 6.0
"""s of wall time; the state is published every second, but a long plan may delay it by some."""
_SIMULATION_DEADLINE: Final = 1.0
"""s of wall time in which the service of a simulation is found; a real robot has no such
service."""
_IS_OBEYED: Final[dict[str, Callable[[VacuumSnapshot], bool]]] = {
    "pause": lambda vacuum: vacuum.phase == Phase.PAUSED,
    "resume": lambda vacuum: vacuum.phase not in HELD,
    "stop": lambda vacuum: (
        vacuum.phase in AT_REST or (vacuum.phase == Phase.EMERGENCY and vacuum.wanted == 0.0)
    ),
}
"""By order: whether a state can follow it; a state that cannot is from before the order."""


class RosVacuum(CleaningClient):
    """The robot in this node's namespace, used as a vacuum cleaner."""

    def __init__(self) -> None:
        """Connect nothing yet."""
        self._told = threading.Condition()
        self._vacuum: VacuumSnapshot | None = None
        self._vacuum_heard = -math.inf
        self._rooms: tuple[str, ...] | None = None

    def start(self) -> None:
        """Connect."""
        self._cleans = Server("clean", CleanAction)
        self._docks = Server("dock", DockAction)
        self._undocks = Server("undock", UndockAction)
        self._explores = Server("explore", ExploreAction)
        self._orders = {
            name: rospy.ServiceProxy(name, Trigger)
            for name in ("pause", "resume", "stop", "locate", "empty_bin", "sim/empty_bin")
        }
        self._change_rooms = rospy.ServiceProxy("change_rooms", ChangeRooms)
        subscribe("vacuum/state", VacuumState, vacuum_of, self._on_vacuum_state)
        subscribe("rooms", RoomArray, room_names_of, self._on_rooms)

    def begin_clean(self, request: CleanRequest) -> CleanHandle:
        """Send the goal; raises RobotUnavailableError when no action server answers in time."""
        return RosClean(self._cleans, goal_of(request))

    def change_rooms(self, rooms: Sequence[str], each: Sequence[RoomWay] = ()) -> None:
        """Let the clean of rooms under way go on with these."""
        answer = call_service(self._change_rooms, list(rooms), *way_codes(each))
        if not answer.success:
            raise RequestRefusedError(answer.message)

    def dock(self) -> DockingHandle:
        """Send the goal; raises RobotUnavailableError when no action server answers in time."""
        return RosDocking(self._docks, DockGoal())

    def undock(self) -> DockingHandle:
        """Send the goal; raises RobotUnavailableError when no action server answers in time."""
        return RosDocking(self._undocks, UndockGoal())

    def explore(self) -> ExploringHandle:
        """Send the goal; raises RobotUnavailableError when no action server answers in time."""
        return RosExploring(self._explores, ExploreGoal())

    def pause(self) -> None:
        """Let it stand until it is told to go on."""
        self._order("pause")

    def resume(self) -> None:
        """Let it go on."""
        self._order("resume")

    def stop(self) -> None:
        """End what it does."""
        self._order("stop")

    def locate(self) -> None:
        """Let it beep."""
        self._order("locate")

    def empty_bin(self) -> None:
        """Tell that the dust bin was emptied; in a simulation empty it: its level sensor tells."""
        try:
            rospy.wait_for_service("sim/empty_bin", timeout=_SIMULATION_DEADLINE)
        except rospy.ROSException:
            self._order("empty_bin")
        else:
            self._order("sim/empty_bin")

    def vacuum(self, timeout: float = 5.0) -> VacuumSnapshot:
        """Return the newest state; waits up to ``timeout`` s of wall time for one that is new."""
        with self._told:
            if not self._told.wait_for(self._vacuum_is_new, timeout):
                raise RobotUnavailableError(
                    f"nothing came on vacuum/state within {timeout:g} s; is the robot running "
                    "(`./roomba run`)?"
                )
            assert self._vacuum is not None
            return self._vacuum

    def rooms(self, timeout: float = 5.0) -> tuple[str, ...]:
        """Return the names of the map's rooms; the topic is latched, so one message is enough."""
        with self._told:
            if not self._told.wait_for(lambda: self._rooms is not None, timeout):
                raise RobotUnavailableError(
                    f"nothing came on rooms within {timeout:g} s; is the robot running "
                    "(`./roomba run`), and has it a map?"
                )
            assert self._rooms is not None
            return self._rooms

    def _order(self, name: str) -> None:
        answer = call_service(self._orders[name])
        if not answer.success:
            raise RequestRefusedError(answer.message)
        is_obeyed = _IS_OBEYED.get(name)
        with self._told:
            if is_obeyed and self._vacuum is not None and not is_obeyed(self._vacuum):
                # The state comes by another connection than the answer, perhaps later.
                self._vacuum_heard = -math.inf

    def _vacuum_is_new(self) -> bool:
        return time.monotonic() - self._vacuum_heard < OLDEST_VACUUM_STATE

    def _on_vacuum_state(self, snapshot: VacuumSnapshot) -> None:
        with self._told:
            self._vacuum = snapshot
            self._vacuum_heard = time.monotonic()
            self._told.notify_all()

    def _on_rooms(self, names: tuple[str, ...]) -> None:
        with self._told:
            self._rooms = names
            self._told.notify_all()
