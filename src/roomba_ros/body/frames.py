"""The frames of the body's parts: where its sensors are mounted, and how its wheels turned."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from geometry_msgs.msg import TransformStamped

from roomba.configuration.robot import RobotConfig
from roomba_ros.convert.common import mount_message
from roomba_ros.convert.sensors import WHEEL_JOINTS
from roomba_ros.runtime.node import frame_id

CLIFF_SENSORS: Final = ("left", "front_left", "front_right", "right")
"""The names of the cliff sensors, in the order of their angles."""
_CLIFF_HEIGHT: Final = 0.01
"""m above the floor, where the body begins."""
_OPTICAL: Final = (-0.5 * math.pi, 0.0, -0.5 * math.pi)
"""rad; a frame that looks along its z, with x to the right and y down (REP 103)."""


class BodyFrames:
    """The frames of the model (``data/model``) below ``base_link``, as transforms."""

    def __init__(self, config: RobotConfig, named: Callable[[str], str] = frame_id) -> None:
        """Take the numbers of a body; ``named`` gives each frame its name, by default a node's."""
        self._config = config
        self._named = named
        self._base = named("base_link")
        self._wheels = tuple(named(joint.removesuffix("_joint")) for joint in WHEEL_JOINTS)

    def mounted(self) -> list[TransformStamped]:
        """Return where the sensors are, which never changes."""
        camera, lidar, cliff = self._config.camera, self._config.lidar, self._config.cliff
        named = self._named
        lens = (camera.mount_forward, 0.0, camera.mount_height)
        transforms = [
            mount_message(self._base, named("laser"), (lidar.mount_ahead, 0.0, lidar.mount_height)),
            mount_message(self._base, named("imu_link"), (0.0, 0.0, 0.0)),
            mount_message(self._base, named("camera"), lens),
            mount_message(named("camera"), named("camera_optical"), (0.0, 0.0, 0.0), _OPTICAL),
        ]
        for name, degrees in zip(CLIFF_SENSORS, cliff.angles, strict=True):
            bearing = math.radians(degrees)
            x, y = cliff.radius * math.cos(bearing), cliff.radius * math.sin(bearing)
            down = (0.0, 0.5 * math.pi, bearing)
            transforms.append(
                mount_message(self._base, named(f"cliff_{name}"), (x, y, _CLIFF_HEIGHT), down)
            )
        return transforms

    def wheels(self, now: float, left: float, right: float) -> list[TransformStamped]:
        """Return where the wheels are, turned by so many rad as their encoders count."""
        body = self._config.body
        half, up = 0.5 * body.wheel_separation, 0.5 * body.wheel_diameter
        return [
            mount_message(self._base, wheel, (0.0, side, up), (0.0, turned, 0.0), now)
            for wheel, side, turned in zip(self._wheels, (half, -half), (left, right), strict=True)
        ]
