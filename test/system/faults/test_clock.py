"""The robot's clock is set back, forward and back again while the robot cleans."""

import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from roomba_robot.msg import CleanAction, CleanGoal, UndockAction, VacuumState
from rosgraph_msgs.msg import Clock

from roomba_ros.runtime.action_client import ActionClient

ACTIONS = ("walk_to_point", "move_base", "clean", "dock", "undock", "explore")
PERIOD = 0.05
"""s between two messages of the clock."""
SPEED = 3.0
"""Robot seconds per second."""
HOUR = 3600.0


class OwnClock:
    """Publishes a clock that can be set."""

    def __init__(self) -> None:
        self._publisher = rospy.Publisher("/clock", Clock, queue_size=1, tcp_nodelay=True)
        self.now = 10_000.0
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            time.sleep(PERIOD / SPEED)
            self.now += PERIOD
            self._publisher.publish(rospy.Time.from_sec(self.now))


@pytest.fixture
def own(tmp_path: Path) -> Iterator[RosGraph]:
    """A robot that goes by another program's clock."""
    with RosGraph(tmp_path) as graph:
        graph.start_master()
        yield graph


def tells_states(probe: Probe) -> None:
    """Wait until the states of the goals of all actions were told several times."""
    before = dict(probe.counts)
    topics = [f"/{action}/status" for action in ACTIONS]
    wait_until(
        lambda: all(probe.counts[topic] > before[topic] + 5 for topic in topics),
        5.0,
        lambda: f"states of all actions: {probe.counts}, not {before}",
    )


def is_told(probe: Probe, clock: OwnClock) -> bool:
    """Whether the newest state is of the time that the clock shows."""
    stamp = probe.newest["/vacuum/state"].header.stamp.to_sec()
    return bool(abs(stamp - clock.now) < 2.0 * SPEED)


def goes_on(probe: Probe) -> None:
    """Wait until more is clean than was at the call."""
    before = probe.newest["/vacuum/state"].covered
    wait_until(
        lambda: probe.newest["/vacuum/state"].covered > before + 0.02,
        60.0,
        lambda: f"it cleans: {probe.newest['/vacuum/state']}",
    )


def test_a_clock_that_is_set_ends_nothing(own: RosGraph, tmp_path: Path) -> None:
    own.set_param("/use_sim_time", True)
    probe, clock = Probe(own), OwnClock()
    own.start_run(f"home:={tiny_home(tmp_path)}", "clock:=false")
    wait_until(own.all_up, START_DEADLINE, lambda: own.programs[-1].output)
    probe.hear("/vacuum/state", VacuumState)
    for action in ACTIONS:
        probe.hear(f"/{action}/status", GoalStatusArray)

    def state() -> VacuumState:
        return probe.newest.get("/vacuum/state", VacuumState())

    wait_until(lambda: state().phase == "docked", 60.0, lambda: f"{state()}")
    clean = ActionClient("clean", CleanAction)
    wait_until(lambda: clean.wait_for_server(rospy.Duration(0.01)), 30.0, "the server")
    clean.send_goal(CleanGoal())
    wait_until(lambda: state().phase == "cleaning", 60.0, lambda: f"{state()}")
    pids = {node: own.pid(node) for node in ("mission_node", "walk_to_point_action_server_node")}
    for jump in (-10.0, HOUR, -HOUR):
        clock.now += jump
        wait_until(lambda: is_told(probe, clock), 30.0, "the mission goes by that")
        tells_states(probe)
        goes_on(probe)
        assert clean.get_state() == GoalStatus.ACTIVE
    clean.cancel_goal()
    wait_until(lambda: clean.simple_state == 2, 30.0, "the goal ends")
    assert clean.get_state() == GoalStatus.PREEMPTED
    assert {node: own.pid(node) for node in pids} == pids
    # And a goal that comes now is served.
    undock = ActionClient("undock", UndockAction)
    assert undock.wait_for_server(rospy.Duration(10.0))
