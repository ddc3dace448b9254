"""The contract of the original robot (docs/ros_interface.md), held by the running graph."""

import subprocess
from pathlib import Path
from typing import Any

import pytest
import rospy
from fixtures.graph import RUN, RosGraph
from fixtures.probe import Probe, Walker
from fixtures.waiting import wait_until
from roomba_robot.msg import PositionAndDestination, RobotPosition, WalkToPointAction
from roomba_robot.srv import TurnCamera
from std_msgs.msg import Float32

ROOT = Path(__file__).parents[2]

MD5 = {
    RobotPosition: "2178591bb5b4f72502724261422523b6",
    PositionAndDestination: "9c290bcd1e8f07bfd24d9381e72e1011",
    TurnCamera: "d2bd6d55eaa6b367037dff843fa7a83c",
    WalkToPointAction: "b29e061a6202e3214456dee7af3eeed8",
}

PUBLISHES = {
    "/dirt": "dirt_pub_node",
    "/speed": "speed_pub_node",
    "/cmd_vel_out": "speed_pub_node",
    "/position": "position_pub_node",
    "/cmd_vel": "position_pub_node",
    "/change_position": "walk_to_point_action_server_node",
    "/change_speed": "walk_to_point_action_server_node",
    "/walk_to_point/feedback": "walk_to_point_action_server_node",
    "/walk_to_point/result": "walk_to_point_action_server_node",
    "/walk_to_point/status": "walk_to_point_action_server_node",
    "/clock": "home_sim_node",
    "/odom": "home_sim_node",
    "/map": "home_sim_node",
    "/bumper": "home_sim_node",
}

SUBSCRIBES = {
    "/change_speed": "speed_pub_node",
    "/cmd_vel": "speed_pub_node",
    "/change_position": "position_pub_node",
    "/odom": "position_pub_node",
    "/walk_to_point/goal": "walk_to_point_action_server_node",
    "/walk_to_point/cancel": "walk_to_point_action_server_node",
    "/cmd_vel_out": "home_sim_node",
}

MENU_SENDS = {"/walk_to_point/goal", "/walk_to_point/cancel"}
MENU_HEARS = {
    "/dirt",
    "/position",
    "/speed",
    "/walk_to_point/feedback",
    "/walk_to_point/result",
    "/walk_to_point/status",
}

TYPES = {
    "/dirt": "std_msgs/Float32",
    "/speed": "std_msgs/Float32",
    "/position": "roomba_robot/RobotPosition",
    "/change_position": "roomba_robot/RobotPosition",
    "/change_speed": "std_msgs/Float32",
    "/walk_to_point/goal": "roomba_robot/WalkToPointActionGoal",
    "/cmd_vel": "geometry_msgs/Twist",
    "/odom": "nav_msgs/Odometry",
    "/map": "nav_msgs/OccupancyGrid",
}

PARAMETERS = {
    "/robot_name": "roomba_robot",
    "/robot_max_speed": 0.5,
    "/initial_post_x": 0.0,
    "/initial_post_y": 0.0,
    "/min_cordinate": -100.0,
    "/max_cordinate": 100.0,
}


def tool(graph: RosGraph, *command: str, deadline: float = 60.0) -> str:
    done = subprocess.run(
        command, env=graph.environment, capture_output=True, text=True, timeout=deadline, check=True
    )
    return done.stdout


@pytest.mark.parametrize("kind", MD5)
def test_interfaces_are_byte_compatible(kind: Any) -> None:
    """Nodes compare these sums when they connect."""
    assert kind._md5sum == MD5[kind]


def test_nodes_topics_and_services_are_those_of_the_report(shared_robot: RosGraph) -> None:
    publishers, subscribers, services = shared_robot.system_state()
    for topic, node in PUBLISHES.items():
        assert publishers.get(topic) == [f"/{node}"], topic
    for topic, node in SUBSCRIBES.items():
        assert f"/{node}" in subscribers.get(topic, []), topic
    for node in RUN:
        assert services[f"/{node}/get_loggers"] == [f"/{node}"]
        assert services[f"/{node}/set_logger_level"] == [f"/{node}"]
    assert services["/turn_camera"] == ["/turn_camera_service_node"]


def test_the_menu_speaks_and_hears_as_in_the_report(shared_robot: RosGraph) -> None:
    menu = shared_robot.rosrun("control_node.py")
    menu.says("Select: ", 30.0)
    publishers, subscribers, _ = shared_robot.system_state()
    assert {
        topic for topic in MENU_SENDS if "/control_node" in publishers.get(topic, [])
    } == MENU_SENDS
    assert {
        topic for topic in MENU_HEARS if "/control_node" in subscribers.get(topic, [])
    } == MENU_HEARS
    menu.end_of_input()
    assert menu.ends(20.0) == 0


