"""Cleaning with the whole robot, in a tiny home and on a fast clock: from one goal to the dock."""

import math
import signal
from collections.abc import Iterator

import actionlib
import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.tiny_home import DOORWAY, FAR_ROOM, STATION, tiny_home
from fixtures.waiting import seconds_until, wait_until
from geometry_msgs.msg import Point, PoseStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import (
    CleanAction,
    CleanFeedback,
    CleanGoal,
    CleanResult,
    DockAction,
    DockGoal,
    DockResult,
    MissedArea,
    Rectangle,
    VacuumState,
)
from roomba_robot.srv import EmergencyStop, InjectFault, InjectFaultRequest
from sensor_msgs.msg import BatteryState
from std_srvs.srv import Trigger

MISSION = "mission_node"
SPEED = 10
DOCKED = "docked"
HALF_A_ROOM = Rectangle(1.0, 0.0, 1.6, 1.4)
AT_ONCE = 0.5
"""s of wall time."""
ONE_CLEAN = 40.0
"""s of wall time, by which it is over on a busy machine, too."""


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot in two tiny rooms, ten times as fast as real time."""
    folder = tmp_path_factory.mktemp("robot")
    with RosGraph(folder) as own:
        own.launch(f"home:={tiny_home(folder)}", f"speed:={SPEED}")
        yield own


class Order:
    """A goal of an action, and what is told of it."""

    def __init__(self, name: str, action: type, goal: object) -> None:
        self.feedback: list[CleanFeedback] = []
        self._client = actionlib.SimpleActionClient(name, action)
        wait_until(
            lambda: self._client.wait_for_server(rospy.Duration(0.01)), 15.0, f"who serves {name}"
        )
        self._client.send_goal(goal, feedback_cb=self.feedback.append)

    def ends(self, deadline: float) -> tuple[int, CleanResult]:
        """Wait for the end; return its status and result."""
        wait_until(lambda: self._client.simple_state == 2, deadline, "the goal ends")
        return int(self._client.get_state()), self._client.get_result()


class Vacuum:
    """The robot on its station, full and with nothing in its way; what it tells, and hands."""

    def __init__(self, graph: RosGraph) -> None:
        self.graph = graph
        self.probe = Probe(graph)
        self.phases: list[str] = []
        rospy.Subscriber("/vacuum/state", VacuumState, self._on_state)
        self.probe.hear("/odom", Odometry)
        self.probe.hear("/battery_state", BatteryState)
        self._inject = rospy.ServiceProxy("/sim/inject_fault", InjectFault)
        self.inject("no_obstacles")
        self.inject("charge", 1.0)
        self.until(lambda: self.state.state == "docked", 20.0, "it stands on its station")
        self.phases.clear()

    def _on_state(self, message: VacuumState) -> None:
        self.state = message
        if self.phases[-1:] != [message.phase]:
            self.phases.append(message.phase)
