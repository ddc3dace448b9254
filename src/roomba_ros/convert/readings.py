"""Sensor messages as values; each function raises MessageError for an invalid message."""

from __future__ import annotations

import math
from typing import NamedTuple

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from roomba_robot.msg import (
    BodyState,
    Bumper,
    Cliff,
    DockStatus,
    EmptyingStation,
    RobotPosition,
    WheelDrop,
)
from sensor_msgs.msg import BatteryState, Imu

from roomba.geometry import Pose, Twist, wrap_angle
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import Battery, EmptyingTold
from roomba.perception.matching.plausible import is_measured
from roomba.robot.readings import CliffReading, Readings
from roomba_ros.convert.common import pose_of, pose_of_odometry, twist_of
from roomba_ros.convert.errors import MessageError, require_finite

_RED = 8
_GREEN = 4
_HALO = 1
"""Bits of the infrared code of Create 2's receiver, one for each beam of the station."""
_BEAMS = 160
"""Codes of the station begin here; the bits above say which of its beams are received."""


class OdometryReading(NamedTuple):
    """What the wheels say: ``pose`` in the odometry's frame at ``stamp``, s; 0 if not told."""

    stamp: float
    pose: Pose
    twist: Twist


class StampedPose(NamedTuple):
    """Where the robot was at ``stamp``, s; 0 if not told."""

    stamp: float
    pose: Pose


class GyroReading(NamedTuple):
    """How fast the robot turned at ``stamp``, s, rad/s counter-clockwise."""

    stamp: float
    turning: float


class Sides(NamedTuple):
    """Whether a sensor triggers on the left, and on the right."""

    left: bool
    right: bool

    @property
    def any(self) -> bool:
        """Whether it triggers on either side."""
        return self.left or self.right


def odometry_of(message: Odometry) -> OdometryReading:
    """Return pose and twist by the wheels."""
    stamp = message.header.stamp.to_sec()
    return OdometryReading(stamp, pose_of_odometry(message), twist_of(message.twist.twist))


def body_of(message: BodyState, bin_capacity: float) -> Readings:
    """Return all that the body tells but its scan; the bin holds ``bin_capacity``, g."""
    where, moves = (message.x, message.y, message.theta), (message.linear, message.angular)
    counts = message.dirt_detect, message.bin_level, message.brush_current
    require_finite("a body's readings", *where, *moves, *counts, message.battery_capacity)
    if math.isinf(message.turning):
        raise MessageError(f"expected a turning speed, or NaN, got {message.turning:g}")
    if not 0.0 <= message.battery <= 1.0:
        raise MessageError(f"expected a charge from 0 to 1, got {message.battery:g}")
    return Readings(
        message.header.stamp.to_sec(),
        Pose(message.x, message.y, wrap_angle(message.theta)),
        twist=Twist(message.linear, message.angular),
        turning=None if math.isnan(message.turning) else message.turning,
        bumper_left=message.is_left_pressed,
        bumper_right=message.is_right_pressed,
        cliff=CliffReading(
            message.is_cliff_left,
            message.is_cliff_front_left,
            message.is_cliff_front_right,
            message.is_cliff_right,
        ),
        dropped_left=message.is_left_dropped,
        dropped_right=message.is_right_dropped,
        beams=beams_of(message.ir_omni),
        battery=Battery(message.battery, message.battery_capacity, message.is_docked),
        grains=message.dirt_detect,
        in_bin=message.bin_level * bin_capacity,
        brush_current=message.brush_current,
    )


def stamped_pose_of(message: PoseStamped) -> StampedPose:
    """Return a pose and its time."""
    return StampedPose(message.header.stamp.to_sec(), pose_of(message))


def turning_of(message: Imu) -> GyroReading:
    """Return what the gyro measures about the vertical."""
    if not is_measured(message.angular_velocity_covariance):
        raise MessageError("expected a turning speed, got a message that says it measures none")
    turning = message.angular_velocity.z
    require_finite("a turning speed", turning)
    return GyroReading(message.header.stamp.to_sec(), turning)


def bumper_of(message: Bumper) -> Sides:
    """Return which halves of the bumper are pressed."""
    return Sides(message.is_left_pressed, message.is_right_pressed)


def cliff_of(message: Cliff) -> CliffReading:
    """Return which cliff sensors see no floor."""
    return CliffReading(
        message.is_cliff_left,
        message.is_cliff_front_left,
        message.is_cliff_front_right,
        message.is_cliff_right,
    )


def wheel_drop_of(message: WheelDrop) -> Sides:
    """Return which wheels hang in the air."""
    return Sides(message.is_left_dropped, message.is_right_dropped)


def battery_of(message: BatteryState, voltage: float, is_docked: bool = False) -> Battery:
    """Return the battery; charges are in Ah at the nominal ``voltage``, V.

    A capacity that is not finite is not measured. Raises MessageError for a level that is none.
    """
    level = message.percentage
    if not 0.0 <= level <= 1.0:
        raise MessageError(f"expected a percentage from 0 to 1, got {level}")
    energy = message.capacity * voltage
    if not (math.isfinite(energy) and energy > 0.0):
        return Battery(level, is_docked=is_docked)
    return Battery(level, energy, is_docked)


def is_docked_of(message: DockStatus) -> bool:
    """Return whether the contacts of the station touch."""
    return bool(message.is_docked)


def beams_of(code: int) -> StationBeams:
    """Return which beams a receiver's code stands for, as Create 2 codes them."""
    if code & ~(_RED | _GREEN | _HALO) != _BEAMS:
        return StationBeams()
    return StationBeams(bool(code & _HALO), bool(code & _GREEN), bool(code & _RED))


def code_of_beams(beams: StationBeams) -> int:
    """Return the code that stands for beams, as Create 2 codes them; 0 for none."""
    seen = beams.halo * _HALO + beams.green * _GREEN + beams.red * _RED
    return _BEAMS + seen if seen else 0


def emptying_of(message: EmptyingStation) -> EmptyingTold:
    """Return the readings of a station that empties the bin."""
    return EmptyingTold(message.is_at_work, bag_of(message))


def bag_of(message: EmptyingStation) -> float:
    """Return how full the bag of a station is, 0..1."""
    require_finite("a bag's share", message.bag)
    if not 0.0 <= message.bag <= 1.0:
        raise MessageError(f"expected a bag's share from 0 to 1, got {message.bag:g}")
    return float(message.bag)


def point_of(message: RobotPosition) -> tuple[float, float]:
    """Return a point, m."""
    require_finite("coordinates", message.pos_x, message.pos_y)
    return message.pos_x, message.pos_y