def test_the_picture_client_has_the_reports_name(shared_robot: RosGraph) -> None:
    client = shared_robot.rosrun("turn_camera_client.py")
    client.says("Enter the angle: ", 30.0)
    assert "/turn_camera_client_node" in tool(shared_robot, "rosnode", "list").split()
    client.type("q")
    assert client.ends(20.0) == 0


def test_every_topic_has_one_writer(shared_robot: RosGraph) -> None:
    publishers, _, _ = shared_robot.system_state()
    shared = {topic: nodes for topic, nodes in publishers.items() if len(nodes) > 1}
    # Every node logs, and each of two publishes one part of the tree of frames.
    assert shared.pop("/rosout")
    assert sorted(shared.pop("/tf")) == ["/home_sim_node", "/position_pub_node"]
    # Each tells what it drives; only one of them drives at a time.
    assert sorted(shared.pop("/plan")) == ["/mission_node", "/walk_to_point_action_server_node"]
    # By REP 107 each part tells its own state there.
    assert sorted(shared.pop("/diagnostics")) == sorted(f"/{node}" for node in RUN)
    assert shared == {}


def test_the_stock_tools_agree(shared_robot: RosGraph) -> None:
    assert {f"/{node}" for node in RUN} <= set(tool(shared_robot, "rosnode", "list").split())
    info = tool(shared_robot, "rosnode", "info", "/walk_to_point_action_server_node")
    for line in (
        " * /change_position [roomba_robot/RobotPosition]",
        " * /change_speed [std_msgs/Float32]",
        " * /walk_to_point/feedback [roomba_robot/WalkToPointActionFeedback]",
        " * /walk_to_point/goal",
    ):
        assert line in info
    topics = tool(shared_robot, "rostopic", "list", "--verbose")
    for topic, kind in TYPES.items():
        assert f" * {topic} [{kind}] " in topics
    service = tool(shared_robot, "rosservice", "info", "/turn_camera").splitlines()
    assert "Node: /turn_camera_service_node" in service
    assert "Type: roomba_robot/TurnCamera" in service


def test_parameters_have_the_reports_values(shared_robot: RosGraph) -> None:
    for name, value in PARAMETERS.items():
        assert shared_robot.param(name) == value, name


def have_rates(probe: Probe, rates: dict[str, float], window: float) -> None:
    """See that so many messages a second come; ``window`` in s, of the robot's clock as both.

    A busy machine lets some be left out, but not in each window.
    """
    heard: list[dict[str, float]] = []

    def are_right() -> bool:
        begin, counts = rospy.get_time(), dict(probe.counts)
        wait_until(lambda: rospy.get_time() >= begin + window, 60.0, "time passes")
        passed = rospy.get_time() - begin
        heard.append({topic: (probe.counts[topic] - counts[topic]) / passed for topic in rates})
        return heard[-1] == pytest.approx(rates, rel=0.1)

    wait_until(are_right, 20.0, lambda: f"{rates} a second, but {heard}")


def test_rates_are_the_reports_by_the_robots_clock(shared_robot: RosGraph) -> None:
    probe = Probe(shared_robot)
    for topic, kind in (("/dirt", Float32), ("/speed", Float32), ("/position", RobotPosition)):
        probe.next(topic, kind)
    have_rates(probe, {"/dirt": 5.0, "/speed": 10.0, "/position": 10.0}, 4.0)


def test_change_topics_stream_at_20_hz_while_it_walks(shared_robot: RosGraph) -> None:
    probe = Probe(shared_robot)
    probe.hear("/change_position", RobotPosition)
    probe.hear("/change_speed", Float32)
    walker = Walker()
    walker.send(1.5, 2.0)
    probe.next("/change_position", RobotPosition)
    have_rates(probe, {"/change_position": 20.0, "/change_speed": 20.0}, 1.0)
    walker.cancel()
    walker.ends(5.0)


def test_pictures_come_by_the_reports_service(shared_robot: RosGraph) -> None:
    Probe(shared_robot)
    service = rospy.ServiceProxy("/turn_camera", TurnCamera)
    sizes = set()
    for wish in (-30.0, -15.0, 0.0, 15.0, 30.0, 7.0):
        image = service(wish).image
        sizes.add((image.width, image.height, image.encoding, len(set(image.data)) > 30))
    assert sizes == {(1024, 768, "rgb8", True)}
