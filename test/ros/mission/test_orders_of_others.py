"""Orders of other programs interrupt a clean only as long as these programs want them.

The nodes are ticked in lockstep; no graph is needed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from actionlib_msgs.msg import GoalID, GoalStatus
from fixtures.nodes.node_compositions import NodeRobot, started
from fixtures.robots.compositions import Case
from fixtures.robots.missions import HOME
from geometry_msgs.msg import Twist
from roomba_robot.msg import CleanActionGoal, RobotPosition, WalkToPointActionGoal
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Float32

from roomba.mission.walking.walk import Walk
from roomba_ros.walking import plan_service

CORNER = (0.0, 0.0)
"""m; in the wall, as a message of nothing wants it."""


class Watched:
    """A robot that cleans, and what is said of it."""

    def __init__(self, robot: NodeRobot) -> None:
        self.robot = robot
        self.commands: list[Twist] = []
        robot.lockstep.hear("/cmd_vel", self.commands.append)

    def clean(self) -> None:
        """Tell it to clean, and wait until it does."""
        self.robot.lockstep.publish("/clean/goal", CleanActionGoal())
        self.until(lambda: self.phase == "cleaning", 60.0)

    def lets_pass(self, seconds: float) -> None:
        """Let time pass, s of its clock."""
        ends = self.robot.world.time + seconds
        while self.robot.world.time < ends:
            self.robot.tick()

    def until(self, holds: Callable[[], bool], seconds: float) -> None:
        """Let time pass until something is so."""
        ends = self.robot.world.time + seconds
        while not holds():
            assert self.robot.world.time < ends, (self.phase, self.message)
            self.robot.tick()

    @property
    def phase(self) -> str:
        """What it does."""
        return str(self.robot.states[-1].phase) if self.robot.states else ""

    @property
    def message(self) -> str:
        """Why it does not go on."""
        return str(self.robot.states[-1].message)

    def goes_on(self) -> None:
        """Wait until more of the floor is clean."""
        before = self.robot.states[-1].covered
        self.until(lambda: self.robot.states[-1].covered > before + 0.2, 60.0)
        assert self.phase == "cleaning"


@pytest.fixture
def watched(tmp_path: Path) -> Iterator[Watched]:
    with started(Case(HOME, sensors="ideal"), tmp_path) as robot:
        found = Watched(robot)
        # Then goals are taken.
        found.lets_pass(1.0)
        yield found


def test_a_wish_for_a_place_in_a_wall_is_given_up(watched: Watched) -> None:
    watched.clean()
    watched.robot.lockstep.publish("/change_position", RobotPosition(*CORNER), "/other")
    watched.until(lambda: watched.phase == "paused", 10.0)
    assert "driven by hand or by another program" in watched.message
    # There, and then as long as it is tried.
    watched.lets_pass(30.0)
    assert min(watched.robot.world.pose.x, watched.robot.world.pose.y) < 0.2
    watched.commands.clear()
    watched.lets_pass(3.0)
    assert watched.commands == []
    assert any("change_position is given up" in line for line in watched.robot.lockstep.logged)
    watched.clean()
    watched.goes_on()


def test_a_wish_to_stand_pauses_a_clean_and_says_so(watched: Watched) -> None:
    watched.clean()
    watched.robot.lockstep.publish("/change_speed", Float32(0.0), "/other")
    watched.until(lambda: watched.phase == "paused", 10.0)
    assert "change_speed 0" in watched.message
    watched.lets_pass(60.0)
    assert watched.phase == "paused"
    watched.robot.lockstep.publish("/change_speed", Float32(0.5), "/other")
    watched.clean()
    watched.goes_on()


def test_another_program_that_steers_it_to_stand_pauses_a_clean_and_says_so(
    watched: Watched,
) -> None:
    watched.clean()
    for _ in range(60):
        watched.robot.lockstep.publish("/cmd_vel", Twist(), "/other")
        watched.robot.tick()
    assert watched.phase == "paused"
    assert "driven by hand or by another program" in watched.message
    watched.lets_pass(2.0)
    watched.clean()
    watched.goes_on()


def test_empty_messages_of_another_node_do_not_empty_the_battery(watched: Watched) -> None:
    watched.clean()
    for _ in range(100):
        for _ in range(5):
            watched.robot.lockstep.publish("/battery_state", BatteryState(), "/other")
        watched.robot.tick()
    assert {state.phase for state in watched.robot.states[-5:]} == {"cleaning"}
    watched.goes_on()


def test_of_many_walks_at_once_the_newest_possible_one_alone_is_planned(
    watched: Watched, monkeypatch: pytest.MonkeyPatch
) -> None:
    planned: list[tuple[float, float]] = []

    def plan(*arguments: Any) -> Walk:
        planned.append(arguments[3])
        return Walk(*arguments)

    monkeypatch.setattr(plan_service, "Walk", plan)
    ended: dict[str, tuple[int, str]] = {}
    watched.robot.lockstep.hear(
        "/walk_to_point/result",
        lambda told: ended.update({told.status.goal_id.id: (told.status.status, told.status.text)}),
    )
    places = [*((0.4 + 0.01 * number, 0.6) for number in range(100)), (99.0, 99.0)]
    for number, place in enumerate(places):
        order = WalkToPointActionGoal(goal_id=GoalID(id=f"{number}"))
        order.goal.destin.dest_x, order.goal.destin.dest_y = place
        watched.robot.lockstep.publish("/walk_to_point/goal", order)
    watched.robot.tick()
    assert planned == [places[-1], places[-2]]
    assert ended.pop("100")[0] == GoalStatus.REJECTED
    assert set(ended.values()) == {(GoalStatus.RECALLED, "a newer goal took over")}
    assert len(ended) == 99
    watched.until(lambda: "99" in ended, 60.0)
    assert ended["99"][0] == GoalStatus.SUCCEEDED
