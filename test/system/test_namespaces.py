"""Two robots side by side, each in a namespace of its own."""

import math

import pytest
from fixtures.graph import LAUNCHED, RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from roomba_robot.msg import RobotPosition


@pytest.mark.thorough
def test_a_second_robot_drives_while_the_first_stands(robot: RosGraph) -> None:
    robot.run(
        "roslaunch",
        *("-p", str(robot.port)),
        *("roomba_robot", "roomba_robot.launch", "clock:=false", "initial_post_x:=1.0"),
        environment={"ROS_NAMESPACE": "second"},
    )
    second = {f"/second/{name}" for name in LAUNCHED}
    wait_until(lambda: second <= nodes(robot), 40.0, "the second robot's nodes")
    assert robot.system_state()[0]["/clock"] == ["/home_sim_node"]
    wait_until(lambda: "/second/turn_camera" in robot.system_state()[2], 30.0, "its camera")
    probe = Probe(robot)
    first = probe.position()
    start = probe.next("/second/position", RobotPosition, deadline=20.0)
    assert (start.pos_x, start.pos_y) == pytest.approx((1.0, 0.0), abs=0.03)
    probe.send("/second/change_position", RobotPosition(1.0, 0.7))
    wait_until(lambda: math.dist(at(probe), (1.0, 0.7)) < 0.05, 30.0, "the second is there")
    assert probe.position() == pytest.approx(first, abs=0.03)


def nodes(graph: RosGraph) -> set[str]:
    return {node for nodes in graph.system_state()[0].values() for node in nodes}


def at(probe: Probe) -> tuple[float, float]:
    message = probe.next("/second/position", RobotPosition)
    return message.pos_x, message.pos_y
