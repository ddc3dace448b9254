"""A client's requests to clean, against a made-up mission node of a few callbacks."""

import math
import os
import sys
from pathlib import Path
from typing import Any

import actionlib
import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.waiting import wait_until
from geometry_msgs.msg import Point
from roomba_robot.msg import (
    CleanAction,
    CleanFeedback,
    CleanGoal,
    CleanResult,
    DockAction,
    DockFeedback,
    DockResult,
    ExploreAction,
    ExploreFeedback,
    ExploreResult,
    MissedArea,
    Room,
    RoomArray,
    RoomDirt,
    TimeSpent,
    UndockAction,
    VacuumState,
)
from roomba_robot.msg import OpenEdge as OpenEdgeMessage
from roomba_robot.srv import ChangeRooms, ChangeRoomsRequest, ChangeRoomsResponse
from std_srvs.srv import Trigger, TriggerResponse

from roomba.client.protocol import (
    ErrandOutcome,
    MissedFloor,
    RequestRefusedError,
    RobotUnavailableError,
)
from roomba.vocabulary import CleanMode, EdgeReason, FanLevel, OpenEdge, RoomWay
from roomba_ros.client.roomba_client import RoombaClient

EXAMPLE = Path(__file__).parents[3] / "examples" / "clean_home.py"


class Server(actionlib.ActionServer):  # type: ignore[misc]
    """Accepts every goal but those of the attic, and leaves the rest to the test."""

    def __init__(self, name: str, action: type) -> None:
        self.is_silent = False
        self.goals: list[Any] = []
        super().__init__(name, action, self._on_goal, lambda _: None, auto_start=False)
        self.start()

    def _on_goal(self, handle: Any) -> None:
        goal = handle.get_goal()
        if "attic" in getattr(goal, "rooms", ()):
            result = CleanResult(outcome=CleanResult.STOPPED, message="there is no attic")
            handle.set_rejected(result, "there is no attic")
            return
        handle.set_accepted()
        self.goals.append(handle)

    def publish_status(self) -> None:
        if not self.is_silent:
            super().publish_status()


class FakeMission:
    """What a client sees of a mission node; a Trigger is refused while ``refusal`` is set."""

    def __init__(self) -> None:
        self.cleans, self.docks = Server("clean", CleanAction), Server("dock", DockAction)
        self.undocks = Server("undock", UndockAction)
        self.explorations = Server("explore", ExploreAction)
        self.orders: list[str] = []
        self.refusal = ""
        for name in ("pause", "resume", "stop", "locate", "empty_bin"):
            rospy.Service(name, Trigger, lambda _, name=name: self._on_order(name))
        rospy.Service("change_rooms", ChangeRooms, self._on_rooms)
        self.state = rospy.Publisher("vacuum/state", VacuumState, queue_size=1, latch=True)
        self.rooms = rospy.Publisher("rooms", RoomArray, queue_size=1, latch=True)

    def _on_rooms(self, request: ChangeRoomsRequest) -> ChangeRoomsResponse:
        passes, fans = list(request.room_passes), list(request.room_fans)
        self.orders.append(f"{request.rooms} {passes} {fans}")
        return ChangeRoomsResponse(not self.refusal, self.refusal)

    def _on_order(self, name: str) -> TriggerResponse:
        self.orders.append(name)
        return TriggerResponse(not self.refusal, self.refusal)


def begin(graph: RosGraph) -> tuple[RoombaClient, FakeMission]:
    os.environ.update(graph.environment)
    return RoombaClient.connect(), FakeMission()


def tell(mission: FakeMission, roomba: RoombaClient, phase: str, wanted: float = 0.0) -> None:
    """Let the mission tell a phase, and wait until the client has heard it."""

    def is_heard() -> bool:
        vacuum = roomba.robot.vacuum(30.0)
        return (vacuum.phase, vacuum.wanted) == (phase, wanted)

    mission.state.publish(state=phase, phase=phase, wanted=wanted)
    wait_until(is_heard, 30.0, phase)


