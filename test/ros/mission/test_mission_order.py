"""The order in which the mission node publishes; without a graph."""

from __future__ import annotations

import sys
from dataclasses import replace
from itertools import count
from types import FrameType
from typing import TYPE_CHECKING
from unittest.mock import MagicMock

import pytest
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus
from fixtures.robots.missions import HOME
from roomba_robot.msg import CleanGoal, DockGoal, VacuumState

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.nodes import DeadlinesConfig, PeriodsConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.cleaning.ledger import CoverageLedger
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Battery, Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Event
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.vocabulary import FanLevel, Phase, RoomWay
from roomba_ros.convert.client import vacuum_of
from roomba_ros.mission.asked import Cancel, CommandOrder, GoalOrder, RoomsOrder
from roomba_ros.mission.goals import CleaningGoal, DockingGoal, MissionGoal
from roomba_ros.mission.orders import MissionOrders
from roomba_ros.mission.round import MissionRound
from roomba_ros.mission.topics import MissionTopics
from roomba_ros.runtime.action_goal import GoalIdentity

if TYPE_CHECKING:
    from _typeshed import TraceFunction

CONFIG, MISSION_CONFIG = RobotConfig(), MissionConfig()
CONTEXT = PlanningContext(HOME.map, HOME.station, CONFIG, MISSION_CONFIG, DockingConfig())
AWAY = Senses(0.0, Pose(1.0, 0.6, 0.0))
TELLS = {
    "state.publish": "state",
    "answer.put": "answer",
    "handle.set_accepted": "accepted",
    "handle.publish_feedback": "feedback",
    "handle.set_succeeded": "succeeded",
    "handle.set_canceled": "canceled",
    "handle.set_aborted": "aborted",
}


class Publisher:
    """A publisher without a graph: states go to the rig, and nothing else has a subscriber."""

    state = MagicMock()

    def __init__(self, topic: str, kind: type, **_: object) -> None:
        self.name, self._is_state = topic, kind is VacuumState

    def publish(self, message: object) -> None:
        if self._is_state:
            self.state.publish(message)

    @staticmethod
    def get_num_connections() -> int:
        return 0


