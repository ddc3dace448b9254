"""The topics of the simulated robot's sensors: those of any body, and those that it alone has."""

from __future__ import annotations

from typing import Final

from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import BatteryState, Imu, JointState
from std_msgs.msg import Float32, UInt16

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.headless.body import lidar_model, readings_of
from roomba.robot.readings import Readings, ScanReading
from roomba.world.health import health_of
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator
from roomba_ros.body.told_topic import ToldTopic
from roomba_ros.body.told_topics import ToldTopics
from roomba_ros.convert.sensors import (
    diagnostics_message,
    hazards_of,
    imu_message,
    joints_message,
    measured_battery_message,
)
from roomba_ros.runtime.node import frame_id

_EACH: Final = 1
_OFTEN: Final = 2
_SELDOM: Final = 20
"""Ticks between two messages."""


class SensorTopics:
    """Tells what the sensors sense.

    Publishes: what :class:`ToldTopics` tells, with stalled wheels as hazards, and voltage, current
    and temperature of the battery; ``dirt_raw`` (Float32, g under the body) and
    ``brush_current`` (Float32, A), 10 Hz; ``imu``, ``joint_states`` and ``dirt_detect`` (UInt16,
    grains per second), 20 Hz; ``bin_level`` (Float32, 0..1), 1 Hz and when it is emptied;
    ``/diagnostics`` (health of the parts) and ``noise_level`` (Float32, dB(A) at 1 m), 1 Hz.
    """

    def __init__(self, config: SimulatedRobotConfig, simulator: Simulator, robot: str) -> None:
        """Connect all of them; ``robot`` is its name."""
        self._config, self._simulator = config, simulator
        self._lidar, self._scans = lidar_model(config.lidar), 0
        self._seen = simulator.observe()
        self._body = ToldTopics(config, self._hazards, self._battery)
        gyro, truth, capacity = frame_id("imu_link"), config.simulation, config.brush.bin_capacity
        radius, track = 0.5 * config.body.wheel_diameter, config.body.wheel_separation
        self._topics: list[ToldTopic[Observation]] = [
            ToldTopic(
                "imu", Imu, _EACH, lambda now, seen: imu_message(now, seen, truth.gyro, gyro)
            ),
            ToldTopic(
                "joint_states",
                JointState,
                _EACH,
                lambda now, seen: joints_message(now, seen, radius, track),
            ),
            ToldTopic("dirt_raw", Float32, _OFTEN, lambda _, seen: Float32(seen.dirt_under)),
            ToldTopic("dirt_detect", UInt16, _EACH, lambda _, seen: UInt16(int(seen.grains))),
            ToldTopic(
                "brush_current", Float32, _OFTEN, lambda _, seen: Float32(seen.brush_current)
            ),
            ToldTopic(
                "bin_level",
                Float32,
                _SELDOM,
                lambda _, seen: Float32(seen.in_bin / capacity),
                lambda seen: seen.in_bin == 0.0,
            ),
            ToldTopic(
                "noise_level", Float32, _SELDOM, lambda _, __: Float32(simulator.noise_level)
            ),
            ToldTopic(
                "/diagnostics",
                DiagnosticArray,
                _SELDOM,
                lambda now, seen: diagnostics_message(
                    now, health_of(seen, simulator.ranges, capacity, simulator.config.health), robot
                ),
            ),
        ]

    def tell(self, now: float, tick: int, seen: Observation) -> None:
        """Publish what is due at a tick; ``now`` is the time for stamps, s."""
        self._seen = seen
        self._body.tell(now, tick, readings_of(seen, self._new_scan(seen)))
        for topic in self._topics:
            topic.tell(now, tick, seen)

    def _new_scan(self, seen: Observation) -> ScanReading | None:
        if seen.scans == self._scans:
            return None
        self._scans = seen.scans
        stamp = seen.scan_stamp if self._config.is_swept else seen.time
        return ScanReading(stamp, self._simulator.ranges, self._lidar)

    def _hazards(self, told: Readings) -> tuple[int, ...]:
        return hazards_of(told, is_stalled=self._seen.wheels.stalled)

    def _battery(self, now: float, _: Readings) -> BatteryState:
        return measured_battery_message(now, self._seen.battery, self._config.battery)
