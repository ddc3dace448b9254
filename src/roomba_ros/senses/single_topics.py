"""The body's single topics; ``body`` has all their values that the robot's brain needs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from nav_msgs.msg import Odometry
from roomba_robot.msg import Bumper, Cliff, DockStatus, WheelDrop
from sensor_msgs.msg import BatteryState, Imu
from std_msgs.msg import Float32, UInt16

from roomba.configuration.robot import RobotConfig
from roomba_ros.convert.readings import (
    battery_of,
    beams_of,
    bumper_of,
    cliff_of,
    is_docked_of,
    odometry_of,
    turning_of,
    wheel_drop_of,
)
from roomba_ros.convert.values import data_of, number_of


class SingleTopic(NamedTuple):
    """The type ``kind`` of a topic's messages, and ``convert``, which makes a value of a message.

    ``fields`` are the fields of the readings that the value fills: one field the value itself,
    several fields one value each. Without fields, the value is combined with those of other topics.
    """

    kind: type
    convert: Callable[[Any], Any]
    fields: tuple[str, ...] = ()

    def told(self, value: Any) -> dict[str, Any]:
        """Return the fields of the readings that a value fills."""
        values = value if len(self.fields) > 1 else (value,)
        return dict(zip(self.fields, values, strict=True))


def single_topics(config: RobotConfig) -> dict[str, SingleTopic]:
    """Return all of them by name."""
    voltage, capacity = config.battery.nominal_voltage, config.brush.bin_capacity
    return {
        "odom": SingleTopic(Odometry, odometry_of),
        "imu": SingleTopic(Imu, turning_of),
        "bumper": SingleTopic(Bumper, bumper_of, ("bumper_left", "bumper_right")),
        "cliff": SingleTopic(Cliff, cliff_of, ("cliff",)),
        "wheel_drop": SingleTopic(WheelDrop, wheel_drop_of, ("dropped_left", "dropped_right")),
        "battery_state": SingleTopic(BatteryState, lambda told: battery_of(told, voltage)),
        "dock_status": SingleTopic(DockStatus, is_docked_of),
        "ir_omni": SingleTopic(UInt16, lambda told: beams_of(told.data), ("beams",)),
        "dirt_detect": SingleTopic(UInt16, lambda told: float(data_of(told)), ("grains",)),
        "bin_level": SingleTopic(Float32, lambda told: number_of(told) * capacity, ("in_bin",)),
        "brush_current": SingleTopic(Float32, number_of, ("brush_current",)),
    }
