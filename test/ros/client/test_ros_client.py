"""A client's walks and its view of the robot, against a made-up robot of a few callbacks."""

from __future__ import annotations

import math
import os
import threading
from typing import Any

import actionlib
import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.waiting import wait_until
from geometry_msgs.msg import PoseStamped
from roomba_robot.msg import (
    RobotPosition,
    WalkToPointAction,
    WalkToPointFeedback,
    WalkToPointResult,
)
from std_msgs.msg import Float32

from roomba.client.protocol import RobotUnavailableError, WalkHandle, WalkOutcome, WalkReport
from roomba.geometry import Pose
from roomba_ros.client.roomba_client import RoombaClient
from roomba_ros.convert.common import pose_message


class Walks(actionlib.ActionServer):  # type: ignore[misc]
    """Accepts every goal, and leaves the rest to the test."""

    def __init__(self) -> None:
        self.is_silent = False
        self.goals: list[Any] = []
        self.cancels: list[Any] = []
        super().__init__(
            "walk_to_point", WalkToPointAction, self._on_goal, self.cancels.append, auto_start=False
        )
        self.start()

    def _on_goal(self, handle: Any) -> None:
        handle.set_accepted()
        self.goals.append(handle)

    def publish_status(self) -> None:
        if not self.is_silent:
            super().publish_status()


def begin(graph: RosGraph) -> tuple[RoombaClient, Walks]:
    os.environ.update(graph.environment)
    graph.set_param("/initial_post_x", 0.25)
    graph.set_param("/initial_post_y", 0.5)
    return RoombaClient.connect(), Walks()


def end_of(walk: WalkHandle) -> WalkReport:
    return wait_until(walk.report, 30.0, "its end")


def test_each_walk_of_a_client_has_an_end(graph: RosGraph) -> None:
    roomba, server = begin(graph)
    first = roomba.robot.walk_to(1.0, 0.0)
    wait_until(lambda: len(server.goals) == 1, 30.0)
    second = roomba.robot.walk_to(2.0, 0.0)
    wait_until(lambda: len(server.goals) == 2, 30.0)
    server.goals[1].publish_feedback(WalkToPointFeedback(1.5))
    assert wait_until(lambda: second.next_feedback(1.0), 30.0) == 1.5
    server.goals[0].set_canceled(WalkToPointResult(3.0), "a newer goal took over")
    ended = end_of(first)
    assert (ended.outcome, ended.duration) == (WalkOutcome.CANCELLED, 3.0)
    assert ended.message == "a newer goal took over"
    assert second.report() is None
    server.goals[1].set_succeeded(WalkToPointResult(5.0), "arrived")
    assert end_of(second).outcome is WalkOutcome.ARRIVED


def test_a_walk_that_was_given_up_failed_with_the_reason(graph: RosGraph) -> None:
    roomba, server = begin(graph)
    walk = roomba.robot.walk_to(1.0, 0.0)
    wait_until(lambda: server.goals, 30.0)
    server.goals[0].set_aborted(WalkToPointResult(3.0), "a wall")
    assert (end_of(walk).outcome, end_of(walk).message) == (WalkOutcome.FAILED, "a wall")


def test_a_walk_whose_server_falls_silent_is_cancelled(graph: RosGraph) -> None:
    roomba, server = begin(graph)
    walk = roomba.robot.walk_to(1.0, 0.0)
    wait_until(lambda: server.goals, 30.0)
    server.is_silent = True
    ended = end_of(walk)
    assert ended.outcome is WalkOutcome.DISCONNECTED
    assert ended.message == "the action server has been silent for 2.5 s"
    wait_until(lambda: server.cancels, 30.0, "its cancel")


def test_the_station_is_where_the_robot_says_that_it_is(graph: RosGraph) -> None:
    roomba, _ = begin(graph)
    assert roomba.robot.station() == (0.25, 0.5)
    told = rospy.Publisher("station_pose", PoseStamped, queue_size=1, latch=True)
    told.publish(pose_message(0.0, Pose(3.0, 4.0, 1.0), "map"))
    wait_until(lambda: roomba.robot.station() == (3.0, 4.0), 30.0)


def test_a_robot_that_senses_no_dirt_tells_its_place(graph: RosGraph) -> None:
    roomba, _ = begin(graph)
    told = rospy.Publisher("position", RobotPosition, queue_size=1)
    with pytest.raises(RobotUnavailableError, match="nothing came on position within"):
        roomba.robot.state(0.1)
    rospy.Timer(rospy.Duration(0.1), lambda _: told.publish(RobotPosition(1.0, 2.0)))
    state = roomba.robot.state(30.0)
    assert (state.x, state.y) == (1.0, 2.0)
    assert math.isnan(state.dirt)
    assert math.isnan(state.speed)


def test_what_a_robot_tells_a_little_after_its_place_is_waited_for(graph: RosGraph) -> None:
    roomba, _ = begin(graph)
    place = rospy.Publisher("position", RobotPosition, queue_size=1, latch=True)
    others = [
        rospy.Publisher(name, Float32, queue_size=1, latch=True) for name in ("speed", "dirt")
    ]
    place.publish(RobotPosition(1.0, 2.0))
    threading.Timer(0.3, lambda: [each.publish(0.25) for each in others]).start()
    state = roomba.robot.state(30.0)
    assert (state.x, state.speed, state.dirt) == (1.0, 0.25, 0.25)