def test_a_clean_from_its_goal_to_its_report(graph: RosGraph) -> None:
    roomba, mission = begin(graph)
    rooms = ("Hall", "Küche")
    clean = roomba.robot.clean(
        CleanMode.ROOMS, rooms=rooms, in_order=True, passes=2, fan=FanLevel.STRONG
    )
    handle = wait_until(lambda: next(iter(mission.cleans.goals), None), 30.0)
    goal = handle.get_goal()
    assert (goal.mode, goal.rooms, goal.in_order) == (CleanGoal.ROOMS, list(rooms), True)
    assert (goal.passes, goal.fan, goal.spot_is_here) == (2, CleanGoal.STRONG, True)

    for covered in (1.0, 2.0):
        handle.publish_feedback(CleanFeedback("cleaning", "Hall", covered, 8.0, 0.25, 20.0, 0.5))
    told = clean.next_feedback(30.0)
    while told is not None and told.covered < 2.0:
        told = clean.next_feedback(30.0)
    assert told is not None
    assert (told.state, told.room, told.battery) == ("cleaning", "Hall", 0.5)
    assert clean.next_feedback(0.05) is None

    # One that is refused neither ends nor hides the one before it.
    refused = roomba.clean_rooms("attic")
    assert (refused.outcome, refused.message) == (ErrandOutcome.REFUSED, "there is no attic")
    assert clean.report() is None

    area = MissedArea(0.5, Point(1.0, 2.0, 0.0), "Hall", MissedArea.THING, "a chair")
    handle.set_aborted(
        CleanResult(
            outcome=CleanResult.LOST,
            message="no place",
            covered=6.0,
            wanted=8.0,
            dirt=12.0,
            distance=40.0,
            duration=300.0,
            energy=2.5,
            missed=[area],
            times=TimeSpent(least=125.0, straight=250.0),
            rooms=[RoomDirt("Hall", 0.75, 900.0), RoomDirt("Den", math.nan, 5.0)],
        ),
        "x",
    )
    report = wait_until(clean.report, 30.0)
    assert (report.outcome, report.message) == (ErrandOutcome.LOST, "no place")
    assert (report.covered, report.wanted, report.dirt) == (6.0, 8.0, 12.0)
    assert report.times.times_least == 2.0
    assert [(each.room, each.share, each.grains) for each in report.rooms] == [("Hall", 0.75, 900)]
    assert (report.distance, report.duration, report.energy) == (40.0, 300.0, 2.5)
    assert report.missed == (MissedFloor(0.5, 1.0, 2.0, "Hall", "a chair", "thing"),)

    exploring = roomba.robot.explore()
    handle = wait_until(lambda: next(iter(mission.explorations.goals), None), 30.0)
    handle.publish_feedback(ExploreFeedback("cleaning", 12.5, 0.5))
    assert exploring.next_feedback(30.0) == 12.5
    edge = OpenEdgeMessage(2.0, Point(1.0, 3.0, 0.0), OpenEdgeMessage.NOT_LOOKED_AT, "")
    handle.set_succeeded(ExploreResult(message="it is open", known=34.5, open_edges=[edge]), "")
    explored = wait_until(exploring.report, 30.0)
    assert (explored.outcome, explored.message) == (ErrandOutcome.COMPLETED, "it is open")
    assert explored.known == 34.5
    assert explored.open_edges == (OpenEdge(2.0, 1.0, 3.0, EdgeReason.NOT_LOOKED_AT),)

    docking = roomba.robot.dock()
    handle = wait_until(lambda: next(iter(mission.docks.goals), None), 30.0)
    handle.publish_feedback(DockFeedback("docking"))
    assert docking.next_feedback(30.0) == "docking"
    handle.set_aborted(DockResult(False, "no beam"), "no beam")
    docked = wait_until(docking.report, 30.0)
    assert (docked.outcome, docked.message) == (ErrandOutcome.FAULT, "no beam")

    mission.state.publish(state="docked", phase="charging", battery=0.75, message="hm")
    mission.rooms.publish(rooms=[Room(name=name) for name in rooms])
    assert (roomba.state.phase, roomba.state.battery) == ("charging", 0.75)
    assert roomba.robot.rooms() == rooms
    for name in ("pause", "resume", "stop", "locate", "empty_bin"):
        getattr(roomba.robot, name)()
    assert mission.orders == ["pause", "resume", "stop", "locate", "empty_bin"]
    roomba.robot.change_rooms(["Hall"])
    roomba.robot.change_rooms(["Küche"], [RoomWay(2, FanLevel.STRONG)])
    assert mission.orders[5:] == ["['Hall'] [] []", f"['Küche'] [2] [{CleanGoal.STRONG}]"]
    with pytest.raises(RequestRefusedError, match="1 to 5 passes"):
        roomba.robot.change_rooms(["Hall"], [RoomWay(0)])
    mission.refusal = "cannot pause now"
    with pytest.raises(RequestRefusedError, match="cannot pause now"):
        roomba.robot.change_rooms(["Hall"])
    with pytest.raises(RequestRefusedError, match="cannot pause now"):
        roomba.robot.pause()
    with pytest.raises(RequestRefusedError, match="1 to 5 passes"):
        roomba.robot.clean(passes=0)


