import math
import time

import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import Bumper
from roomba_robot.srv import SpillDirt, TurnCamera
from std_msgs.msg import Float32

SCRIPT = "home_sim_node.py"


def start(graph: RosGraph, *arguments: str) -> Probe:
    graph.set_param("/use_sim_time", True)
    graph.rosrun(SCRIPT, *arguments)
    wait_until(lambda: "/clock" in graph.system_state()[0], 30.0, "the simulation runs")
    return Probe(graph)


def forward(speed: float) -> Twist:
    message = Twist()
    message.linear.x = speed
    return message


@pytest.mark.parametrize(
    ("parameter", "value", "said"),
    [
        ("/robot_max_speed", -0.5, "robot_max_speed"),
        ("/robot_max_speed", "fast", "robot_max_speed"),
        ("/max_cordinate", -500.0, "min_cordinate"),
        ("/home_sim_node/home", "no_such_home", "no_such_home"),
        ("/home_sim_node/speed", 0, "speed"),
        ("/home_sim_node/seed", -3, "seed"),
        ("/initial_post_x", 77.0, "does not fit"),
    ],
)
def test_a_wrong_parameter_ends_it_with_one_clear_line(
    graph: RosGraph, parameter: str, value: object, said: str
) -> None:
    """FAULTS rows 18 and 19."""
    graph.set_param(parameter, value)
    node = graph.rosrun(SCRIPT)
    assert node.ends(20.0) == 1
    lines = [line for line in node.output.splitlines() if line.strip()]
    assert len(lines) == 1
    assert said in lines[0]


def test_the_body_drives_and_a_command_that_is_not_repeated_stops_it(graph: RosGraph) -> None:
    probe = start(graph, "_home:=empty")
    for _ in range(20):
        probe.send("/cmd_vel_out", forward(-0.4))
        time.sleep(0.05)
    assert probe.next("/odom", Odometry).twist.twist.linear.x == pytest.approx(-0.4, abs=0.02)
    time.sleep(1.0)
    assert probe.next("/odom", Odometry).twist.twist.linear.x == 0.0
    assert probe.newest["/odom"].pose.pose.position.x < -0.2


def test_what_cannot_be_driven_is_refused(graph: RosGraph) -> None:
    probe = start(graph, "_home:=empty")
    probe.send("/cmd_vel_out", forward(math.nan))
    time.sleep(0.3)
    assert probe.next("/odom", Odometry).pose.pose.position.x == 0.0


def test_it_puts_the_robot_at_the_homes_station_and_says_where(graph: RosGraph) -> None:
    probe = start(graph, "_home:=apartment")
    assert graph.param("/initial_post_x") == pytest.approx(0.3)
    assert graph.param("/initial_post_y") == pytest.approx(5.0)
    assert graph.param("/initial_post_theta") == pytest.approx(math.pi)
    known = probe.next("/map", OccupancyGrid)
    assert (known.info.width, known.info.height) == (204, 204)


def test_the_bumper_is_told(graph: RosGraph) -> None:
    probe = start(graph, "_home:=empty")
    for _ in range(60):
        probe.send("/cmd_vel_out", forward(0.4))
        time.sleep(0.03)
        if "/bumper" in probe.newest and probe.newest["/bumper"].is_left_pressed:
            break
        probe.hear("/bumper", Bumper)
    assert probe.newest["/bumper"].is_left_pressed
    assert probe.newest["/bumper"].is_right_pressed


def test_crumbs_can_be_spilled_and_are_felt(graph: RosGraph) -> None:
    probe = start(graph)
    spill = rospy.ServiceProxy("/sim/spill", SpillDirt)
    spill.wait_for_service(10.0)
    before = probe.next("/dirt_raw", Float32).data
    assert spill(0.0, 0.0, 0.05, 7.0).success
    wait_until(lambda: probe.next("/dirt_raw", Float32).data > before + 5.0, 5.0)
    refused = spill(1000.0, 0.0, 0.05, 7.0)
    assert not refused.success
    assert "no floor" in refused.message


def test_pictures_are_taken_at_any_angle_that_the_camera_can_turn_to(graph: RosGraph) -> None:
    start(graph)
    capture = rospy.ServiceProxy("/camera/capture", TurnCamera)
    capture.wait_for_service(10.0)
    left, right = capture(20.0).image, capture(-20.0).image
    assert (left.width, left.height, left.encoding) == (1024, 768, "rgb8")
    assert left.data != right.data
    for wrong in (31.0, math.nan):
        with pytest.raises(rospy.ServiceException, match="expected an angle from -30 to 30"):
            capture(wrong)


def test_the_clock_moves_by_whole_steps_only(graph: RosGraph) -> None:
    """Time passes by the simulation's steps, not by the wall clock."""
    probe = start(graph, "_speed:=4")
    first = rospy.get_rostime()
    probe.next("/odom", Odometry)
    passed = rospy.get_rostime() - first
    assert passed.to_nsec() > 0
    assert passed.to_nsec() % 50_000_000 == 0
