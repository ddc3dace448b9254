"""The malformed messages that tests send on every topic really have the faults of their names."""

import math
from io import BytesIO

import pytest
from fixtures.nodes.malformed import CANNOT_BE_WRONG, filled, has_numbers, malformed, not_finite
from roomba_robot.msg import VacuumState
from sensor_msgs.msg import LaserScan

TYPES = (
    "geometry_msgs/PoseWithCovarianceStamped",
    "nav_msgs/OccupancyGrid",
    "nav_msgs/Odometry",
    "roomba_robot/CleanActionGoal",
    "roomba_robot/LowThingArray",
    "roomba_robot/RoomArray",
    "roomba_robot/ZoneArray",
    "sensor_msgs/BatteryState",
    "sensor_msgs/LaserScan",
    "tf2_msgs/TFMessage",
)


@pytest.mark.parametrize("kind", TYPES)
def test_a_malformed_message_can_be_sent(kind: str) -> None:
    for message in malformed(kind).values():
        message.serialize(BytesIO())


@pytest.mark.parametrize("kind", TYPES)
def test_numbers_that_are_not_finite_are_found_wherever_they_are(kind: str) -> None:
    assert list(not_finite(kind, filled(kind, math.nan)))
    assert list(not_finite(kind, filled(kind, -math.inf)))
    assert not list(not_finite(kind, filled(kind, 0.5)))


def test_a_field_that_is_not_finite_is_named() -> None:
    state = VacuumState(battery=math.nan, covered=math.inf)
    assert list(not_finite("roomba_robot/VacuumState", state)) == ["battery", "covered"]
    scan = LaserScan(ranges=[1.0, math.inf])
    assert list(not_finite("sensor_msgs/LaserScan", scan)) == ["ranges"]
    goal = filled("roomba_robot/CleanActionGoal", math.nan)
    assert {"goal.spot.x", "goal.zones.min_x"} <= set(
        not_finite("roomba_robot/CleanActionGoal", goal)
    )


@pytest.mark.parametrize("kind", sorted(CANNOT_BE_WRONG))
def test_what_cannot_be_wrong_has_neither_numbers_nor_arrays(kind: str) -> None:
    assert malformed(kind) == {}
    assert not has_numbers(kind)
