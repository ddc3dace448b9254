"""The topics of the robot's sensors: message, rate, and frame of each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from roomba_robot.msg import BodyState, Bumper, Cliff, DockStatus, HazardDetectionVector, WheelDrop
from sensor_msgs.msg import BatteryState, Imu, JointState, LaserScan
from std_msgs.msg import Float32, UInt16

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.headless.body import readings_of
from roomba.world.engine.state.arrays import code_of
from roomba.world.health import health_of
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator
from roomba_ros.convert.sensors import (
    battery_message,
    body_message,
    bumper_message,
    cliff_message,
    diagnostics_message,
    dock_message,
    hazards_message,
    hazards_of,
    imu_message,
    joints_message,
    scan_message,
    wheel_drop_message,
)
from roomba_ros.runtime.node import frame_id
from roomba_ros.runtime.timing.wall_period import WallPeriod

_REPEATED_AFTER: Final = 0.1
"""s of wall time between two messages that tell the same."""


@dataclass(slots=True)
class _Topic:
    """A topic: ``message(now, seen)`` every ``period`` ticks; at once when ``changes(seen)`` does.

    Without a subscriber no message is made.
    """

    publisher: rospy.Publisher
    period: int
    message: Callable[[float, Observation], Any]
    changes: Callable[[Observation], object] | None = None
    told: object = None
    repeated: WallPeriod = field(default_factory=lambda: WallPeriod(_REPEATED_AFTER))

    def tell(self, now: float, tick: int, seen: Observation) -> None:
        """Publish if it is time to."""
        if self.publisher.get_num_connections() == 0:
            return
        state = self.changes(seen) if self.changes else None
        if state != self.told or (tick % self.period == 0 and self._is_due()):
            self.told = state
            self.repeated.begin()
            self.publisher.publish(self.message(now, seen))

    def _is_due(self) -> bool:
        """Whether a message is new, or the last one is not repeated too soon on a fast clock."""
        return self.changes is None or self.repeated.is_over()


class SensorTopics:
    """Tells what the sensors sense.

    Publishes: ``scan`` as often as the lidar has one; ``body`` (all that the others tell to a
    robot's brain, and odometry), 20 Hz; ``dirt_raw`` (Float32, g under the body) and
    ``brush_current`` (Float32, A), 10 Hz; ``imu``, ``joint_states`` and ``dirt_detect`` (UInt16,
    grains per second), 20 Hz; ``bin_level`` (Float32, 0..1), 1 Hz and when it is emptied; and at
    each change, but also 5 times a second, ``bumper``, ``cliff``, ``wheel_drop`` and ``ir_omni``
    (UInt16, the station's beams as Create 2 codes them), or once a second ``hazard_detection``,
    ``battery_state`` and ``dock_status``. ``/diagnostics`` (health of the parts) and
    ``noise_level`` (Float32, dB(A) at 1 m), 1 Hz. On a fast clock what did not change is told 10
    times a second of wall time at most.
    """

    def __init__(self, config: SimulatedRobotConfig, simulator: Simulator, robot: str) -> None:
        """Connect all of them; ``robot`` is its name."""
        self._config, self._simulator = config, simulator
        self._scans = 0
        base, laser, gyro = frame_id("base_link"), frame_id("laser"), frame_id("imu_link")
        odom = frame_id("odom")
        body, capacity, truth = config.body, config.brush.bin_capacity, config.simulation
        self._scan = rospy.Publisher("scan", LaserScan, queue_size=1, tcp_nodelay=True)
        self._laser = laser
        self._topics = [
            _topic(
                "body",
                BodyState,
                1,
                lambda now, seen: body_message(now, readings_of(seen, None), capacity, odom),
            ),
            _topic(
                "bumper",
                Bumper,
                4,
                lambda now, seen: bumper_message(now, seen.bumper, base),
                lambda seen: seen.bumper,
            ),
            _topic(
                "cliff",
                Cliff,
                4,
                lambda now, seen: cliff_message(now, seen.cliff, base),
                lambda seen: seen.cliff,
            ),
            _topic(
                "wheel_drop",
                WheelDrop,
                4,
                lambda now, seen: wheel_drop_message(now, seen.wheels, base),
                lambda seen: (seen.wheels.dropped_left, seen.wheels.dropped_right),
            ),
            _topic(
                "hazard_detection",
                HazardDetectionVector,
                20,
                lambda now, seen: hazards_message(now, hazards_of(seen), base),
                hazards_of,
            ),
            _topic("imu", Imu, 1, lambda now, seen: imu_message(now, seen, truth.gyro, gyro)),
            _topic(
                "joint_states",
                JointState,
                1,
                lambda now, seen: joints_message(
                    now, seen, 0.5 * body.wheel_diameter, body.wheel_separation
                ),
            ),
            _topic(
                "battery_state",
                BatteryState,
                20,
                lambda now, seen: battery_message(now, seen.battery, config.battery),
                lambda seen: seen.battery.is_docked,
            ),
            _topic(
                "dock_status",
                DockStatus,
                20,
                lambda now, seen: dock_message(
                    now, base, is_seen=bool(seen.infrared), is_docked=seen.battery.is_docked
                ),
                lambda seen: (bool(seen.infrared), seen.battery.is_docked),
            ),
            _topic(
                "ir_omni",
                UInt16,
                4,
                lambda _, seen: UInt16(code_of(seen.infrared)),
                lambda seen: seen.infrared,
            ),
            _topic("dirt_raw", Float32, 2, lambda _, seen: Float32(seen.dirt_under)),
            _topic("dirt_detect", UInt16, 1, lambda _, seen: UInt16(int(seen.grains))),
            _topic("brush_current", Float32, 2, lambda _, seen: Float32(seen.brush_current)),
            _topic(
                "bin_level",
                Float32,
                20,
                lambda _, seen: Float32(seen.in_bin / capacity),
                lambda seen: seen.in_bin == 0.0,
            ),
            _topic("noise_level", Float32, 20, lambda _, __: Float32(simulator.noise_level)),
            _topic(
                "/diagnostics",
                DiagnosticArray,
                20,
                lambda now, seen: diagnostics_message(
                    now, health_of(seen, simulator.ranges, capacity, simulator.config.health), robot
                ),
            ),
        ]

    def tell(self, now: float, tick: int, seen: Observation) -> None:
        """Publish what is due at a tick; ``now`` is the time for stamps, s."""
        for topic in self._topics:
            topic.tell(now, tick, seen)
        if seen.scans != self._scans:
            self._scans = seen.scans
            if self._scan.get_num_connections() > 0:
                ranges = self._simulator.ranges
                taken = now - (seen.time - seen.scan_stamp if self._config.is_swept else 0.0)
                self._scan.publish(scan_message(taken, ranges, self._config.lidar, self._laser))


def _topic(
    name: str,
    kind: type,
    period: int,
    message: Callable[[float, Observation], Any],
    changes: Callable[[Observation], object] | None = None,
) -> _Topic:
    publisher = rospy.Publisher(name, kind, queue_size=1, tcp_nodelay=True)
    return _Topic(publisher, period, message, changes)
