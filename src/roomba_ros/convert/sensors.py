"""Readings of any body, further sensors of a simulated one, and its home's truth, as messages."""

from __future__ import annotations

import io
import math
from collections.abc import Iterable

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point32, Polygon
from nav_msgs.msg import OccupancyGrid
from numpy.typing import NDArray
from PIL import Image as Picture
from roomba_robot.msg import (
    BodyState,
    DockStatus,
    HazardDetection,
    HazardDetectionVector,
    Rectangle,
    SimHome,
    WheelDrop,
)
from roomba_robot.msg import (
    Bumper as BumperMessage,
)
from roomba_robot.msg import (
    Cliff as CliffMessage,
)
from roomba_robot.msg import Door as DoorMessage
from sensor_msgs.msg import (
    BatteryState as BatteryMessage,
)
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, Imu, JointState, LaserScan

from roomba.configuration.body import BatteryConfig
from roomba.configuration.sensors import CameraConfig, LidarConfig
from roomba.configuration.simulation import SimulatedGyro
from roomba.grid import GridFrame, OccupancyMap
from roomba.mission.docking.beams import NO_BEAMS
from roomba.mission.inputs.senses import Battery
from roomba.robot.readings import Readings
from roomba.world.health import PartHealth
from roomba.world.observation import Observation
from roomba.world.power import BatteryState
from roomba.world.truth import DoorNow, HomeNow
from roomba_ros.convert.common import header, map_message
from roomba_ros.convert.readings import code_of_beams

WHEEL_JOINTS = ("wheel_left_joint", "wheel_right_joint")
_JPEG_QUALITY = 85
_GRAVITY = 9.80665
_NOT_MEASURED = 1e6
"""A variance so large that no reader takes it for a measurement."""
_UNKNOWN = -1.0
"""The first element of a covariance of something that is not measured."""


def body_message(now: float, told: Readings, bin_capacity: float, frame_id: str) -> BodyState:
    """Return all that a body tells but its scan; the bin holds ``bin_capacity``, g."""
    where, moves, cliff, battery = told.odometry, told.twist, told.cliff, told.battery
    return BodyState(
        header=header(now, frame_id),
        x=where.x,
        y=where.y,
        theta=where.theta,
        linear=moves.linear,
        angular=moves.angular,
        turning=math.nan if told.turning is None else told.turning,
        is_left_pressed=told.bumper_left,
        is_right_pressed=told.bumper_right,
        is_cliff_left=cliff.left,
        is_cliff_front_left=cliff.front_left,
        is_cliff_front_right=cliff.front_right,
        is_cliff_right=cliff.right,
        is_left_dropped=told.dropped_left,
        is_right_dropped=told.dropped_right,
        ir_omni=code_of_beams(told.beams),
        battery=battery.level,
        battery_capacity=battery.capacity,
        is_docked=battery.is_docked,
        dirt_detect=told.grains,
        bin_level=told.in_bin / bin_capacity,
        brush_current=told.brush_current,
    )


def scan_message(
    now: float, ranges: NDArray[np.float32], config: LidarConfig, frame_id: str
) -> LaserScan:
    """Return a scan, float32 [beams], m, counter-clockwise; ``now``: when its first beam was."""
    first, step = config.first_angle, config.beam_step
    return LaserScan(
        header=header(now, frame_id),
        angle_min=first,
        angle_max=first + step * (len(ranges) - 1),
        angle_increment=step,
        time_increment=config.time_increment,
        scan_time=1.0 / config.rate,
        range_min=config.min_range,
        range_max=config.max_range,
        # A list, not the array: genpy serializes arrays many times slower.
        ranges=ranges.tolist(),
    )


def imu_message(now: float, seen: Observation, config: SimulatedGyro, frame_id: str) -> Imu:
    """Return what gyro (about the vertical) and accelerometer (ahead) measure."""
    message = Imu(header=header(now, frame_id))
    message.orientation.w = 1.0
    message.orientation_covariance[0] = _UNKNOWN
    message.angular_velocity.z = seen.angular_velocity
    # The floor is level: about the other axes nothing turns. Sideways is not measured.
    for axis in (0, 4, 8):
        message.angular_velocity_covariance[axis] = config.noise**2
    message.linear_acceleration.x = seen.acceleration
    message.linear_acceleration.z = _GRAVITY
    for axis, variance in ((0, config.acceleration_noise**2), (4, _NOT_MEASURED), (8, 0.01)):
        message.linear_acceleration_covariance[axis] = variance
    return message


def joints_message(now: float, seen: Observation, wheel_radius: float, track: float) -> JointState:
    """Return how far (rad) and how fast (rad/s) the wheels turned, by the encoders."""
    twist = seen.odometry_twist
    half = 0.5 * track * twist.angular
    return JointState(
        header=header(now, ""),
        name=list(WHEEL_JOINTS),
        position=[seen.wheels.left, seen.wheels.right],
        velocity=[(twist.linear - half) / wheel_radius, (twist.linear + half) / wheel_radius],
    )


def battery_message(now: float, told: Readings, config: BatteryConfig) -> BatteryMessage:
    """Return the battery of a body that tells only its level, and whether it is being charged."""
    return _battery(now, told.battery, config)


def measured_battery_message(
    now: float, battery: BatteryState, config: BatteryConfig
) -> BatteryMessage:
    """Return the battery of a body that also measures voltage, current and temperature."""
    message = _battery(now, battery, config)
    message.voltage = battery.voltage
    message.temperature = battery.temperature
    message.current = battery.current
    message.power_supply_health = BatteryMessage.POWER_SUPPLY_HEALTH_GOOD
    return message


