"""Every sensor of the simulated robot, as its running node tells it, and every fault."""

import io
import math
import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import pytest
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fixtures.graph import RosGraph
from fixtures.nodes.simulated import Body, simulated
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from PIL import Image as Picture
from roomba_robot.msg import (
    BodyState,
    Bumper,
    Cliff,
    DockStatus,
    HazardDetection,
    WheelDrop,
)
from roomba_robot.srv import SpillDirt
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

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import Battery
from roomba.world.layers.layer import load_home
from roomba.world.lidar import Lidar
from roomba_ros.convert.readings import body_of
from roomba_ros.runtime.parameters import package_folder

DESCRIPTION = (package_folder() / "srv" / "InjectFault.srv").read_text(encoding="utf-8")


HOME = load_home("apartment", HOMES)
MIDDLE = Pose(5.0, 5.0, 0.0)
"""Of the empty room of 10 x 10 m."""
BEFORE_WALL = Pose(9.0, 5.0, 0.0)
"""A metre from the wall ahead: there a range is exact to some mm."""


@pytest.fixture(scope="module")
def apartment(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The simulation of an apartment, its sensors without noise."""
    arguments = ("_home:=apartment", "_sensors:=ideal")
    with simulated(tmp_path_factory.mktemp("apartment"), *arguments) as graph:
        yield graph


@pytest.fixture(scope="module")
def empty_room(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The simulation of an empty room, with sensors as they are."""
    with simulated(tmp_path_factory.mktemp("room"), "_home:=empty") as graph:
        yield graph


def test_each_sensor_tells_in_the_messages_of_its_kind(apartment: RosGraph) -> None:
    station = HOME.station
    body = Body(apartment, station)
    probe = body.probe
    scan = probe.next("/scan", LaserScan)
    exact = Lidar.of(HOME).scan(np.array([[station.x, station.y, station.theta]]))[0]
    assert np.array(scan.ranges, np.float32) == pytest.approx(exact, abs=1e-4)
    assert scan.header.frame_id == "laser"
    assert scan.angle_min + 359 * scan.angle_increment == pytest.approx(scan.angle_max, abs=1e-5)
    lidar = SimulatedRobotConfig().lidar
    assert (scan.range_min, scan.range_max) == pytest.approx((lidar.min_range, lidar.max_range))
    assert scan.scan_time == pytest.approx(1.0 / lidar.rate)
    assert scan.time_increment == pytest.approx(lidar.sweep_time / lidar.beams)
    second = probe.next("/scan", LaserScan)
    assert second.ranges == pytest.approx(scan.ranges, abs=1e-4)
    apart = (second.header.stamp - scan.header.stamp).to_sec()
    assert apart * lidar.rate == pytest.approx(round(apart * lidar.rate), abs=1e-5)

    assert probe.next("/dock_status", DockStatus).is_docked
    battery = probe.next("/battery_state", BatteryState)
    assert battery.percentage == 1.0
    assert battery.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_FULL
    assert battery.charge == pytest.approx(26.0 / 14.4)
    assert probe.next("/ir_omni", UInt16).data == 160 + 8 + 4 + 1
    assert probe.next("/bin_level", Float32).data == 0.0
    assert probe.next("/brush_current", Float32).data == 0.0
    told = body_of(probe.next("/body", BodyState), 1.0)
    assert told.battery == Battery(1.0, 26.0, is_docked=True)
    assert told.beams == StationBeams(halo=True, green=True, red=True)
    assert told.twist == Twist()
    assert probe.newest["/body"].header.frame_id == "odom"

    before = probe.next("/joint_states", JointState)
    assert before.name == ["wheel_left_joint", "wheel_right_joint"]
    body.drive_for(-0.3, 0.5, 1.5)
    body.drive(-0.3, 0.5, lambda: turn_rate(probe) == pytest.approx(0.5, abs=0.1), "the gyro")
    assert probe.newest["/imu"].orientation_covariance[0] == -1.0
    brush = pytest.approx(3.0 / 14.4)
    body.drive(-0.3, 0.5, lambda: probe.next("/brush_current", Float32).data == brush, "the brush")
    left, right = np.subtract(probe.next("/joint_states", JointState).position, before.position)
    assert left < right < 0.0
    assert not probe.next("/dock_status", DockStatus).is_docked
    discharging = probe.next("/battery_state", BatteryState)
    assert discharging.current < 0.0
    assert discharging.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    spill = rospy.ServiceProxy("/sim/spill", SpillDirt)
    assert spill(x=station.x, y=station.y, radius=1.0, amount=100.0).success
    body.drive(-0.3, 0.5, lambda: probe.next("/dirt_detect", UInt16).data > 0, "the dirt sensor")

    mounted = {
        transform.child_frame_id: transform
        for transform in probe.next("/tf_static", TFMessage).transforms
    }
    cliffs = {f"cliff_{name}" for name in ("left", "front_left", "front_right", "right")}
    assert set(mounted) == {"laser", "imu_link", "camera", "camera_optical"} | cliffs
    assert mounted["laser"].header.frame_id == "base_link"
    assert mounted["laser"].transform.translation.z == pytest.approx(0.085)


def turn_rate(probe: Probe) -> float:
    return float(probe.next("/imu", Imu).angular_velocity.z)


def test_the_camera_streams_picture_depth_and_geometry(apartment: RosGraph) -> None:
    probe = Body(apartment, HOME.station).probe
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


def test_a_lifted_robot_feels_it_and_can_be_put_elsewhere(empty_room: RosGraph) -> None:
    body = Body(empty_room, Pose(5.0, 1.0, 0.0))
    assert body.inject("lifted").success
    body.until("/wheel_drop", WheelDrop, lambda drop: drop.is_left_dropped)
    assert body.probe.next("/cliff", Cliff).is_cliff_front_left
    assert {HazardDetection.WHEEL_DROP, HazardDetection.CLIFF} <= body.hazards()
    before = body.odometry().pose.pose.position
    refused = body.inject("put", x=50.0, y=50.0)
    assert not refused.success
    assert "does not fit" in refused.message
    assert body.put(Pose(5.0, 5.0, 0.5)).success
    body.until("/wheel_drop", WheelDrop, lambda drop: not drop.is_left_dropped)
    after = body.odometry().pose.pose.position
    assert (after.x, after.y) == pytest.approx((before.x, before.y))
    ahead = pytest.approx(5.0 / math.cos(0.5), abs=0.3)
    body.until("/scan", LaserScan, lambda scan: scan.ranges[0] == ahead)


def test_wheels_that_slip_or_stall_are_felt_by_encoders_and_hazards(empty_room: RosGraph) -> None:
    body = Body(empty_room, BEFORE_WALL)
    assert body.inject("slip", 1.0).success
    before = body.odometry().pose.pose.position
    body.drive_for(0.3, 0.0, 1.0)
    # The wheels turn and the odometry believes them; the wall ahead comes no nearer.
    after = body.odometry().pose.pose.position
    assert math.dist((after.x, after.y), (before.x, before.y)) > 0.15
    ranges = body.probe.next("/scan", LaserScan).ranges
    assert np.median(ranges[-2:] + ranges[:3]) == pytest.approx(1.0, abs=0.02)
    body.inject("slip", 0.0)
    body.inject("stall_left")
    body.drive(0.3, 0.0, lambda: HazardDetection.STALL in body.hazards(), "the stall is felt")


def test_what_was_put_in_the_way_is_seen_and_felt(empty_room: RosGraph) -> None:
    body = Body(empty_room, MIDDLE)
    assert body.inject("obstacle", 0.1, x=5.6, y=5.0).success
    body.until("/scan", LaserScan, lambda scan: abs(scan.ranges[0] - 0.5) < 0.01)
    refused = body.inject("obstacle", 0.1, x=5.1, y=5.0)
    assert not refused.success
    assert "robot itself" in refused.message
    body.drive(0.3, 0.0, lambda: body.probe.next("/bumper", Bumper).is_left_pressed, "a bump")
    bumper = body.until("/bumper", Bumper, lambda bumper: bumper.is_left_pressed)
    assert bumper.is_right_pressed
    assert HazardDetection.BUMP in body.hazards()
    # A chair beside it: its legs are in the scan, two to the left ahead and two farther.
    assert body.inject("moved_chair", x=5.4, y=6.0).success
    body.until("/scan", LaserScan, lambda scan: min(scan.ranges[45:90]) < 1.0)
    assert body.inject("no_obstacles").success
    body.until("/bumper", Bumper, lambda bumper: not bumper.is_left_pressed)


def test_sensors_can_be_blocked_and_freed(apartment: RosGraph) -> None:
    body = Body(apartment, HOME.station)
    for fault, topic, kind, shows in (
        ("lidar_blocked", "/scan", LaserScan, lambda scan: min(scan.ranges) == math.inf),
        ("bumper_stuck", "/bumper", Bumper, lambda bumper: bumper.is_right_pressed),
        ("cliff_dirty", "/cliff", Cliff, lambda cliff: cliff.is_cliff_right),
        ("infrared_blocked", "/ir_omni", UInt16, lambda beams: beams.data == 0),
        ("station_dead", "/dock_status", DockStatus, lambda dock: not dock.is_docked),
    ):
        assert body.inject(fault, 1.0).success
        body.until(topic, kind, shows)
        assert body.inject(fault, 0.0).success
        body.until(topic, kind, partial(does_not_show, shows))


def does_not_show(shows: Callable[[Any], bool], message: Any) -> bool:
    return not shows(message)


def test_faults_that_there_are_not_are_refused_with_those_that_there_are(
    apartment: RosGraph,
) -> None:
    body = Body(apartment, HOME.station)
    unknown = body.inject("gravity")
    assert not unknown.success
    assert "station_dead" in unknown.message
    assert "gravity" in unknown.message
    (listed,) = re.findall(r"expected a fault of: (.*); got", unknown.message)
    names = listed.split(", ")
    assert [name for name in names if not re.search(rf"\b{name}\b", DESCRIPTION)] == []
    too_much = body.inject("slip", 1.5)
    assert not too_much.success
    assert "from 0 to 1" in too_much.message


def test_brush_and_fan_have_power_levels(empty_room: RosGraph) -> None:
    body = Body(empty_room, MIDDLE)
    body.turn_on()
    usual = body.until("/battery_state", BatteryState, lambda state: state.current < -0.8)
    assert body.probe.next("/noise_level", Float32).data > 55.0
    body.probe.send("/main_brush_motor", Float32(0.0))
    body.probe.send("/vacuum_motor", Float32(0.0))
    body.until("/brush_current", Float32, lambda current: current.data == 0.0)
    body.until("/battery_state", BatteryState, lambda state: state.current > usual.current + 0.3)
    body.probe.send("/vacuum_motor", Float32(7.0))
    body.probe.send("/vacuum_motor", Float32(1.0))
    body.until("/battery_state", BatteryState, lambda state: state.current < usual.current - 0.5)


def test_diagnostics_say_what_is_wrong_and_what_to_do(apartment: RosGraph) -> None:
    body = Body(apartment, HOME.station)

    def parts(message: DiagnosticArray) -> dict[str, DiagnosticStatus]:
        return {status.name.partition(": ")[2]: status for status in message.status}

    def next_parts() -> dict[str, DiagnosticStatus]:
        told = parts(body.probe.next("/diagnostics", DiagnosticArray))
        # Each node tells on this topic what it refused, too.
        return next_parts() if set(told) == {"messages"} else told

    well = next_parts()
    assert set(well) == {"battery", "drive", "lidar", "bin"}
    assert {status.level for status in well.values()} == {DiagnosticStatus.OK}
    body.inject("lifted")
    body.inject("lidar_blocked")

    def is_ill(told: dict[str, DiagnosticStatus]) -> bool:
        return bool(told["drive"].level == told["lidar"].level == DiagnosticStatus.ERROR)

    ill = wait_until(
        lambda: next((told for told in (next_parts(),) if is_ill(told)), None), 20.0, "both are ill"
    )
    assert "put the robot on the floor" in ill["drive"].message
    assert "no beam comes back" in ill["lidar"].message


def test_noise_is_there(empty_room: RosGraph) -> None:
    """Nothing moves; without noise two scans are the same, see above."""
    probe = Body(empty_room, MIDDLE).probe
    wait_until(lambda: turn_rate(probe) == pytest.approx(0.0, abs=0.05), 10.0, "it stands")
    first = probe.next("/scan", LaserScan).ranges
    assert first != probe.next("/scan", LaserScan).ranges
