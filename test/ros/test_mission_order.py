"""In which order the mission node tells things; no graph is needed for that."""

from dataclasses import replace
from unittest.mock import MagicMock

import pytest
from actionlib_msgs.msg import GoalID, GoalStatus
from fixtures.missions import HOME
from roomba_robot.msg import CleanGoal, DockGoal

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Battery, Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Event
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba_ros.mission.goals import CleaningGoal, DockingGoal, MissionGoal
from roomba_ros.mission.mission_node import MissionNode
from roomba_ros.mission.orders import MissionOrders, _Cancel, _Order
from roomba_ros.mission.topics import MissionTopics

CONFIG, MISSION_CONFIG = RobotConfig(), MissionConfig()
SITE = PlanningContext(HOME.map, HOME.station, CONFIG, MISSION_CONFIG, DockingConfig())
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


class Rig:
    """A mission node whose senses are made by hand, and what it tells, in its order."""

    def __init__(self) -> None:
        self.senses = AWAY
        self.world = MagicMock()
        self.node = MissionNode()
        self.node._newer = None
        self.node._mission = Mission(
            SITE,
            CONFIG,
            MISSION_CONFIG,
            DockingConfig(),
            ThingLayer(SurfaceField.of(HOME.map)),
            DirtMap(HOME.map),
            AWAY,
        )
        self.node._orders = self.orders = MissionOrders(lambda: None)
        self.orders._servers = []
        self.node._topics = MissionTopics(MISSION_CONFIG, MagicMock())
        self.node._topics._state = self.world.state
        self.node._topics._plan = self.node._topics._coverage = self.node._topics._dirt = MagicMock(
            get_num_connections=lambda: 0
        )
        self.node._drive = MagicMock(is_taken=False)
        self.node._site = MagicMock(take=lambda: None, is_changing=False)
        self.node._senses = MagicMock(at=lambda now: self.senses)
        self.node._memory, self.node._things = MagicMock(), MagicMock()
        self.node._finished = 0.0
        self.world.handle.get_goal_id.return_value = GoalID(id="1")
        self.world.handle.get_goal_status.return_value = GoalStatus(status=GoalStatus.PENDING)

    def tick(self) -> list[str]:
        """Tick once; return what was told, and the phase of each state that was."""
        self.world.mock_calls.clear()
        self.senses = replace(self.senses, now=self.senses.now + 0.05)
        self.node.tick(self.senses.now)
        return [
            call.args[0].phase if call[0] == "state.publish" else TELLS[call[0]]
            for call in self.world.mock_calls
            if call[0] in TELLS
        ]

    def ask(self, kind: type[MissionGoal], goal: object) -> list[str]:
        self.world.handle.get_goal.return_value = goal
        self.orders._asked.append(kind(self.world.handle))
        return self.tick()

    def order(self, event: Event) -> list[str]:
        self.orders._asked.append(_Order(event, self.world.answer))
        return self.tick()


def test_a_state_is_told_before_the_answer_to_the_order_that_led_to_it() -> None:
    rig = Rig()
    assert rig.ask(DockingGoal, DockGoal()) == ["accepted", "returning", "feedback"]
    assert rig.order(Event.PAUSE) == ["paused", "feedback", "answer"]
    assert rig.world.answer.put.call_args.args == ((True, "paused"),)
    assert rig.order(Event.RESUME) == ["returning", "feedback", "answer"]
    assert rig.order(Event.STOP) == ["idle", "canceled", "answer"]
    assert rig.order(Event.PAUSE) == ["answer"]
    assert rig.world.answer.put.call_args.args == ((False, "cannot pause now: the robot is idle"),)


def test_a_state_is_told_before_the_result_of_a_goal_that_was_cancelled() -> None:
    rig = Rig()
    rig.ask(CleaningGoal, CleanGoal())
    rig.orders._asked.append(_Cancel(("clean", "1")))
    assert rig.tick() == ["idle", "canceled"]


def test_a_state_is_told_before_the_result_of_a_goal_that_a_newer_one_took_over() -> None:
    rig = Rig()
    rig.ask(CleaningGoal, CleanGoal())
    assert rig.ask(DockingGoal, DockGoal()) == ["accepted", "returning", "feedback", "canceled"]


@pytest.mark.parametrize("emergency", [False, True])
def test_a_state_is_told_before_the_result_of_a_goal_that_ended(emergency: bool) -> None:
    rig = Rig()
    rig.ask(DockingGoal, DockGoal())
    if emergency:
        rig.orders._on_emergency_stop("a child")
        assert rig.tick() == ["emergency stop", "feedback", "aborted"]
    else:
        rig.senses = replace(rig.senses, battery=Battery(1.0, 26.0, is_docked=True))
        assert rig.tick() == ["docked", "feedback", "succeeded"]


def test_the_clean_floor_is_counted_once_for_a_state(monkeypatch: pytest.MonkeyPatch) -> None:
    rig, areas = Rig(), iter((1.0, 1.5, 2.0))
    monkeypatch.setattr(Cleaning, "clean_area", property(lambda _: next(areas)))
    rig.ask(CleaningGoal, CleanGoal())
    told = [call.args[0] for call in rig.world.state.publish.call_args_list]
    assert [state.covered for state in told] == [1.0, 1.5][: len(told)]
    assert all(state.fraction == state.covered / state.wanted for state in told)
