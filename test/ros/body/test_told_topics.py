"""Every body publishes on its topics what it tells its brain."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from fixtures.nodes.lockstep import Lockstep
from roomba_robot.msg import HazardDetection
from sensor_msgs.msg import BatteryState

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import Battery
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.readings import CliffReading, Readings, ScanReading
from roomba_ros.body.told_topics import ToldTopics
from roomba_ros.convert.readings import body_of
from roomba_ros.convert.sensors import hazards_of

CONFIG = RobotConfig()
CAPACITY = CONFIG.brush.bin_capacity
TOLD = Readings(
    time=3.0,
    odometry=Pose(1.0, 2.0, 0.5),
    twist=Twist(0.2, 0.1),
    bumper_left=True,
    cliff=CliffReading(front_right=True),
    dropped_right=True,
    beams=StationBeams(halo=True, red=True),
    battery=Battery(0.5, CONFIG.battery.capacity, is_docked=True),
    in_bin=0.25 * CAPACITY,
)
TOPICS = (
    "odom",
    "body",
    "bumper",
    "cliff",
    "wheel_drop",
    "ir_omni",
    "hazard_detection",
    "battery_state",
    "dock_status",
)


@pytest.fixture
def ros() -> Iterator[Lockstep]:
    """Topics without a master."""
    with Lockstep().installed() as lockstep:
        yield lockstep


def heard_of(ros: Lockstep, *topics: str) -> dict[str, list[Any]]:
    """Return where the messages of topics will be."""
    heard: dict[str, list[Any]] = {topic: [] for topic in topics}
    for topic, messages in heard.items():
        ros.hear(topic, messages.append)
    return heard


def test_each_topic_tells_what_the_readings_hold(ros: Lockstep) -> None:
    heard = heard_of(ros, *TOPICS)
    ToldTopics(CONFIG).tell(100.0, 0, TOLD)
    ros.deliver()
    told = {topic: messages[0] for topic, messages in heard.items()}
    code = told.pop("ir_omni")
    frames = {topic: message.header.frame_id for topic, message in told.items()}
    assert frames == {
        "odom": "odom",
        "body": "odom",
        "bumper": "base_link",
        "cliff": "base_link",
        "wheel_drop": "base_link",
        "hazard_detection": "base_link",
        "battery_state": "",
        "dock_status": "base_link",
    }
    assert all(message.header.stamp.to_sec() == 100.0 for message in told.values())
    assert told["odom"].pose.pose.position.x == 1.0
    assert told["odom"].twist.twist.linear.x == 0.2
    body = body_of(told["body"], CAPACITY)
    assert (body.bumper_left, body.cliff, body.beams) == (True, TOLD.cliff, TOLD.beams)
    assert body.in_bin == pytest.approx(TOLD.in_bin)
    assert (told["bumper"].is_left_pressed, told["bumper"].is_right_pressed) == (True, False)
    assert told["cliff"].is_cliff_front_right
    assert not told["cliff"].is_cliff_right
    assert (told["wheel_drop"].is_left_dropped, told["wheel_drop"].is_right_dropped) == (
        False,
        True,
    )
    assert code.data == 169
    assert [hazard.type for hazard in told["hazard_detection"].detections] == [
        HazardDetection.BUMP,
        HazardDetection.CLIFF,
        HazardDetection.WHEEL_DROP,
    ]
    battery = told["battery_state"]
    assert battery.percentage == 0.5
    assert battery.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
    assert math.isnan(battery.voltage)
    assert (told["dock_status"].dock_visible, told["dock_status"].is_docked) == (True, True)


def test_a_body_adds_what_it_alone_measures(ros: Lockstep) -> None:
    heard = heard_of(ros, "hazard_detection", "battery_state")
    topics = ToldTopics(
        CONFIG,
        lambda told: hazards_of(told, is_stalled=True),
        lambda _, told: BatteryState(voltage=14.4, percentage=told.battery.level),
    )
    topics.tell(100.0, 0, replace(TOLD, bumper_left=False, cliff=CliffReading()))
    ros.deliver()
    assert [hazard.type for hazard in heard["hazard_detection"][0].detections] == [
        HazardDetection.STALL,
        HazardDetection.WHEEL_DROP,
    ]
    assert heard["battery_state"][0].voltage == pytest.approx(14.4)


CHANGES: dict[str, dict[str, Any]] = {
    "bumper": {"bumper_right": True},
    "cliff": {"cliff": CliffReading(left=True)},
    "wheel_drop": {"dropped_left": True},
    "ir_omni": {"beams": StationBeams(halo=True)},
    "hazard_detection": {"bumper_left": False},
    "battery_state": {"battery": replace(TOLD.battery, is_docked=False)},
    "dock_status": {"beams": StationBeams()},
}
"""What of the readings changes, and a topic that tells it at once."""


@pytest.mark.parametrize("topic", sorted(CHANGES))
def test_a_change_is_told_at_once(ros: Lockstep, topic: str) -> None:
    messages = heard_of(ros, topic)[topic]
    topics = ToldTopics(CONFIG)
    topics.tell(100.0, 0, TOLD)
    topics.tell(100.05, 1, replace(TOLD, odometry=Pose(1.5)))
    topics.tell(100.1, 2, replace(TOLD, **CHANGES[topic]))
    ros.deliver()
    assert len(messages) == 2
    assert messages[0] != messages[1]


def test_a_scan_is_stamped_when_its_first_beam_was_and_turns_as_it_did(ros: Lockstep) -> None:
    messages = heard_of(ros, "scan")["scan"]
    beams = CONFIG.lidar.beams
    lidar = LidarModel(np.arange(beams) * CONFIG.lidar.beam_step, 0.1, 8.0, time_increment=0.0006)
    scan = ScanReading(2.75, np.full(beams, 1.5, np.float32), lidar)
    topics = ToldTopics(CONFIG)
    topics.tell(100.0, 0, TOLD)
    topics.tell(100.05, 1, replace(TOLD, scan=scan))
    ros.deliver()
    (message,) = messages
    assert message.header.stamp.to_sec() == pytest.approx(100.05 - 0.25)
    assert message.header.frame_id == "laser"
    assert message.time_increment == pytest.approx(0.0006)
    assert len(message.ranges) == beams
