import math
import threading
import time

import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.processes import Program
from fixtures.waiting import wait_until
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from roomba_robot.msg import RobotPosition
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage


def odometry(x: float, y: float, theta: float = 0.0) -> Odometry:
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation.z = math.sin(theta / 2)
    message.pose.pose.orientation.w = math.cos(theta / 2)
    return message


def start(graph: RosGraph, x: float = 0.0, y: float = 0.0) -> tuple[Probe, Program]:
    graph.set_param("/initial_post_x", x)
    graph.set_param("/initial_post_y", y)
    node = graph.rosrun("position_pub_node.py")
    return Probe(graph), node


def roll(probe: Probe, start: float, end: float) -> None:
    """Let the wheels roll ahead at 2 m/s; a jump would be no motion."""
    for step in range(1, round((end - start) / 0.1) + 1):
        probe.send("/odom", odometry(start + 0.1 * step, 0.0))
        time.sleep(0.05)


def test_the_pose_is_where_odometry_began_and_the_way_since(graph: RosGraph) -> None:
    graph.set_param("/initial_post_theta", math.pi / 2)
    probe, _ = start(graph, 2.0, 1.0)
    probe.hear("/tf", TFMessage)
    probe.send("/odom", odometry(3.0, 0.0))
    message = probe.next("/position", RobotPosition)
    assert math.isclose(message.pos_x, 2.0, abs_tol=1e-5)
    assert math.isclose(message.pos_y, 4.0, abs_tol=1e-5)
    assert probe.next("/pose", PoseStamped).header.frame_id == "map"
    transform = probe.next("/tf", TFMessage).transforms[0]
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")


def test_a_single_wish_makes_it_drive_there_and_no_teleport(graph: RosGraph) -> None:
    probe, _ = start(graph)
    probe.hear("/cmd_vel", Twist)
    probe.send("/odom", odometry(0.0, 0.0))
    probe.next("/position", RobotPosition)
    probe.send("/change_position", RobotPosition(2.0, 0.0))
    wait_until(lambda: "/cmd_vel" in probe.newest, 2.0, "a command")
    # Carefully: without a map and a lidar it knows its place but roughly.
    assert 0.1 < probe.next("/cmd_vel", Twist).linear.x < 0.2
    assert probe.position() == (0.0, 0.0)


def test_having_arrived_it_leaves_the_drive_to_others(graph: RosGraph) -> None:
    probe, _ = start(graph)
    probe.hear("/cmd_vel", Twist)
    probe.send("/odom", odometry(0.0, 0.0))
    probe.next("/position", RobotPosition)
    probe.send("/change_position", RobotPosition(1.0, 0.0))
    wait_until(lambda: "/cmd_vel" in probe.newest, 2.0, "a command")
    roll(probe, 0.0, 1.0)
    wait_until(lambda: probe.newest["/cmd_vel"] == Twist(), 2.0, "it stops")
    time.sleep(1.0)
    before = probe.counts["/cmd_vel"]
    roll(probe, 1.0, 2.0)
    for _ in range(5):
        probe.next("/position", RobotPosition)
    assert probe.counts["/cmd_vel"] == before


def test_wishes_that_are_no_places_are_refused(graph: RosGraph) -> None:
    """FAULTS row 26: change_position NaN and 9999."""
    probe, node = start(graph)
    probe.hear("/cmd_vel", Twist)
    probe.send("/odom", odometry(0.0, 0.0))
    probe.next("/position", RobotPosition)
    for x, y in ((math.nan, 0.0), (9999.0, 0.0), (0.0, -math.inf), (0.0, 100.5)):
        probe.send("/change_position", RobotPosition(x, y))
    node.says("change_position refused", 3.0)
    probe.next("/position", RobotPosition)
    probe.next("/position", RobotPosition)
    assert "/cmd_vel" not in probe.newest


class FastClock:
    """Publishes /clock, five times as fast as real time, from ``now``, which may be set."""

    def __init__(self, probe: Probe, now: float) -> None:
        self.now = now
        self._publisher = probe.publisher("/clock", Clock)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            self.now += 0.05
            self._publisher.publish(rospy.Time.from_sec(self.now))
            time.sleep(0.01)


def test_it_goes_on_when_the_clock_jumps_back_and_far_ahead(graph: RosGraph) -> None:
    """FAULTS rows 15 and 16."""
    graph.set_param("/use_sim_time", True)
    probe, node = start(graph)
    clock = FastClock(probe, 1000.0)
    probe.send("/odom", odometry(1.0, 2.0))
    probe.next("/position", RobotPosition)
    for begin in (1500.0, 500.0, 4100.0, 10.0):
        clock.now = begin
        before = probe.counts["/position"]
        wait_until(
            lambda before=before: probe.counts["/position"] > before + 20,
            10.0,
            f"positions after the jump to {begin}",
        )
    assert node.status is None


def test_simulated_time_without_a_clock_is_a_clear_error(graph: RosGraph) -> None:
    """FAULTS row 17."""
    graph.set_param("/use_sim_time", True)
    node = graph.rosrun("position_pub_node.py")
    assert node.ends(20.0) == 1
    assert "/use_sim_time is true, but nothing published /clock" in node.output


def test_missing_parameters_have_their_defaults(graph: RosGraph) -> None:
    """FAULTS row 18."""
    graph.rosrun("position_pub_node.py")
    probe = Probe(graph)
    probe.send("/odom", odometry(0.5, 0.25))
    assert probe.next("/position", RobotPosition) == RobotPosition(0.5, 0.25)


def test_wrong_parameters_stop_it_with_one_clear_line(graph: RosGraph) -> None:
    """FAULTS row 19, and limits in the wrong order."""
    for name, value in (
        ("/robot_max_speed", -0.5),
        ("/robot_max_speed", 0),
        ("/robot_max_speed", "fast"),
        ("/max_cordinate", -200.0),
    ):
        before = {"/robot_max_speed": 0.5, "/max_cordinate": 100.0}[name]
        graph.set_param(name, value)
        node = graph.rosrun("position_pub_node.py")
        assert node.ends(10.0) == 1
        complaints = [line for line in node.output.splitlines() if line.strip()]
        assert len(complaints) == 1
        assert name.strip("/") in complaints[0]
        graph.set_param(name, before)
