"""Every sensor of the simulated robot, as its running node tells it, and every fault."""

import io
import math
import re
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from PIL import Image as Picture
from roomba_robot.msg import (
    Bumper,
    Cliff,
    DockStatus,
    HazardDetection,
    HazardDetectionVector,
    WheelDrop,
)
from roomba_robot.srv import InjectFault, InjectFaultRequest, InjectFaultResponse
from sensor_msgs.msg import (
    BatteryState,
    CameraInfo,
    CompressedImage,
    Image,
    Imu,
    JointState,
    LaserScan,
)
from std_msgs.msg import Float32, UInt16
from tf2_msgs.msg import TFMessage

from roomba.world.layer import load_home
from roomba.world.lidar import Lidar
from roomba_ros.parameters import package_folder

DESCRIPTION = (package_folder() / "srv" / "InjectFault.srv").read_text(encoding="utf-8")


class Robot:
    """The node, a probe, and the hands of who meddles with it."""

    def __init__(self, graph: RosGraph, *arguments: str) -> None:
        graph.set_param("/use_sim_time", True)
        self.node = graph.rosrun("home_sim_node.py", *arguments)
        wait_until(lambda: "/sim/inject_fault" in graph.system_state()[2], 30.0, "the simulation")
        self.probe = Probe(graph)
        self._fault = rospy.ServiceProxy("/sim/inject_fault", InjectFault)

    def inject(self, fault: str, value: float = 1.0, **where: float) -> InjectFaultResponse:
        return self._fault(InjectFaultRequest(fault=fault, value=value, **where))

    def drive(self, linear: float, angular: float, seconds: float) -> None:
        message = Twist()
        message.linear.x, message.angular.z = linear, angular
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            self.probe.send("/cmd_vel_out", message)
            time.sleep(0.05)

    def turn_on(self) -> None:
        """Turn on the spot from now on, until the test ends."""
        publisher = self.probe.publisher("/cmd_vel_out", Twist)
        message = Twist()
        message.angular.z = 1.0
        rospy.Timer(rospy.Duration(0.1), lambda _: publisher.publish(message))

    def until(self, topic: str, kind: type, holds: Callable[[Any], bool]) -> Any:
        """Return the first message from now on for which ``holds``."""
        wait_until(lambda: holds(self.probe.next(topic, kind)), 10.0, f"{topic} as expected")
        return self.probe.newest[topic]

    def hazards(self) -> set[int]:
        message = self.probe.next("/hazard_detection", HazardDetectionVector)
        return {hazard.type for hazard in message.detections}


def test_each_sensor_tells_in_the_messages_of_its_kind(graph: RosGraph) -> None:
    robot = Robot(graph, "_home:=apartment", "_sensors:=ideal")
    probe = robot.probe
    scan = probe.next("/scan", LaserScan)
    home = load_home("apartment", package_folder() / "homes")
    station = home.station
    exact = Lidar.of(home).scan(np.array([[station.x, station.y, station.theta]]))[0]
    assert np.array(scan.ranges, np.float32) == pytest.approx(exact)
    assert scan.header.frame_id == "laser"
    assert scan.angle_min + 359 * scan.angle_increment == pytest.approx(scan.angle_max, abs=1e-5)
    assert (scan.range_min, scan.range_max) == pytest.approx((0.15, 12.0))
    assert scan.scan_time == pytest.approx(0.1)
    second = probe.next("/scan", LaserScan)
    apart = (second.header.stamp - scan.header.stamp).to_sec()
    assert apart == pytest.approx(0.1 * round(apart / 0.1), abs=1e-6)

    assert probe.next("/dock_status", DockStatus).is_docked
    battery = probe.next("/battery_state", BatteryState)
    assert battery.percentage == 1.0
    assert battery.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_FULL
    assert battery.charge == pytest.approx(26.0 / 14.4)
    assert probe.next("/ir_omni", UInt16).data == 160 + 8 + 4 + 1
    assert probe.next("/bin_level", Float32).data == 0.0
    assert probe.next("/brush_current", Float32).data == 0.0

    robot.drive(-0.3, 0.5, 1.5)
    assert probe.next("/brush_current", Float32).data == pytest.approx(3.0 / 14.4)
    imu, joints = probe.next("/imu", Imu), probe.next("/joint_states", JointState)
    assert imu.angular_velocity.z == pytest.approx(0.5, abs=0.1)
    assert imu.orientation_covariance[0] == -1.0
    assert joints.name == ["wheel_left_joint", "wheel_right_joint"]
    assert joints.position[0] < joints.position[1] < 0.0
    assert not probe.next("/dock_status", DockStatus).is_docked
    discharging = probe.next("/battery_state", BatteryState)
    assert discharging.current < 0.0
    assert discharging.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    assert probe.next("/dirt_detect", UInt16).data >= 0

    mounted = {
        transform.child_frame_id: transform
        for transform in probe.next("/tf_static", TFMessage).transforms
    }
    assert set(mounted) == {"laser", "imu_link", "camera", "camera_optical"}
    assert mounted["laser"].header.frame_id == "base_link"
    assert mounted["laser"].transform.translation.z == pytest.approx(0.085)


