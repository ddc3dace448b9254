"""A real robot on ROS: its driver node, with a made-up Neato at the other end of the line."""

from __future__ import annotations

import math
import signal
import sys
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from roomba_robot.msg import (
    BodyState,
    Bumper,
    Cliff,
    DockStatus,
    HazardDetectionVector,
    LineTrouble,
    VacuumState,
    WheelDrop,
)
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import String, UInt16

from roomba.drivers.line import SerialLine
from roomba_ros.convert.readings import body_of

NODE = "/roomba_driver_node"
AHEAD = Twist()
AHEAD.linear.x = 0.1


def emulated(graph: RosGraph, tmp_path: Path) -> tuple[Program, Path]:
    """Start a made-up Neato; return it, and its line."""
    link = tmp_path / "neato"
    command = (
        sys.executable,
        "-m",
        "roomba.commands.program",
        "emulate",
        "neato",
        "--link",
        str(link),
    )
    program = graph.run(*command)
    wait_until(link.exists, 60.0, "the made-up robot")
    return program, link


def driven(graph: RosGraph, link: Path) -> Program:
    """Start the node over a line; any node may drive it."""
    graph.set_param("/robot_config", "neato")
    arguments = ("_robot:=neato", f"_port:={link}", "_drive_owner:=any")
    program = graph.rosrun("roomba_driver_node.py", *arguments)
    wait_until(lambda: "/odom" in graph.system_state()[0], 60.0, "the robot is taken over")
    return program


def state_of(link: Path) -> str:
    """Return what the robot answers when it is asked for its state."""
    line = SerialLine(str(link), 115_200)
    line.write(b"GetState\n")
    answer = b""
    while not answer.endswith(b"\x1a"):
        came = line.read(5.0)
        assert came
        answer += came
    line.close()
    return answer.decode()


def test_it_tells_what_the_simulated_body_tells_and_drives(graph: RosGraph, tmp_path: Path) -> None:
    _, link = emulated(graph, tmp_path)
    node = driven(graph, link)
    probe = Probe(graph)
    assert probe.next("/dock_status", DockStatus).is_docked
    battery = probe.next("/battery_state", BatteryState)
    assert 0.0 <= battery.percentage <= 1.0
    assert battery.power_supply_status != BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    scan = probe.next("/scan", LaserScan)
    assert len(scan.ranges) == 360
    assert scan.header.frame_id == "laser"
    assert probe.next("/odom", Odometry).header.stamp.to_sec() - scan.header.stamp.to_sec() > 0.0
    assert sum(map(math.isfinite, scan.ranges)) > 100
    assert not probe.next("/bumper", Bumper).is_left_pressed
    body = body_of(probe.next("/body", BodyState), 1.0)
    assert (body.battery.is_docked, body.bumps, body.turning) == (True, False, None)
    assert body.battery.level == pytest.approx(battery.percentage, abs=0.02)
    assert not probe.next("/cliff", Cliff).is_cliff_left
    assert not probe.next("/wheel_drop", WheelDrop).is_left_dropped
    assert probe.next("/hazard_detection", HazardDetectionVector).detections == []
    assert probe.next("/ir_omni", UInt16).data == 0

    def drives() -> bool:
        probe.publisher("/cmd_vel_out", Twist).publish(AHEAD)
        return bool(probe.next("/odom", Odometry).pose.pose.position.x > 0.1)

    wait_until(drives, 30.0, "it drives")
    wait_until(lambda: probe.next("/odom", Odometry).twist.twist == Twist(), 10.0, "it stands")
    probe.send("/emergency_stop", String("held"))
    before = probe.next("/odom", Odometry).pose.pose.position.x
    for _ in range(20):
        probe.publisher("/cmd_vel_out", Twist).publish(AHEAD)
        after = probe.next("/odom", Odometry).pose.pose.position.x
    assert after == pytest.approx(before, abs=0.002)
    probe.send("/emergency_stop", String(""))
    node.send(signal.SIGINT)
    wait_until(lambda: node.status == 0, 20.0, lambda: f"it ends: {node.status}\n{node.output}")
    assert "STANDBY" in state_of(link)


def test_a_line_that_is_gone_is_told(graph: RosGraph, tmp_path: Path) -> None:
    robot, link = emulated(graph, tmp_path)
    node = driven(graph, link)
    probe = Probe(graph)
    probe.hear("/line_trouble", LineTrouble)
    robot.send(signal.SIGINT)
    wait_until(lambda: "/line_trouble" in probe.newest, 30.0, "it is told")
    assert "Plug its line in" in probe.newest["/line_trouble"].message
    assert probe.newest["/line_trouble"].hindrance == VacuumState.UNREACHABLE

    def is_told() -> bool:
        parts = probe.next("/diagnostics", DiagnosticArray).status
        return any(part.level == DiagnosticStatus.ERROR and "line" in part.name for part in parts)

    wait_until(is_told, 20.0, "its diagnostics")
    emulated(graph, tmp_path)
    wait_until(lambda: probe.newest["/line_trouble"].message == "", 30.0, "it goes on by itself")
    probe.next("/odom", Odometry)
    assert node.status is None


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("_robot:=toaster", "_port:=/dev/null"), "expected one of create2, neato, openneato"),
        (("_robot:=neato", "_port:=''"), "expected a device such as /dev/ttyACM0"),
        (("_robot:=neato", "_port:=/dev/ttyNone"), "Is it plugged in and switched on"),
    ],
)
def test_what_cannot_be_ends_it_with_one_clear_line(
    master: RosGraph, arguments: tuple[str, ...], said: str
) -> None:
    node = master.rosrun("roomba_driver_node.py", *arguments)
    wait_until(lambda: node.status is not None, 60.0, "it ends")
    assert node.status == 1
    assert said in node.output
    assert "Traceback" not in node.output