class Rig:
    """A mission between its orders and its topics, and what it tells, in its order."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.senses = AWAY
        self.world = MagicMock()
        self.mission = Mission(
            CONTEXT,
            CONFIG,
            MISSION_CONFIG,
            DockingConfig(),
            ThingLayer(SurfaceField.of(HOME.map)),
            DirtMap(HOME.map),
            AWAY,
        )
        self.orders = MissionOrders(lambda: None, DeadlinesConfig())
        monkeypatch.setattr(Publisher, "state", self.world.state)
        monkeypatch.setattr(rospy, "Publisher", Publisher)
        monkeypatch.setattr(rospy, "Subscriber", MagicMock())
        topics = MissionTopics(MISSION_CONFIG, PeriodsConfig(), MagicMock(trouble=""))
        topics.start()
        drive = MagicMock(taken_by="")
        self.round = MissionRound(self.orders, topics, drive, Mission.tick)
        self.world.handle.get_goal_id.return_value = GoalID(id="1")
        self.world.handle.get_goal_status.return_value = GoalStatus(status=GoalStatus.PENDING)

    def tick(self, *, begins: bool = True) -> list[str]:
        """Tick once; return what was told, and the phase of each state that was."""
        self.world.mock_calls.clear()
        self.senses = replace(self.senses, now=self.senses.now + 0.05)
        self.round.tick(self.senses.now, self.mission, self.senses, begins=begins)
        return [
            call.args[0].phase if call[0] == "state.publish" else TELLS[call[0]]
            for call in self.world.mock_calls
            if call[0] in TELLS
        ]

    def ask(self, kind: type[MissionGoal], goal: object) -> list[str]:
        self.world.handle.get_goal.return_value = goal
        asked = kind(self.world.handle)
        asked.check()
        self.orders.ask(GoalOrder(asked))
        return self.tick()

    def order(self, event: Event) -> list[str]:
        self.orders.ask(CommandOrder(event, self.world.answer))
        return self.tick()


def test_a_state_is_told_before_the_answer_to_the_order_that_led_to_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = Rig(monkeypatch)
    assert rig.ask(DockingGoal, DockGoal()) == ["accepted", "returning", "feedback"]
    assert rig.order(Event.PAUSE) == ["paused", "feedback", "answer"]
    assert rig.world.answer.put.call_args.args == ((True, "paused"),)
    assert rig.order(Event.RESUME) == ["returning", "feedback", "answer"]
    assert rig.order(Event.STOP) == ["idle", "canceled", "answer"]
    assert rig.order(Event.PAUSE) == ["answer"]
    assert rig.world.answer.put.call_args.args == ((False, "cannot pause now: the robot is idle"),)


def test_a_goal_waits_for_zones_that_were_changed_and_no_order_waits_for_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = Rig(monkeypatch)
    rig.ask(DockingGoal, DockGoal())
    rig.order(Event.PAUSE)
    rig.world.handle.get_goal.return_value = DockGoal()
    rig.orders.ask(GoalOrder(DockingGoal(rig.world.handle)))
    rig.orders.ask(CommandOrder(Event.RESUME, rig.world.answer))
    assert rig.tick(begins=False) == ["returning", "feedback", "answer"]
    assert "accepted" not in rig.tick(begins=False)
    assert "accepted" in rig.tick()


@pytest.mark.parametrize(("event", "said"), [(Event.STOP, "stopped"), (Event.PAUSE, "paused")])
@pytest.mark.parametrize("is_idle", [True, False])
def test_a_goal_that_waits_does_not_begin_after_an_order_to_stand(
    monkeypatch: pytest.MonkeyPatch, event: Event, said: str, is_idle: bool
) -> None:
    rig = Rig(monkeypatch)
    if not is_idle:
        rig.ask(DockingGoal, DockGoal())
    rig.world.handle.get_goal.return_value = CleanGoal()
    rig.orders.ask(GoalOrder(CleaningGoal(rig.world.handle)))
    rig.orders.ask(CommandOrder(event, rig.world.answer))
    assert {"canceled", "answer"} <= set(rig.tick(begins=False))
    assert rig.world.answer.put.call_args.args == ((True, said),)
    assert "accepted" not in rig.tick()


def test_a_goal_that_comes_after_a_stop_waits_on(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = Rig(monkeypatch)
    rig.world.handle.get_goal.return_value = DockGoal()
    rig.orders.ask(CommandOrder(Event.STOP, rig.world.answer))
    rig.orders.ask(GoalOrder(DockingGoal(rig.world.handle)))
    rig.tick(begins=False)
    assert "accepted" in rig.tick()


def test_other_rooms_are_told_in_the_state_before_the_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = Rig(monkeypatch)
    rig.orders.ask(RoomsOrder(("hall",), (), rig.world.answer))
    assert rig.tick() == ["idle", "answer"]
    is_obeyed, why = rig.world.answer.put.call_args.args[0]
    assert (is_obeyed, "got none" in why) == (False, True)
    changed = MagicMock()
    monkeypatch.setattr(Mission, "change_rooms", changed)
    monkeypatch.setattr(Mission, "queue", property(lambda _: ("hall",)))
    ways = (RoomWay(2, FanLevel.QUIET),)
    monkeypatch.setattr(Mission, "queue_ways", property(lambda _: ways))
    rig.orders.ask(RoomsOrder(("hall",), (RoomWay(2),), rig.world.answer))
    assert rig.tick() == ["idle", "answer"]
    told = vacuum_of(rig.world.state.publish.call_args.args[0])
    assert (told.queue, told.queue_ways) == (("hall",), ways)
    assert changed.call_args.args == (("hall",), (RoomWay(2),))
    assert rig.world.answer.put.call_args.args == ((True, "it goes on with hall"),)


def test_a_state_is_told_before_the_result_of_a_goal_that_was_cancelled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = Rig(monkeypatch)
    rig.ask(CleaningGoal, CleanGoal())
    rig.orders.ask(Cancel(GoalIdentity("clean", "1", 0, 0)))
    assert rig.tick() == ["idle", "canceled"]


def test_a_state_is_told_before_the_result_of_a_goal_that_a_newer_one_took_over(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = Rig(monkeypatch)
    rig.ask(CleaningGoal, CleanGoal())
    assert rig.ask(DockingGoal, DockGoal()) == ["accepted", "returning", "feedback", "canceled"]


@pytest.mark.parametrize("emergency", [False, True])
def test_a_state_is_told_before_the_result_of_a_goal_that_ended(
    monkeypatch: pytest.MonkeyPatch, emergency: bool
) -> None:
    rig = Rig(monkeypatch)
    rig.ask(DockingGoal, DockGoal())
    if emergency:
        rig.orders.hold("a child")
        assert rig.tick() == ["emergency stop", "feedback", "aborted"]
    else:
        rig.senses = replace(rig.senses, battery=Battery(1.0, 26.0, is_docked=True))
        assert rig.tick() == ["docked", "feedback", "succeeded"]


def test_a_clean_that_is_held_lasts_until_it_is_cancelled(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = Rig(monkeypatch)
    rig.ask(CleaningGoal, CleanGoal())
    rig.orders.hold("a child")
    assert rig.tick() == ["emergency stop", "feedback"]
    rig.orders.ask(Cancel(GoalIdentity("clean", "1", 0, 0)))
    assert rig.tick() == ["emergency stop", "canceled"]
    assert rig.mission.message == "a child"
    rig.orders.hold("")
    assert rig.tick() == ["idle"]


def test_a_clean_that_was_held_is_paused_also_if_that_was_between_two_ticks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = Rig(monkeypatch)
    rig.ask(CleaningGoal, CleanGoal())
    rig.orders.hold("a child")
    rig.orders.hold("")
    assert rig.tick() == ["paused", "feedback"]
    assert rig.order(Event.RESUME)[0] == "cleaning"


def released_amid_a_tick(rig: Rig, at: int) -> bool:
    """Release the stop, with a tick before its instruction of that number; whether it has one."""
    left = at

    def trace(frame: FrameType, event: str, _: object) -> TraceFunction | None:
        nonlocal left
        if frame.f_code is not MissionOrders.hold.__code__:
            return None
        frame.f_trace_opcodes = True
        if event == "opcode":
            if left == 0:
                rig.tick()
            left -= 1
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        rig.orders.hold("")
    finally:
        sys.settrace(before)
    return left < 0


def test_a_release_amid_a_tick_does_not_engage_it_again(monkeypatch: pytest.MonkeyPatch) -> None:
    were_released = []
    for at in count():
        rig = Rig(monkeypatch)
        rig.ask(CleaningGoal, CleanGoal())
        rig.orders.hold("a child")
        rig.orders.ask(CommandOrder(Event.RESUME, rig.world.answer))
        if not released_amid_a_tick(rig, at):
            break
        was_released = rig.mission.state.phase is Phase.CLEANING
        rig.tick()
        assert rig.mission.state.phase is (Phase.CLEANING if was_released else Phase.PAUSED), at
        were_released.append(was_released)
    assert were_released[0] is False
    assert were_released[-1] is True


def test_the_clean_floor_is_counted_once_for_a_state(monkeypatch: pytest.MonkeyPatch) -> None:
    rig, areas = Rig(monkeypatch), iter((1.0, 1.5, 2.0))
    monkeypatch.setattr(CoverageLedger, "clean_area", property(lambda _: next(areas)))
    rig.ask(CleaningGoal, CleanGoal())
    told = [call.args[0] for call in rig.world.state.publish.call_args_list]
    assert [state.covered for state in told] == [1.0, 1.5]
    assert all(state.fraction == state.covered / state.wanted for state in told)