def test_the_camera_streams_picture_depth_and_geometry(graph: RosGraph) -> None:
    probe = Robot(graph).probe
    picture = probe.next("/camera/image_raw", Image)
    assert (picture.width, picture.height, picture.encoding) == (1024, 768, "rgb8")
    assert picture.header.frame_id == "camera_optical"
    packed = probe.next("/camera/image_raw/compressed", CompressedImage)
    colours = np.frombuffer(picture.data, np.uint8).reshape(768, 1024, 3).astype(int)
    unpacked = np.asarray(Picture.open(io.BytesIO(packed.data))).astype(int)
    assert np.abs(unpacked - colours).mean() < 6.0
    depth = probe.next("/camera/depth/image_raw", Image)
    metres = np.frombuffer(depth.data, np.float32).reshape(768, 1024)
    # The station's front is straight ahead of the lens, which sits near the body's rim.
    assert 0.01 < metres[384, 512] < 0.1
    info = probe.next("/camera/camera_info", CameraInfo)
    assert info.K[0] == pytest.approx(512.0 / math.tan(math.radians(37.5)))
    assert info.K[2] == pytest.approx(511.5)


def test_a_lifted_robot_feels_it_and_can_be_put_elsewhere(graph: RosGraph) -> None:
    robot = Robot(graph, "_home:=empty")
    assert robot.inject("lifted").success
    robot.until("/wheel_drop", WheelDrop, lambda drop: drop.is_left_dropped)
    assert robot.probe.next("/cliff", Cliff).is_cliff_front_left
    assert {HazardDetection.WHEEL_DROP, HazardDetection.CLIFF} <= robot.hazards()
    before = robot.probe.next("/odom", Odometry).pose.pose.position
    refused = robot.inject("put", x=50.0, y=50.0)
    assert not refused.success
    assert "does not fit" in refused.message
    assert robot.inject("put", x=5.0, y=5.0, theta=0.5).success
    robot.until("/wheel_drop", WheelDrop, lambda drop: not drop.is_left_dropped)
    after = robot.probe.next("/odom", Odometry).pose.pose.position
    assert (after.x, after.y) == pytest.approx((before.x, before.y))
    ahead = robot.until("/scan", LaserScan, lambda scan: math.isfinite(scan.ranges[0]))
    assert ahead.ranges[0] == pytest.approx(5.0 / math.cos(0.5), abs=0.3)


def test_wheels_that_slip_or_stall_are_felt_by_encoders_and_hazards(graph: RosGraph) -> None:
    robot = Robot(graph, "_home:=empty")
    robot.inject("put", x=5.0, y=5.0)
    assert robot.inject("slip", 1.0).success
    robot.drive(0.3, 0.0, 1.0)
    # The wheels turn and the odometry believes them; the wall ahead comes no nearer.
    assert robot.probe.next("/odom", Odometry).pose.pose.position.x > 0.15
    ranges = robot.probe.next("/scan", LaserScan).ranges
    assert np.median(ranges[-2:] + ranges[:3]) == pytest.approx(5.0, abs=0.02)
    robot.inject("slip", 0.0)
    robot.inject("stall_left")
    robot.drive(0.3, 0.0, 0.5)
    assert HazardDetection.STALL in robot.hazards()


def test_what_was_put_in_the_way_is_seen_and_felt(graph: RosGraph) -> None:
    robot = Robot(graph, "_home:=empty")
    robot.inject("put", x=5.0, y=5.0)
    assert robot.inject("obstacle", 0.1, x=5.6, y=5.0).success
    robot.until("/scan", LaserScan, lambda scan: abs(scan.ranges[0] - 0.5) < 0.01)
    refused = robot.inject("obstacle", 0.1, x=5.1, y=5.0)
    assert not refused.success
    assert "robot itself" in refused.message
    robot.drive(0.3, 0.0, 1.6)
    bumper = robot.until("/bumper", Bumper, lambda bumper: bumper.is_left_pressed)
    assert bumper.is_right_pressed
    assert HazardDetection.BUMP in robot.hazards()
    # A chair beside it: its legs are in the scan, two to the left ahead and two farther.
    assert robot.inject("moved_chair", x=5.4, y=6.0).success
    robot.until("/scan", LaserScan, lambda scan: min(scan.ranges[45:90]) < 1.0)
    assert robot.inject("no_obstacles").success
    robot.until("/bumper", Bumper, lambda bumper: not bumper.is_left_pressed)


