"""Messages of sensors and wishes become values, or are refused with what was expected."""

import math
from collections.abc import Callable
from dataclasses import asdict, replace
from functools import partial
from typing import Any, Final

import pytest
from fixtures.nodes.malformed import filled
from fixtures.robots.missions import HOME
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from hypothesis import given
from hypothesis import strategies as st
from nav_msgs.msg import Odometry
from roomba_robot.msg import (
    BodyState,
    Bumper,
    Cliff,
    Localization,
    RobotPosition,
    VacuumState,
    WheelDrop,
)
from rospy import Time
from std_msgs.msg import Float32, String
from std_msgs.msg import Time as TimeMessage

from roomba.errors import RoombaError
from roomba.geometry import Pose, Twist
from roomba.headless.body import readings_of
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import Battery
from roomba.perception.localization.estimate import Knowledge
from roomba.robot.readings import CliffReading, Readings
from roomba.vocabulary import Hindrance, Reason
from roomba.world.simulator import Simulator
from roomba_ros.convert.clean_action import line_trouble_message, put_reason
from roomba_ros.convert.client import (
    BATTERY_NOT_HEARD,
    doubt_of,
    line_trouble_of,
    vacuum_of,
)
from roomba_ros.convert.common import (
    path_of,
    planar_pose_message,
    pose_in_map,
    pose_message,
    pose_of,
    twist_message,
    twist_of,
)
from roomba_ros.convert.errors import MessageError, require_finite
from roomba_ros.convert.localization import knowledge_of, told_pose_of
from roomba_ros.convert.mapping import is_growing_of
from roomba_ros.convert.readings import (
    OdometryReading,
    Sides,
    StampedPose,
    battery_of,
    body_of,
    bumper_of,
    cliff_of,
    emptying_of,
    odometry_of,
    point_of,
    stamped_pose_of,
    turning_of,
    wheel_drop_of,
)
from roomba_ros.convert.sensors import body_message
from roomba_ros.convert.values import data_of, duty_of, number_of, speed_of, time_of

BIN: Final = 300.0
"""g; what a full bin holds."""
CONVERTED: list[tuple[str, Callable[[Any], object]]] = [
    ("roomba_robot/BodyState", partial(body_of, bin_capacity=BIN)),
    ("geometry_msgs/Twist", twist_of),
    ("geometry_msgs/PoseStamped", pose_of),
    ("geometry_msgs/PoseStamped", pose_in_map),
    ("geometry_msgs/PoseStamped", stamped_pose_of),
    ("geometry_msgs/PoseWithCovarianceStamped", told_pose_of),
    ("nav_msgs/Odometry", odometry_of),
    ("nav_msgs/Path", path_of),
    ("roomba_robot/Localization", knowledge_of),
    ("roomba_robot/Localization", doubt_of),
    ("roomba_robot/Mapping", is_growing_of),
    ("roomba_robot/EmptyingStation", emptying_of),
    ("roomba_robot/RobotPosition", point_of),
    ("roomba_robot/VacuumState", vacuum_of),
    ("sensor_msgs/BatteryState", lambda message: battery_of(message, 14.4)),
    ("sensor_msgs/Imu", turning_of),
    ("std_msgs/Float32", number_of),
    ("std_msgs/Float32", speed_of),
    ("std_msgs/Float32", duty_of),
]
BAD = (math.nan, math.inf, -math.inf)
finite = st.floats(-1e6, 1e6)


@pytest.mark.parametrize("number", BAD)
@pytest.mark.parametrize(("kind", "convert"), CONVERTED)
def test_numbers_that_are_not_finite_are_refused(
    kind: str, convert: Callable[[Any], object], number: float
) -> None:
    with pytest.raises(MessageError, match=r"expected .*, got .*(nan|inf)"):
        convert(filled(kind, number))


@pytest.mark.parametrize("number", BAD)
def test_one_bad_number_of_a_twist_is_enough(number: float) -> None:
    for twist in (Twist(number, 0.2), Twist(0.1, number)):
        with pytest.raises(MessageError, match="velocities of finite numbers"):
            twist_of(twist_message(twist))


@pytest.mark.parametrize("number", BAD)
@pytest.mark.parametrize(
    "field",
    [
        "position.x",
        "position.y",
        "orientation.x",
        "orientation.y",
        "orientation.z",
        "orientation.w",
    ],
)
def test_one_bad_number_of_a_pose_is_enough(field: str, number: float) -> None:
    message = pose_message(1.0, Pose(1.0, 2.0, 0.5), "map")
    part, name = field.split(".")
    setattr(getattr(message.pose, part), name, number)
    with pytest.raises(MessageError, match="a pose of finite numbers"):
        pose_of(message)


