"""What must not go wrong, done to a running robot. Row numbers are those of the fault list."""

import math
import os
import signal
import time
from pathlib import Path

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.forked import run_forked
from fixtures.graph import LAUNCHED, RosGraph
from fixtures.probe import Probe, Walker
from fixtures.waiting import seconds_until, wait_until
from nav_msgs.msg import Odometry
from roomba_robot.msg import RobotPosition

SERVER = "walk_to_point_action_server_node"


def walking(graph: RosGraph) -> tuple[Probe, Walker]:
    probe = Probe(graph)
    walker = Walker()
    walker.send(3.0, 4.0)
    wait_until(lambda: probe.speed() > 0.45, 15.0, "full speed")
    return probe, walker


def is_new(graph: RosGraph, node: str, old: int) -> bool:
    return graph.answers(node) and graph.pid(node) != old


def standing(probe: Probe) -> bool:
    return abs(probe.next("/odom", Odometry).twist.twist.linear.x) < 1e-3


def test_a_killed_server_stops_the_robot_at_once_and_its_goal_ends(robot: RosGraph) -> None:
    """Row 10; and the server is back and walks again."""
    probe, walker = walking(robot)
    old = robot.signal(SERVER, signal.SIGKILL)
    assert seconds_until(lambda: standing(probe), 5.0, "it stands") < 1.0
    noticed = "the sender of change_position vanished"
    wait_until(lambda: noticed in robot.programs[0].output, 3.0, "it was noticed, and no luck")
    assert walker.ends(15.0) in (GoalStatus.LOST, GoalStatus.ABORTED)
    wait_until(lambda: is_new(robot, SERVER, old), 15.0, "a new server")
    again = Walker()
    again.send(0.0, 0.0)
    assert again.ends(40.0) == GoalStatus.SUCCEEDED


def test_a_server_told_to_end_ends_in_time_and_the_robot_stops(robot: RosGraph) -> None:
    """Row 9."""
    probe, walker = walking(robot)
    for number in (signal.SIGINT, signal.SIGTERM):
        pid = robot.signal(SERVER, number)
        assert seconds_until(lambda pid=pid: not alive(pid), 10.0, "the server ends") < 2.0
        wait_until(lambda: standing(probe), 3.0, "it stands")
        if number is signal.SIGINT:
            assert walker.ends(5.0) in (GoalStatus.ABORTED, GoalStatus.LOST)
            wait_until(lambda pid=pid: is_new(robot, SERVER, pid), 15.0, "a new server")
            again = Walker()
            again.send(3.0, 4.0)
            wait_until(lambda: probe.speed() > 0.3, 15.0, "it walks")


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    # A process that ended but was not waited for yet is no more.
    with open(f"/proc/{pid}/stat") as stat:
        return stat.read().rsplit(")", 1)[1].split()[0] != "Z"


def test_a_killed_position_node_keeps_the_pose(robot: RosGraph) -> None:
    """Row 11."""
    probe = Probe(robot)
    walker = Walker()
    walker.send(1.2, 1.6)
    assert walker.ends(20.0) == GoalStatus.SUCCEEDED
    before = probe.position()
    old = robot.signal("position_pub_node", signal.SIGKILL)
    wait_until(lambda: is_new(robot, "position_pub_node", old), 15.0, "a new node")
    after = probe.next("/position", RobotPosition, deadline=15.0)
    assert math.dist((after.pos_x, after.pos_y), before) < 0.01


def test_a_walk_outlives_the_position_node(robot: RosGraph) -> None:
    """Row 11: the node comes back with the pose, and the walk goes on to its goal."""
    probe, walker = walking(robot)
    robot.signal("position_pub_node", signal.SIGKILL)
    assert walker.ends(40.0) == GoalStatus.SUCCEEDED
    assert math.dist(probe.position(), (3.0, 4.0)) < 0.05


@pytest.mark.parametrize("bad", [-9.0, 0.0, "fast"])
def test_a_bad_top_speed_changes_nothing(shared_robot: RosGraph, bad: object) -> None:
    """Row 28."""
    Probe(shared_robot)
    shared_robot.set_param("/robot_max_speed", bad)
    wait_until(lambda: shared_robot.param("/robot_max_speed") == 0.5, 3.0, "it is put back")
    walker = Walker()
    walker.send(0.4, 0.2)
    assert walker.ends(20.0) == GoalStatus.SUCCEEDED


def test_ctrl_c_ends_everything_in_time_without_violence(tmp_path: Path) -> None:
    """Row 9 for the whole stack: nothing is left after 3 s, and roslaunch had to kill nobody."""
    with RosGraph(tmp_path) as graph:
        launch = graph.launch()
        run_forked(lambda: walking(graph))
        pids = [graph.pid(node) for node in LAUNCHED]
        begin = time.monotonic()
        launch.send_to_leader(signal.SIGINT)
        launch.ends(15.0)
        took = time.monotonic() - begin
        assert not [pid for pid in pids if alive(pid)]
        assert took < 3.0
        assert "escalating" not in launch.output


def test_a_wrong_argument_ends_the_launch_with_a_clear_line(tmp_path: Path) -> None:
    """Rows 18 and 19; test_home_sim_node.py goes through the arguments."""
    with RosGraph(tmp_path) as graph:
        program = graph.start_launch("robot_max_speed:=-0.5")
        program.ends(40.0)
        fatal = [line for line in program.output.splitlines() if "FATAL" in line]
        assert any("robot_max_speed" in line for line in fatal), program.output


def test_a_faster_clock_runs_the_same_graph(tmp_path_factory: pytest.TempPathFactory) -> None:
    with RosGraph(tmp_path_factory.mktemp("fast")) as graph:
        graph.launch("speed:=5")
        run_forked(lambda: walk_fast(graph))


def walk_fast(graph: RosGraph) -> None:
    Probe(graph)
    walker = Walker()
    begin, robot_begin = time.monotonic(), rospy.get_time()
    walker.send(3.0, 4.0)
    assert walker.ends(20.0) == GoalStatus.SUCCEEDED
    assert 10.0 <= walker.time_spent < 15.0
    passed = (rospy.get_time() - robot_begin) / (time.monotonic() - begin)
    assert passed == pytest.approx(5.0, rel=0.2)