def test_sensors_can_be_blocked_and_freed(graph: RosGraph) -> None:
    robot = Robot(graph, "_home:=apartment")
    for fault, topic, kind, shows in (
        ("lidar_blocked", "/scan", LaserScan, lambda scan: min(scan.ranges) == math.inf),
        ("bumper_stuck", "/bumper", Bumper, lambda bumper: bumper.is_right_pressed),
        ("cliff_dirty", "/cliff", Cliff, lambda cliff: cliff.is_cliff_right),
        ("infrared_blocked", "/ir_omni", UInt16, lambda beams: beams.data == 0),
        ("station_dead", "/dock_status", DockStatus, lambda dock: not dock.is_docked),
    ):
        assert robot.inject(fault, 1.0).success
        robot.until(topic, kind, shows)
        assert robot.inject(fault, 0.0).success
        robot.until(topic, kind, lambda message, shows=shows: not shows(message))


def test_faults_that_there_are_not_are_refused_with_those_that_there_are(graph: RosGraph) -> None:
    robot = Robot(graph)
    unknown = robot.inject("gravity")
    assert not unknown.success
    assert "station_dead" in unknown.message
    assert "gravity" in unknown.message
    names = re.search(r"expected a fault of: (.*); got", unknown.message)[1].split(", ")
    assert [name for name in names if not re.search(rf"\b{name}\b", DESCRIPTION)] == []
    too_much = robot.inject("slip", 1.5)
    assert not too_much.success
    assert "from 0 to 1" in too_much.message


def test_brush_and_fan_have_power_levels(graph: RosGraph) -> None:
    robot = Robot(graph, "_home:=empty")
    robot.inject("put", x=5.0, y=5.0)
    robot.turn_on()
    usual = robot.until("/battery_state", BatteryState, lambda state: state.current < -0.8)
    assert robot.probe.next("/noise_level", Float32).data > 55.0
    robot.probe.send("/main_brush_motor", Float32(0.0))
    robot.probe.send("/vacuum_motor", Float32(0.0))
    robot.until("/brush_current", Float32, lambda current: current.data == 0.0)
    robot.until("/battery_state", BatteryState, lambda state: state.current > usual.current + 0.3)
    robot.probe.send("/vacuum_motor", Float32(7.0))
    robot.probe.send("/vacuum_motor", Float32(1.0))
    robot.until("/battery_state", BatteryState, lambda state: state.current < usual.current - 0.5)


def test_diagnostics_say_what_is_wrong_and_what_to_do(graph: RosGraph) -> None:
    robot = Robot(graph, "_home:=apartment")

    def parts(message: DiagnosticArray) -> dict[str, DiagnosticStatus]:
        return {status.name.partition(": ")[2]: status for status in message.status}

    well = parts(robot.probe.next("/diagnostics", DiagnosticArray))
    assert set(well) == {"battery", "drive", "lidar", "bin"}
    assert {status.level for status in well.values()} == {DiagnosticStatus.OK}
    robot.inject("lifted")
    robot.inject("lidar_blocked")
    robot.until(
        "/diagnostics",
        DiagnosticArray,
        lambda message: (
            parts(message)["drive"].level == parts(message)["lidar"].level == DiagnosticStatus.ERROR
        ),
    )
    ill = parts(robot.probe.newest["/diagnostics"])
    assert "put the robot on the floor" in ill["drive"].message
    assert "no beam comes back" in ill["lidar"].message


def test_noise_is_there_and_a_parameter_switches_it_off(graph: RosGraph) -> None:
    graph.set_param("/home_sim_node/sensors", "broken")
    node = graph.rosrun("home_sim_node.py")
    assert node.ends(20.0) == 1
    assert "ideal or noisy" in node.output
    for sensors in ("", "ideal"):
        graph.set_param("/home_sim_node/sensors", sensors)
        robot = Robot(graph, "_home:=apartment")
        first = robot.probe.next("/scan", LaserScan).ranges
        second = robot.probe.next("/scan", LaserScan).ranges
        assert (first == second) == (sensors == "ideal")
        robot.node.clean_up()
