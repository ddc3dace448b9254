"""The simulated body of a headless robot: its sensors and its drive."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from roomba.configuration.sensors import LidarConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import Battery, EmptyingTold
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.command import Command
from roomba.robot.readings import CliffReading, Readings, ScanReading
from roomba.vocabulary import NO_REASON
from roomba.world.engine.state.arrays import Infrared
from roomba.world.home.home import Home
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator


class SimulatedBody:
    """One robot's body in one home.

    It never has ``trouble``; another :class:`roomba.robot.body.Body` may be out of reach.
    ``seen`` is the observation after the last tick, with the truth and what the sensors measured;
    ``scans`` is the number of scans by then; ``has_late_scans`` says that scans are older than the
    tick at which they arrive.
    """

    trouble = NO_REASON

    def __init__(
        self,
        home: Home,
        robot: SimulatedRobotConfig,
        seed: int,
        max_speed: float | None,
        start: Pose | None,
    ) -> None:
        """Put the body on its station, or at ``start``; raises HomeError where it does not fit."""
        self.simulator = Simulator(home, robot, seed=seed, max_speed=max_speed, start=start)
        self.lidar = lidar_model(robot.lidar)
        self.has_late_scans = robot.is_swept
        self._timing, self._usual = robot.timing, (robot.brush.duty, robot.fan.duty)
        self._wanted: tuple[float | None, float | None] = (None, None)
        self.seen = self.simulator.observe()
        self.scans = 0

    def read(self) -> Readings:
        """Return what the sensors tell now."""
        self.seen = seen = self.simulator.observe()
        scan = None
        if seen.scans != self.scans:
            self.scans = seen.scans
            scan = self.newest_scan()
        return replace(readings_of(seen, scan), emptying=self._emptying())

    def _emptying(self) -> EmptyingTold | None:
        station = self.simulator.emptying
        return None if station is None else EmptyingTold(station.is_at_work, station.bag)

    def newest_scan(self) -> ScanReading:
        """Return the newest scan; a sweep is stamped with the time of its first beam."""
        stamp = self.seen.scan_stamp if self.has_late_scans else self.seen.time
        return ScanReading(stamp, self.simulator.ranges, self.lidar)

    def act(self, command: Command) -> None:
        """Carry out a command for one tick."""
        self._set_power(command.brush, command.fan)
        station = self.simulator.emptying
        if station is not None:
            station.is_wanted = command.empties
        timing = self._timing
        self.simulator.advance(command.twist, timing.world_step, timing.steps_per_tick)

    def locate(self) -> None:
        """Make no sound: it has no speaker."""

    def _set_power(self, brush: float | None, fan: float | None) -> None:
        """Set the duties of brush and fan, 0..1, where they change; None: the configured one."""
        if (brush, fan) == self._wanted:
            return
        self._wanted = brush, fan
        usual_brush, usual_fan = self._usual
        self.simulator.set_power(
            usual_brush if brush is None else brush, usual_fan if fan is None else fan
        )


def lidar_model(config: LidarConfig) -> LidarModel:
    """Return where the beams of a lidar go."""
    angles = config.first_angle + np.arange(config.beams) * config.beam_step
    reach = config.min_range, config.max_range
    mount = Pose(config.mount_ahead, 0.0, 0.0)
    return LidarModel(angles, *reach, mount, time_increment=config.time_increment)


def readings_of(seen: Observation, scan: ScanReading | None) -> Readings:
    """Return what the sensors tell, without the truth."""
    cliff, wheels, infrared, battery = seen.cliff, seen.wheels, seen.infrared, seen.battery
    return Readings(
        seen.time,
        seen.odometry,
        twist=seen.odometry_twist,
        turning=seen.angular_velocity,
        scan=scan,
        bumper_left=seen.bumper.left,
        bumper_right=seen.bumper.right,
        cliff=CliffReading(cliff.left, cliff.front_left, cliff.front_right, cliff.right),
        dropped_left=wheels.dropped_left,
        dropped_right=wheels.dropped_right,
        beams=StationBeams(
            Infrared.HALO in infrared, Infrared.GREEN in infrared, Infrared.RED in infrared
        ),
        battery=Battery(battery.level, battery.capacity, battery.is_docked),
        grains=seen.grains,
        in_bin=seen.in_bin,
        brush_current=seen.brush_current,
    )
