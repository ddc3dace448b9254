"""What the body tells becomes readings, one for each message of odometry."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import pytest
from fixtures.nodes.lockstep import Lockstep
from nav_msgs.msg import Odometry
from roomba_robot.msg import BodyState, Bumper, Cliff, DockStatus, EmptyingStation, WheelDrop
from rospy import Time
from sensor_msgs.msg import BatteryState, Imu, LaserScan
from std_msgs.msg import Float32, UInt16

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import Battery, EmptyingTold
from roomba.robot.readings import CliffReading
from roomba_ros.convert.common import odometry_message
from roomba_ros.senses.body_topics import BodyTopics

CONFIG = RobotConfig()


@pytest.fixture
def ros() -> Iterator[Lockstep]:
    """Topics without a master."""
    with Lockstep().installed() as lockstep:
        yield lockstep


def body(*topics: str) -> BodyTopics:
    heard = BodyTopics(CONFIG, *topics)
    heard.start()
    return heard


def moved(stamp: float, x: float = 0.0, linear: float = 0.0) -> Odometry:
    return odometry_message(stamp, Pose(x, 0.0, 0.0), Twist(linear, 0.1), "odom", "base_link")


def turned(stamp: float, turning: float) -> Imu:
    message = Imu()
    message.header.stamp = Time.from_sec(stamp)
    message.angular_velocity.z = turning
    return message


def scanned(stamp: float) -> LaserScan:
    message = LaserScan(angle_increment=0.5, range_max=8.0, ranges=[1.0] * 4)
    message.header.stamp = Time.from_sec(stamp)
    return message


def test_each_odometry_is_a_reading_with_the_gyro_of_its_time(ros: Lockstep) -> None:
    heard = body("odom", "imu")
    for stamp, turning in ((9.95, 0.1), (10.0, 0.2), (10.05, 0.3)):
        ros.publish("/imu", turned(stamp, turning))
    for stamp in (10.0, 10.05, 10.5):
        ros.publish("/odom", moved(stamp, x=stamp, linear=0.2))
    readings = heard.take()
    assert [each.time for each in readings] == [10.0, 10.05, 10.5]
    assert [each.odometry.x for each in readings] == [10.0, 10.05, 10.5]
    assert [each.turning for each in readings] == [0.2, 0.3, None]
    assert readings[0].twist == Twist(0.2, 0.1)
    assert heard.take() == []


def whole(stamp: float, **told: float) -> BodyState:
    message = BodyState(battery=0.5, battery_capacity=26.0, turning=math.nan, **told)
    message.header.stamp = Time.from_sec(stamp)
    return message


def test_each_message_that_tells_all_is_a_reading_and_single_topics_count_no_more(
    ros: Lockstep,
) -> None:
    heard = body("odom", "imu", "bumper", "scan", "emptying_station")
    ros.publish("/bumper", Bumper(is_left_pressed=True))
    ros.publish("/emptying_station", EmptyingStation(is_at_work=True, bag=0.25))
    ros.publish("/odom", moved(10.0, x=9.0))
    ros.publish("/scan", scanned(10.0))
    for stamp in (10.0, 10.05):
        ros.publish("/body", whole(stamp, x=stamp, linear=0.2))
    first, last = heard.take()
    assert [first.time, last.time] == [10.0, 10.05]
    assert [first.odometry, last.odometry] == [Pose(10.0), Pose(10.05)]
    assert last.twist == Twist(0.2)
    assert (first.scan, first.bumps, first.turning) == (None, False, None)
    assert last.scan is not None
    assert last.emptying == EmptyingTold(is_at_work=True, bag=0.25)
    assert heard.missing("odom", "imu", "bumper", "scan") == ()
    assert heard.take() == []
    ros.publish("/odom", moved(10.1))
    assert heard.take() == []
    ros.publish("/body", whole(0.0))
    assert heard.take()[0].time == ros.now


def test_single_topics_count_again_when_no_message_tells_all(ros: Lockstep) -> None:
    heard = body("odom")
    ros.publish("/body", whole(10.0), "/body")
    heard.take()
    ros.leave("/body")
    assert heard.take() == []
    ros.publish("/odom", moved(10.05), "/body")
    assert [each.time for each in heard.take()] == [10.05]


def test_single_topics_begin_with_what_the_body_told_last(ros: Lockstep) -> None:
    heard = body("odom", "bumper", "cliff", "battery_state", "dock_status")
    told = whole(10.0, is_left_pressed=True, is_docked=True, is_left_dropped=True)
    ros.publish("/body", told, "/body")
    heard.take()
    ros.leave("/body")
    heard.take()
    ros.publish("/odom", moved(10.05), "/body")
    (reading,) = heard.take()
    assert reading.battery == Battery(0.5, 26.0, is_docked=True)
    assert (reading.bumper_left, reading.dropped_left) == (True, False)


def test_what_the_body_told_before_it_left_is_given_at_once_and_not_later(ros: Lockstep) -> None:
    heard = body("odom")
    ros.publish("/body", whole(10.0), "/body")
    heard.take()
    ros.publish("/body", whole(10.05), "/body")
    ros.leave("/body")
    assert [each.time for each in heard.take()] == [10.05]
    ros.publish("/odom", moved(10.1), "/body")
    assert [each.time for each in heard.take()] == [10.1]
    ros.publish("/body", whole(10.15), "/body")
    assert [each.time for each in heard.take()] == [10.15]


def test_no_time_is_given_twice_and_none_is_lost_when_the_body_comes(ros: Lockstep) -> None:
    heard = body("odom")
    ros.publish("/odom", moved(9.95), "/body")
    assert [each.time for each in heard.take()] == [9.95]
    ros.publish("/odom", moved(10.0), "/body")
    ros.publish("/odom", moved(10.05), "/body")
    ros.publish("/body", whole(10.05, x=2.0), "/body")
    given = heard.take()
    assert [(each.time, each.odometry.x) for each in given] == [(10.0, 0.0), (10.05, 2.0)]
    ros.publish("/body", whole(10.05), "/body")
    assert heard.take() == []


def test_a_clock_that_is_set_back_is_followed(ros: Lockstep) -> None:
    heard = body("odom")
    for stamp in (10.0, 3.0, 3.05):
        ros.publish("/odom", moved(stamp))
        assert [each.time for each in heard.take()] == [stamp]


def test_odometry_without_a_stamp_is_of_now(ros: Lockstep) -> None:
    heard = body("odom")
    ros.publish("/odom", moved(0.0))
    assert heard.take()[0].time == ros.now


def test_a_scan_comes_once_with_the_first_odometry_that_is_not_older(ros: Lockstep) -> None:
    heard = body("odom", "scan")
    ros.publish("/scan", scanned(10.1))
    ros.publish("/odom", moved(10.05))
    (before,) = heard.take()
    for stamp in (10.1, 10.15):
        ros.publish("/odom", moved(stamp))
    first, last = heard.take()
    assert (before.scan, first.scan) == (None, None)
    assert last.scan is not None
    assert last.scan.stamp == pytest.approx(10.1)
    ros.publish("/odom", moved(10.2))
    assert heard.take()[0].scan is None


def test_a_scan_without_a_stamp_ends_with_the_odometry_that_it_comes_with(ros: Lockstep) -> None:
    heard = body("odom", "scan")
    message = scanned(0.0)
    message.time_increment = 0.05
    ros.publish("/scan", message)
    ros.publish("/odom", moved(10.0))
    (told,) = heard.take()
    assert told.scan is not None
    assert told.scan.stamp == pytest.approx(10.0 - 3 * 0.05)


def test_each_has_the_newest_of_all_other_sensors(ros: Lockstep) -> None:
    sensors: tuple[str, ...] = (
        "bumper",
        "cliff",
        "wheel_drop",
        "ir_omni",
        "dirt_detect",
        "bin_level",
    )
    sensors = (*sensors, "emptying_station")
    heard = body("odom", *sensors)
    assert heard.missing("odom", *sensors) == ("odom", *sensors)
    ros.publish("/bumper", Bumper(is_left_pressed=True))
    ros.publish("/bumper", Bumper(is_right_pressed=True))
    ros.publish("/cliff", Cliff(is_cliff_front_left=True))
    ros.publish("/wheel_drop", WheelDrop(is_left_dropped=True))
    ros.publish("/ir_omni", UInt16(160 + 8))
    ros.publish("/dirt_detect", UInt16(40))
    ros.publish("/bin_level", Float32(0.5))
    ros.publish("/emptying_station", EmptyingStation(is_at_work=True, bag=0.25))
    assert heard.missing("odom", *sensors) == ("odom",)
    ros.publish("/odom", moved(1.0))
    (told,) = heard.take()
    assert (told.bumper_left, told.bumper_right) == (False, True)
    assert told.cliff == CliffReading(front_left=True)
    assert (told.dropped_left, told.dropped_right) == (True, False)
    assert told.beams == StationBeams(red=True)
    assert told.grains == 40.0
    assert told.in_bin == 0.5 * CONFIG.brush.bin_capacity
    assert told.emptying == EmptyingTold(is_at_work=True, bag=0.25)


@pytest.mark.parametrize("is_dock_first", [True, False])
def test_battery_and_contact_are_told_apart_and_go_together(
    ros: Lockstep, is_dock_first: bool
) -> None:
    heard = body("odom", "battery_state", "dock_status")
    told = [
        ("/dock_status", DockStatus(is_docked=True)),
        ("/battery_state", BatteryState(percentage=0.25, capacity=2.0)),
    ]
    for topic, message in told if is_dock_first else reversed(told):
        ros.publish(topic, message)
    ros.publish("/odom", moved(1.0))
    battery = heard.take()[0].battery
    assert (battery.level, battery.is_docked) == (0.25, True)


def test_what_is_not_asked_for_is_not_heard(ros: Lockstep) -> None:
    heard = body("odom")
    ros.publish("/bumper", Bumper(is_left_pressed=True))
    ros.publish("/odom", moved(1.0))
    assert not heard.take()[0].bumps
    assert heard.missing("bumper") == ("bumper",)


def test_of_two_nodes_that_tell_of_the_body_the_first_counts(
    ros: Lockstep, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    told = {
        "odom": moved(1.0, linear=0.2),
        "bumper": Bumper(is_left_pressed=True),
        "cliff": Cliff(is_cliff_front_left=True),
        "wheel_drop": WheelDrop(is_left_dropped=True),
        "battery_state": BatteryState(percentage=0.75, capacity=2.0),
        "dock_status": DockStatus(is_docked=True),
        "ir_omni": UInt16(160 + 8),
        "dirt_detect": UInt16(40),
        "bin_level": Float32(0.5),
    }
    heard = body(*told)
    for topic, message in told.items():
        ros.publish(f"/{topic}", message, "/body")
    now[0] += 2.0  # seldom told, and yet by one node
    for topic, message in told.items():
        for _ in range(5):
            ros.publish(f"/{topic}", type(message)(), "/flood")
    (reading,) = heard.take()
    assert reading.time == 1.0
    assert (reading.bumper_left, reading.cliff.front_left, reading.dropped_left) == (True,) * 3
    assert (reading.battery.level, reading.battery.is_docked) == (0.75, True)
    assert (reading.beams.red, reading.grains) == (True, 40.0)
    assert reading.in_bin == 0.5 * CONFIG.brush.bin_capacity
    now[0] += 3.1
    ros.publish("/battery_state", BatteryState(percentage=0.25), "/another_body")
    ros.publish("/odom", moved(2.0), "/another_body")
    (reading,) = heard.take()
    assert reading.battery.level == 0.25


def test_a_robot_may_have_two_lidars(ros: Lockstep) -> None:
    heard = body("odom", "scan")
    for stamp, lidar in ((1.0, "/front"), (1.1, "/back")):
        ros.publish("/scan", scanned(stamp), lidar)
        ros.publish("/odom", moved(stamp))
    assert [each.scan is not None for each in heard.take()] == [False, True]
    ros.publish("/scan", scanned(1.2), "/front")
    ros.publish("/odom", moved(1.2))
    assert heard.take()[0].scan is not None


def test_a_topic_that_there_is_not_is_refused_at_once(ros: Lockstep) -> None:
    with pytest.raises(ValueError, match=r"out of odom, imu, .*scan.*; got bumpers, cliffs$"):
        BodyTopics(CONFIG, "odom", "bumpers", "scan", "cliffs")
    with pytest.raises(ValueError, match=r"out of odom, imu, .*; got scan$"):
        BodyTopics(CONFIG, "odom", "scan", always=("scan",))
