import math
import threading
import time
from collections.abc import Iterator

import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.nodes.refusal import refusal
from fixtures.probe import Probe
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from roomba_robot.msg import RobotPosition
from roomba_robot.srv import EmergencyStop
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from roomba_ros.position.position_pub_node import main


def odometry(x: float, y: float, theta: float = 0.0) -> Odometry:
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation.z = math.sin(theta / 2)
    message.pose.pose.orientation.w = math.cos(theta / 2)
    return message


@pytest.fixture(scope="module")
def at_origin(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The node without any parameter, of a robot that has not moved yet."""
    with RosGraph(tmp_path_factory.mktemp("position")) as graph:
        graph.start_master()
        graph.rosrun("position_pub_node.py")
        yield graph


def body(graph: RosGraph) -> Probe:
    """Become the robot's body, as the tests before were."""
    return Probe(graph, "body", is_one_of_many=False)


def is_silent(probe: Probe, topic: str) -> bool:
    """Whether nothing comes on a topic while five positions do."""
    before = probe.counts[topic]
    for _ in range(5):
        probe.next("/position", RobotPosition)
    return probe.counts[topic] == before


def start(graph: RosGraph, x: float = 0.0, y: float = 0.0) -> tuple[Probe, Program]:
    graph.set_param("/initial_post_x", x)
    graph.set_param("/initial_post_y", y)
    node = graph.rosrun("position_pub_node.py")
    return Probe(graph), node


def roll(probe: Probe, start: float, end: float) -> None:
    """Let the wheels roll ahead at 2 m/s; a jump would be no motion."""
    for step in range(1, round((end - start) / 0.1) + 1):
        probe.send("/odom", odometry(start + 0.1 * step, 0.0))
        # Wheels tell how far they are at 20 Hz.
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


def test_the_emergency_stop_forgets_a_wish_and_takes_no_other(graph: RosGraph) -> None:
    probe, node = start(graph)
    graph.rosrun("speed_pub_node.py")
    stop = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    stop.wait_for_service(30.0)
    # Both nodes: told to the other one alone it would not know its place.
    probe.send("/odom", odometry(0.0, 0.0), receivers=2)
    # Before it knows its place it takes no wish.
    probe.next("/position", RobotPosition)
    probe.send("/change_position", RobotPosition(1.0, 0.0))
    wait_until(lambda: probe.next("/cmd_vel", Twist).linear.x > 0.0, 30.0, "it drives")
    assert stop(True, "a child came in").success
    wait_until(lambda: is_silent(probe, "/cmd_vel"), 30.0, "it wants to drive no more")
    probe.send("/change_position", RobotPosition(1.0, 0.0))
    wait_until(lambda: "release it, and tell it again" in node.output, 30.0, "it is refused")
    assert stop(False, "").success
    assert is_silent(probe, "/cmd_vel")
    probe.send("/change_position", RobotPosition(1.0, 0.0))
    wait_until(lambda: probe.next("/cmd_vel", Twist).linear.x > 0.0, 30.0, "it drives again")


def test_wishes_that_are_no_places_are_refused(at_origin: RosGraph) -> None:
    """A wish that is not finite, or outside the default limits, moves nothing and is logged."""
    probe, node = body(at_origin), at_origin.programs[-1]
    probe.hear("/cmd_vel", Twist)
    probe.send("/odom", odometry(0.0, 0.0))
    assert probe.position() == (0.0, 0.0)
    for x, y in ((math.nan, 0.0), (9999.0, 0.0), (0.0, -math.inf), (0.0, 100.5)):
        probe.send("/change_position", RobotPosition(x, y))
    node.says("change_position refused", 20.0)
    probe.next("/position", RobotPosition)
    probe.next("/position", RobotPosition)
    assert "/cmd_vel" not in probe.newest


def test_a_single_wish_makes_it_drive_there_and_no_teleport(at_origin: RosGraph) -> None:
    probe = body(at_origin)
    probe.hear("/cmd_vel", Twist)
    probe.send("/odom", odometry(0.0, 0.0))
    probe.next("/position", RobotPosition)
    probe.send("/change_position", RobotPosition(2.0, 0.0))
    wait_until(lambda: "/cmd_vel" in probe.newest, 20.0, "a command")
    # Carefully: without a map and a lidar it knows its place but roughly.
    assert 0.1 < probe.next("/cmd_vel", Twist).linear.x < 0.2
    assert probe.position() == (0.0, 0.0)


def test_having_arrived_it_leaves_the_drive_to_others(at_origin: RosGraph) -> None:
    probe = body(at_origin)
    probe.hear("/cmd_vel", Twist)
    probe.send("/odom", odometry(0.0, 0.0))
    probe.next("/position", RobotPosition)
    probe.send("/change_position", RobotPosition(1.0, 0.0))
    wait_until(lambda: "/cmd_vel" in probe.newest, 20.0, "a command")
    roll(probe, 0.0, 1.0)
    wait_until(lambda: probe.newest["/cmd_vel"] == Twist(), 20.0, "it stops")
    wait_until(lambda: is_silent(probe, "/cmd_vel"), 20.0, "it leaves the drive")
    before = probe.counts["/cmd_vel"]
    roll(probe, 1.0, 2.0)
    for _ in range(5):
        probe.next("/position", RobotPosition)
    assert probe.counts["/cmd_vel"] == before


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


def wait_for_positions(probe: Probe, number: int, when: str) -> None:
    wanted = probe.counts["/position"] + number
    wait_until(lambda: probe.counts["/position"] >= wanted, 30.0, f"positions {when}")


def test_it_goes_on_when_the_clock_jumps_back_and_far_ahead(graph: RosGraph) -> None:
    """Positions go on after the clock was set back, and after it was set far ahead."""
    graph.set_param("/use_sim_time", True)
    probe, node = start(graph)
    clock = FastClock(probe, 1000.0)
    probe.send("/odom", odometry(1.0, 2.0))
    probe.next("/position", RobotPosition)
    for begin in (1500.0, 500.0, 4100.0, 10.0):
        clock.now = begin
        wait_for_positions(probe, 21, f"after the jump to {begin}")
    assert node.status is None


def test_simulated_time_without_a_clock_is_a_clear_error(
    graph: RosGraph, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """A node that waits for a clock that does not come ends, and says what is missing."""
    graph.set_param("/use_sim_time", True)
    monkeypatch.setattr("roomba_ros.runtime.node.CLOCK_DEADLINE", 0.5)
    said = refusal(main, graph, capfd)
    assert "/use_sim_time is true, but nothing published /clock within 0.5 s" in said


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("/robot_max_speed", -0.5),
        ("/robot_max_speed", 0),
        ("/robot_max_speed", "fast"),
        ("/max_cordinate", -200.0),
    ],
)
def test_a_wrong_parameter_stops_it_with_one_clear_line(
    master: RosGraph, name: str, value: object, capfd: pytest.CaptureFixture[str]
) -> None:
    """A limit that is no positive number, or limits in the wrong order, are named."""
    master.set_param(name, value)
    try:
        assert name.strip("/") in refusal(main, master, capfd)
    finally:
        master.delete_param(name)