@pytest.mark.parametrize("length", [0.5, 2.0])
def test_a_quaternion_of_any_length_tells_the_heading(length: float) -> None:
    message = pose_message(1.0, Pose(1.0, 2.0, 2.5), "map")
    message.pose.orientation.z *= length
    message.pose.orientation.w *= length
    assert pose_of(message).theta == pytest.approx(2.5)


@pytest.mark.parametrize("number", BAD)
@pytest.mark.parametrize("place", [0, 7, 35])
def test_one_bad_variance_is_enough(place: int, number: float) -> None:
    message = PoseWithCovarianceStamped()
    message.pose.covariance = [0.1] * 36
    message.pose.covariance[place] = number
    with pytest.raises(MessageError, match="variances"):
        told_pose_of(message)


@pytest.mark.parametrize("number", BAD)
def test_odometry_is_refused_for_its_pose_and_for_its_twist(number: float) -> None:
    bad_pose, bad_twist = Odometry(), Odometry()
    bad_pose.pose.pose.position.x = bad_twist.twist.twist.linear.x = number
    with pytest.raises(MessageError, match="a pose"):
        odometry_of(bad_pose)
    with pytest.raises(MessageError, match="velocities"):
        odometry_of(bad_twist)


@given(finite, finite, st.floats(-3.1, 3.1), finite, finite)
def test_finite_odometry_is_what_was_told(
    x: float, y: float, theta: float, linear: float, angular: float
) -> None:
    message = Odometry()
    message.header.stamp = Time(12, 500_000_000)
    message.pose.pose = planar_pose_message(Pose(x, y, theta))
    message.twist.twist = twist_message(Twist(linear, angular))
    told = odometry_of(message)
    assert told == OdometryReading(12.5, Pose(x, y, told.pose.theta), Twist(linear, angular))
    assert told.pose.theta == pytest.approx(theta, abs=1e-9)


@given(st.lists(st.floats(), min_size=1, max_size=4))
def test_numbers_are_required_to_be_finite_all_of_them(numbers: list[float]) -> None:
    if all(map(math.isfinite, numbers)):
        require_finite("a thing", *numbers)
        return
    with pytest.raises(MessageError, match="expected a thing of finite numbers, got"):
        require_finite("a thing", *numbers)


def test_the_error_is_one_of_the_library_and_of_values() -> None:
    assert issubclass(MessageError, RoombaError)
    assert issubclass(MessageError, ValueError)


def test_what_is_not_used_need_not_be_a_number() -> None:
    imu = filled("sensor_msgs/Imu", math.nan)
    imu.angular_velocity.z = 0.25
    imu.header.stamp = Time(3)
    assert turning_of(imu) == (3.0, 0.25)
    pose = pose_message(2.0, Pose(1.0, 2.0, 0.0), "map")
    pose.pose.position.z = math.nan
    assert stamped_pose_of(pose) == StampedPose(2.0, Pose(1.0, 2.0, 0.0))


def test_a_gyro_that_says_that_it_measures_nothing_is_refused() -> None:
    imu = filled("sensor_msgs/Imu", 0.0)
    imu.angular_velocity_covariance[0] = -1.0
    with pytest.raises(MessageError, match="says it measures none"):
        turning_of(imu)


@pytest.mark.parametrize("speed", [-0.01, -5.0])
def test_a_speed_below_nothing_is_refused(speed: float) -> None:
    with pytest.raises(MessageError, match="0 m/s or more, got -"):
        speed_of(Float32(speed))


@pytest.mark.parametrize("duty", [-0.01, 1.01, 7.0])
def test_a_power_that_no_motor_has_is_refused(duty: float) -> None:
    with pytest.raises(MessageError, match="from 0 to 1"):
        duty_of(Float32(duty))


def test_single_values_are_what_was_told() -> None:
    assert (number_of(Float32(-2.5)), speed_of(Float32(0.0)), duty_of(Float32(1.0))) == (-2.5, 0, 1)
    assert time_of(TimeMessage(Time.from_sec(1.5))) == 1.5
    assert data_of(String("a child")) == "a child"
    assert point_of(RobotPosition(1.0, -2.0)) == (1.0, -2.0)


def test_a_pose_of_another_frame_is_refused() -> None:
    message = PoseStamped()
    message.header.frame_id = "odom"
    with pytest.raises(MessageError, match="frame 'map', got one in 'odom'; transform it"):
        pose_in_map(message)
    told = PoseWithCovarianceStamped()
    told.header.frame_id = "odom"
    with pytest.raises(MessageError, match="frame 'map', got 'odom'"):
        told_pose_of(told)


