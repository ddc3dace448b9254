"""Faults of a running robot: nodes that end, are killed, or get nonsense."""

import math
import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import LAUNCHED, RosGraph
from fixtures.nodes.ended_drives import ENDS
from fixtures.probe import Probe, Walker
from fixtures.processes.forked import run_forked
from fixtures.processes.programs import is_running
from fixtures.waiting import promised, wait_until
from nav_msgs.msg import Odometry
from roomba_robot.msg import RobotPosition

SERVER = "walk_to_point_action_server_node"
FAST = 5.0
"""Robot seconds per second, where nothing is stopped by surprise."""
BACK = 5.0
"""s of wall time; by then a node that was killed is back."""
ENDED = 3.0
"""s of wall time; by then nothing is left after Ctrl-C."""


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot, twice as fast as real time; nodes that were ended are back after a test."""
    with RosGraph(tmp_path_factory.mktemp("robot")) as own:
        own.launch("speed:=2")
        yield own


class LongWalk:
    """A walk from where the robot is to the farther of two ends, at full speed by now."""

    def __init__(self, graph: RosGraph) -> None:
        self.probe, self.walker = Probe(graph), Walker()
        self.goal = max(ENDS, key=self.left_to)
        self.walker.send(*self.goal)
        wait_until(lambda: self.probe.speed() > 0.45, 15.0, "full speed")

    def left_to(self, place: tuple[float, float]) -> float:
        """Return how far it is from there, m."""
        return math.dist(self.probe.position(), place)

    @property
    def left(self) -> float:
        """How far it is from the goal, m."""
        return self.left_to(self.goal)


def is_back(graph: RosGraph, node: str, old: int) -> None:
    promised(lambda: graph.answers(node) and graph.pid(node) != old, BACK, f"a new {node}")


def stands(probe: Probe) -> None:
    """Wait until it stands."""
    wait_until(
        lambda: abs(probe.next("/odom", Odometry).twist.twist.linear.x) < 1e-3, 20.0, "it stands"
    )


# Those with a graph of their own come first: a robot that others share would work all the while.


@pytest.mark.thorough
def test_at_a_faster_clock_a_killed_server_walks_again_and_ctrl_c_ends_it_without_violence(
    tmp_path: Path,
) -> None:
    """The walk after that is like any other: as quick, and to its goal. Ctrl-C comes while it
    walks: each node ends by itself, and none has to be killed.
    """
    with RosGraph(tmp_path) as graph:
        launch = graph.launch(f"speed:={FAST}")
        run_forked(lambda: walk_again(graph))
        run_forked(lambda: walk_fast(graph))
        pids = [graph.pid(node) for node in LAUNCHED]
        launch.send_to_leader(signal.SIGINT)
        promised(lambda: launch.status is not None, ENDED, "it has ended")
        assert not [pid for pid in pids if is_running(pid)]
        assert launch.status == 0
        assert "has not ended yet" not in launch.output


def walk_fast(graph: RosGraph) -> None:
    """Walk from the farthest corner to the station; begin to walk back."""
    probe = Probe(graph)
    walker = Walker()
    probe.position()
    begin, robot_begin = time.monotonic(), rospy.get_time()
    walker.send(0.0, 0.0)
    walker.arrives(40.0)
    assert 10.0 <= walker.time_spent < 15.0
    # A busy machine may be slower than asked for.
    passed = (rospy.get_time() - robot_begin) / (time.monotonic() - begin)
    assert passed < 1.3 * FAST
    assert passed > 1.0 or "too slow for speed" in graph.programs[0].output
    walker.send(3.0, 4.0)
    wait_until(lambda: probe.speed() > 0.45, 15.0, "full speed")


def walk_again(graph: RosGraph) -> None:
    """Walk, kill the server on the way, and walk to the same goal by the one that came back."""
    walk = LongWalk(graph)
    old = graph.signal(SERVER, signal.SIGKILL)
    stands(walk.probe)
    is_back(graph, SERVER, old)
    assert walk.walker.ends(30.0) in (GoalStatus.LOST, GoalStatus.ABORTED)
    left = walk.left
    assert left > 1.0
    walk.walker.send(*walk.goal)
    walk.walker.arrives(40.0)
    assert walk.left < 0.05
    # At 0.5 m/s, with what turns and the start take.
    assert walk.walker.time_spent < 2.0 * left + 6.0


def test_a_wrong_argument_ends_the_launch_with_a_clear_line(tmp_path: Path) -> None:
    """A negative top speed; test_home_sim_node.py goes through the arguments."""
    with RosGraph(tmp_path) as graph:
        program = graph.start_run("robot_max_speed:=-0.5")
        assert program.ends(40.0) == 1
        fatal = [line for line in program.output.splitlines() if "FATAL" in line]
        assert any("robot_max_speed" in line for line in fatal), program.output


def test_a_killed_server_stops_the_robot_and_its_goal_ends(shared_robot: RosGraph) -> None:
    """The walk has an outcome, and the server comes back and walks again.

    How soon it stands: test_standstill.py.
    """
    walk = LongWalk(shared_robot)
    old = shared_robot.pid(SERVER)
    os.kill(old, signal.SIGKILL)
    stands(walk.probe)
    is_back(shared_robot, SERVER, old)
    assert walk.left > 1.0
    noticed = "the sender of change_position vanished"
    wait_until(lambda: noticed in shared_robot.programs[0].output, 10.0, "it was noticed, no luck")
    assert walk.walker.ends(30.0) in (GoalStatus.LOST, GoalStatus.ABORTED)
    again = Walker()
    again.send(1.2, 1.6)
    again.arrives(40.0)


def test_a_server_told_to_end_ends_and_the_robot_stops(shared_robot: RosGraph) -> None:
    """SIGINT or SIGTERM in the middle of a walk: the walk has an outcome, nothing drives on."""
    for number in (signal.SIGINT, signal.SIGTERM):
        walk = LongWalk(shared_robot)
        pid = shared_robot.signal(SERVER, number)
        wait_until_ended(pid)
        stands(walk.probe)
        assert walk.left > 1.0
        assert walk.walker.ends(30.0) in (GoalStatus.ABORTED, GoalStatus.LOST)
        is_back(shared_robot, SERVER, pid)


def wait_until_ended(pid: int) -> None:
    wait_until(lambda: not is_running(pid), 10.0, "the server ends")


def test_a_killed_position_node_keeps_the_pose(shared_robot: RosGraph) -> None:
    """It comes back where the robot is, not at the origin."""
    probe, walker = Probe(shared_robot), Walker()
    walker.send(1.2, 1.6)
    walker.arrives(40.0)
    before = probe.position()
    old = shared_robot.signal("position_pub_node", signal.SIGKILL)
    is_back(shared_robot, "position_pub_node", old)
    after = probe.next("/position", RobotPosition, deadline=30.0)
    assert math.dist((after.pos_x, after.pos_y), before) < 0.05


def test_a_walk_outlives_the_position_node(shared_robot: RosGraph) -> None:
    """The node comes back with the pose, and the walk goes on to its goal."""
    walk = LongWalk(shared_robot)
    shared_robot.signal("position_pub_node", signal.SIGKILL)
    walk.walker.arrives(40.0)
    assert walk.left < 0.05


@pytest.mark.parametrize("bad", [-9.0, 0.0, "fast"])
def test_a_bad_top_speed_changes_nothing(shared_robot: RosGraph, bad: object) -> None:
    """The parameter of a running robot is put back to its old value, and walks go on."""
    probe = Probe(shared_robot)
    shared_robot.set_param("/robot_max_speed", bad)
    wait_until(lambda: shared_robot.param("/robot_max_speed") == 0.5, 10.0, "it is put back")
    walker = Walker()
    x, y = probe.position()
    walker.send(0.5 * x, 0.5 * y)
    walker.arrives(40.0)