def test_a_state_from_before_an_order_is_none_any_more(graph: RosGraph) -> None:
    roomba, mission = begin(graph)
    tell(mission, roomba, "cleaning")
    roomba.robot.pause()
    with pytest.raises(RobotUnavailableError):
        roomba.robot.vacuum(timeout=0.2)
    tell(mission, roomba, "paused")
    roomba.robot.pause()
    assert roomba.robot.vacuum(timeout=0.2).phase == "paused"
    roomba.robot.locate()
    assert roomba.robot.vacuum(timeout=0.2).phase == "paused"
    for order in (roomba.robot.resume, roomba.robot.stop):
        order()
        with pytest.raises(RobotUnavailableError):
            roomba.robot.vacuum(timeout=0.2)
        tell(mission, roomba, "cleaning")
    for phase in ("idle", "emergency stop"):
        tell(mission, roomba, phase)
        roomba.robot.stop()
        assert roomba.robot.vacuum(timeout=0.2).phase == phase
    tell(mission, roomba, "emergency stop", wanted=8.0)
    roomba.robot.stop()
    with pytest.raises(RobotUnavailableError):  # that clean is ended
        roomba.robot.vacuum(timeout=0.2)
    tell(mission, roomba, "emergency stop")
    assert roomba.robot.vacuum(timeout=0.2).wanted == 0.0


def test_a_mission_that_began_anew_or_is_silent_has_lost_the_clean(graph: RosGraph) -> None:
    roomba, mission = begin(graph)
    with pytest.raises(RobotUnavailableError, match="nothing came on vacuum/state"):
        roomba.robot.vacuum(timeout=0.1)
    first = roomba.robot.clean()
    handle = wait_until(lambda: next(iter(mission.cleans.goals), None), 30.0)
    handle.publish_feedback(CleanFeedback("cleaning", "", 1.0, 8.0, 0.125, 20.0, 0.5))
    wait_until(lambda: first.next_feedback(0.1), 30.0)
    with mission.cleans.lock:
        mission.cleans.status_list.clear()
    report = wait_until(first.report, 30.0)
    assert report.outcome is ErrandOutcome.DISCONNECTED
    assert "goes on by itself" in report.message
    assert (report.covered, report.wanted) == (1.0, 8.0)
    assert math.isnan(report.energy)

    second = roomba.robot.clean()
    wait_until(lambda: len(mission.cleans.goals) == 2, 30.0)
    mission.cleans.is_silent = True
    report = wait_until(second.report, 30.0)
    assert report.outcome is ErrandOutcome.DISCONNECTED
    assert "silent for 2.5 s" in report.message
    assert second.next_feedback(10.0) is None


def test_the_example_cleans_once_and_tells_what_came_of_it(graph: RosGraph) -> None:
    os.environ.update(graph.environment)
    rospy.init_node("mission_node", disable_signals=True)
    mission = FakeMission()
    program = graph.run(sys.executable, str(EXAMPLE))
    handle = wait_until(lambda: next(iter(mission.cleans.goals), None), 30.0)
    handle.publish_feedback(CleanFeedback("cleaning", "Hall", 2.0, 8.0, 0.25, 20.0, 0.5))
    program.says(" 25% cleaning Hall", 30.0)
    area = MissedArea(2.0, Point(), "", MissedArea.SHUT, "a door is shut")
    handle.set_succeeded(CleanResult(covered=6.0, wanted=8.0, duration=9.0, missed=[area]), "")
    assert program.ends(30.0) == 0
    assert "completed: 6.0 of 8.0 m2 are clean" in program.output
    assert "missed 2.00 m2 in no room: a door is shut" in program.output