def test_a_state_of_the_place_that_there_is_not_is_refused() -> None:
    told = Localization(state=Localization.ROUGH, message="dark", position_deviation=0.5)
    assert knowledge_of(told) == (Knowledge.ROUGH, "dark", 0.5)
    with pytest.raises(MessageError, match="a state from 0 to 3, got 4"):
        knowledge_of(Localization(state=4))


def test_sides_are_told_apart() -> None:
    assert bumper_of(Bumper(is_left_pressed=True)) == Sides(True, False)
    assert wheel_drop_of(WheelDrop(is_right_dropped=True)) == Sides(False, True)
    for name in ("left", "front_left", "front_right", "right"):
        assert cliff_of(Cliff(**{f"is_cliff_{name}": True})) == CliffReading(**{name: True})
    assert [Sides(*each).any for each in ((False, False), (True, False), (False, True))] == [
        False,
        True,
        True,
    ]


def test_a_battery_that_was_not_heard_is_no_number_for_clients() -> None:
    assert math.isnan(vacuum_of(VacuumState(battery=BATTERY_NOT_HEARD)).battery)
    assert vacuum_of(VacuumState(battery=0.5)).battery == 0.5


def test_what_hinders_the_robot_is_told_by_its_code() -> None:
    state = VacuumState()
    put_reason(state, Reason("no way home", Hindrance.NO_WAY, 30.0))
    told = vacuum_of(state)
    assert state.hindrance == VacuumState.NO_WAY
    assert (told.message, told.hindrance, told.looks_within) == (
        *("no way home", Hindrance.NO_WAY, 30.0),
    )
    assert vacuum_of(VacuumState(hindrance=200)).hindrance is Hindrance.NONE
    gone = Reason("the line is gone", Hindrance.UNREACHABLE)
    assert line_trouble_of(line_trouble_message(gone)) == gone


@pytest.mark.parametrize(("passes", "fans"), [([2, 1], [1]), ([1], [9])])
def test_ways_to_clean_that_are_none_are_refused(passes: list[int], fans: list[int]) -> None:
    with pytest.raises(MessageError, match="expected as many fan levels from 0 to"):
        vacuum_of(VacuumState(queue_passes=passes, queue_fans=fans))


TOLD = Readings(
    12.5,
    Pose(1.0, -2.0, 0.5),
    twist=Twist(0.2, -0.3),
    turning=-0.25,
    bumper_left=True,
    cliff=CliffReading(front_left=True, right=True),
    dropped_right=True,
    beams=StationBeams(halo=True, red=True),
    battery=Battery(0.75, 26.0, is_docked=True),
    grains=40.0,
    in_bin=0.25 * BIN,
    brush_current=0.5,
)
OTHER_SIDES = replace(
    TOLD,
    bumper_left=False,
    bumper_right=True,
    cliff=CliffReading(left=True, front_right=True),
    dropped_left=True,
    dropped_right=False,
    beams=StationBeams(green=True),
)


@pytest.mark.parametrize("told", [TOLD, OTHER_SIDES, replace(TOLD, turning=None)])
def test_what_a_body_tells_in_one_message_is_read_as_it_was_told(told: Readings) -> None:
    message = body_message(told.time, told, BIN, "odom")
    assert message.header.frame_id == "odom"
    assert asdict(body_of(message, BIN)) == asdict(told)


def test_what_a_simulated_body_tells_in_one_message_is_what_its_sensors_say() -> None:
    simulator = Simulator(HOME, seed=1)
    for _ in range(20):
        simulator.step(Twist(-0.2, 0.3), 0.05)
    seen = simulator.observe()
    told = body_of(body_message(1.0, readings_of(seen, None), BIN, "odom"), BIN)
    expected = replace(readings_of(seen, None), time=1.0, in_bin=told.in_bin)
    assert asdict(told) == asdict(expected)
    assert told.in_bin == pytest.approx(seen.in_bin)


def test_a_charge_that_is_none_and_a_bin_without_a_number_are_refused() -> None:
    with pytest.raises(MessageError, match=r"a charge from 0 to 1, got 1\.5"):
        body_of(BodyState(battery=1.5), BIN)
    with pytest.raises(MessageError, match="a turning speed, or NaN, got inf"):
        body_of(BodyState(turning=math.inf), BIN)
    with pytest.raises(MessageError, match="a body's readings of finite numbers"):
        body_of(BodyState(bin_level=math.nan), BIN)