def _battery(now: float, battery: Battery | BatteryState, config: BatteryConfig) -> BatteryMessage:
    whole = battery.capacity / config.nominal_voltage
    status = BatteryMessage.POWER_SUPPLY_STATUS_DISCHARGING
    if battery.is_docked:
        status = BatteryMessage.POWER_SUPPLY_STATUS_CHARGING
        if battery.level >= 1.0:
            status = BatteryMessage.POWER_SUPPLY_STATUS_FULL
    return BatteryMessage(
        header=header(now, ""),
        voltage=math.nan,
        temperature=math.nan,
        current=math.nan,
        charge=battery.level * whole,
        capacity=whole,
        design_capacity=whole,
        percentage=battery.level,
        power_supply_status=status,
        power_supply_technology=BatteryMessage.POWER_SUPPLY_TECHNOLOGY_LION,
        present=True,
    )


def bumper_message(now: float, told: Readings, frame_id: str) -> BumperMessage:
    """Return the state of the bumper's halves."""
    return BumperMessage(header(now, frame_id), told.bumper_left, told.bumper_right)


def cliff_message(now: float, told: Readings, frame_id: str) -> CliffMessage:
    """Return which cliff sensors see no floor."""
    cliff = told.cliff
    return CliffMessage(
        header(now, frame_id), cliff.left, cliff.front_left, cliff.front_right, cliff.right
    )


def wheel_drop_message(now: float, told: Readings, frame_id: str) -> WheelDrop:
    """Return which wheels hang in the air."""
    return WheelDrop(header(now, frame_id), told.dropped_left, told.dropped_right)


def dock_message(now: float, told: Readings, frame_id: str) -> DockStatus:
    """Return whether the station is seen, and whether the contacts touch."""
    return DockStatus(header(now, frame_id), told.beams != NO_BEAMS, told.battery.is_docked)


def hazards_of(told: Readings, *, is_stalled: bool = False) -> tuple[int, ...]:
    """Return the types of HazardDetection that hold.

    ``is_stalled``: a wheel is held that should turn, which not every body tells.
    """
    found = (
        (HazardDetection.BUMP, told.bumps),
        (HazardDetection.CLIFF, told.cliff.any),
        (HazardDetection.STALL, is_stalled),
        (HazardDetection.WHEEL_DROP, told.dropped_left or told.dropped_right),
    )
    return tuple(kind for kind, holds in found if holds)


def hazards_message(now: float, kinds: tuple[int, ...], frame_id: str) -> HazardDetectionVector:
    """Return hazards by their types."""
    at = header(now, frame_id)
    return HazardDetectionVector(at, [HazardDetection(at, kind) for kind in kinds])


def diagnostics_message(now: float, parts: Iterable[PartHealth], robot: str) -> DiagnosticArray:
    """Return the health of a robot's parts (REP 107)."""
    return DiagnosticArray(
        header(now, ""),
        [
            DiagnosticStatus(
                level=int(part.level),
                name=f"{robot}: {part.name}",
                message=part.message,
                hardware_id=robot,
                values=[KeyValue(key, value) for key, value in part.values.items()],
            )
            for part in parts
        ],
    )


def camera_info_message(
    now: float, config: CameraConfig, focal: float, frame_id: str
) -> CameraInfo:
    """Return the geometry of a lens without distortion; ``focal`` in pixels."""
    middle_x, middle_y = config.width / 2.0 - 0.5, config.height / 2.0 - 0.5
    return CameraInfo(
        header=header(now, frame_id),
        height=config.height,
        width=config.width,
        distortion_model="plumb_bob",
        D=[0.0] * 5,
        K=[focal, 0.0, middle_x, 0.0, focal, middle_y, 0.0, 0.0, 1.0],
        R=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        P=[focal, 0.0, middle_x, 0.0, 0.0, focal, middle_y, 0.0, 0.0, 0.0, 1.0, 0.0],
    )


def compressed_message(now: float, picture: NDArray[np.uint8], frame_id: str) -> CompressedImage:
    """Return a colour picture, uint8 [height, width, 3] RGB, as JPEG."""
    packed = io.BytesIO()
    Picture.fromarray(picture).save(packed, "JPEG", quality=_JPEG_QUALITY)
    # As cv_bridge reads and writes it: OpenCV's order of the colours.
    return CompressedImage(header(now, frame_id), "rgb8; jpeg compressed bgr8", packed.getvalue())


def depth_message(now: float, depth: NDArray[np.float32], frame_id: str) -> Image:
    """Return distances along the optical axis, float32 [height, width], m (REP 118)."""
    height, width = depth.shape
    return Image(
        header=header(now, frame_id),
        height=height,
        width=width,
        encoding="32FC1",
        is_bigendian=0,
        step=4 * width,
        data=np.ascontiguousarray(depth).tobytes(),
    )


def sim_home_message(now: float, home: HomeNow, frame_id: str) -> SimHome:
    """Return how a home really is."""
    things = [Polygon([Point32(x, y, 0.0) for x, y in outline]) for outline in home.things]
    doors = [_door_message(door) for door in home.doors]
    return SimHome(header(now, frame_id), things, doors, home.is_lifted)


def _door_message(door: DoorNow) -> DoorMessage:
    return DoorMessage(door.name, Rectangle(*door.opening), door.is_shut)


def sim_dirt_message(
    now: float, frame: GridFrame, share: NDArray[np.float64], frame_id: str
) -> OccupancyGrid:
    """Return dirt, float64 [rows, columns] of 0 clean to 1 the dirtiest, as 0 to 100."""
    cells = np.rint(100.0 * share).astype(np.int8)
    return map_message(now, OccupancyMap(frame, cells), frame_id)
