"""Bursts: steady ticks computed at once by compiled code, on arrays of body, brain and truth."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.control.path_tracker import PathTracker
from roomba.control.tracking_kernels import TRACK
from roomba.geometry import Pose
from roomba.headless.body import SimulatedBody
from roomba.headless.burst_kernels import run
from roomba.headless.burst_state import BURST, Drive, Floor, PlaceParts, Sight, World
from roomba.headless.tick_rows import BELIEVED, BIAS, PASSED
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.dirty.watch_kernels import WATCH
from roomba.mission.driving.progress_kernels import PROGRESS
from roomba.mission.driving.way_ahead_kernels import AHEAD
from roomba.mission.steady import Steady
from roomba.perception.matching.sweep import SWEEP_WORK
from roomba.perception.slam.mapper import Mapper
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.robot.brain import Brain
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM

LONGEST_BURST: Final = 1200
"""Ticks, a minute."""
_EARLY: Final = 1e-6
"""s; a burst ends so much before a time at which the classes decide, because of rounding."""
_HARDLY_LESS: Final = 1.0 - 1e-9
"""Factor on the limits of energy and dust by which the classes decide, for the same reason."""


class Burst:
    """Computes a robot's ticks for as long as they are steady, at most ``longest`` in one burst."""

    def __init__(self, body: SimulatedBody, brain: Brain, truth: CoverageMap, longest: int) -> None:
        """Take the robot's parts; the arrays that are never replaced are taken once."""
        self._body, self._brain, self._truth = body, brain, truth
        self._world = World(*body.simulator.compiled, 0, 1)
        self._rows = np.empty((longest, PASSED))
        self._burst = np.zeros(1, BURST)
        timing, row = brain.robot_config.timing, self._burst[0]
        row["step"], row["steps"] = timing.world_step, timing.steps_per_tick
        row["apart"] = brain.keeper.scans.apart
        row["stride"] = brain.robot_config.scan_stride
        row["is_late"] = body.has_late_scans
        home = body.simulator.home
        axes, row["is_turned"] = home.axes, home.turned is not None
        row["axes"] = axes.x, axes.y, math.cos(axes.theta), math.sin(axes.theta)
        row["turn"] = axes.theta
        row["bin_capacity"] = brain.robot_config.brush.bin_capacity * MICROGRAMS_PER_GRAM
        self._has_ended = False
        self._nowhere = _nowhere(brain)
        count = body.lidar.beams
        self._sweep = np.empty(count, np.float32), np.empty((SWEEP_WORK, max(count, 3)))

    def run(self) -> Floats:
        """Compute ticks until one is not steady; return their rows, float64 [ticks, PASSED]."""
        brain = self._brain
        if self._has_ended or not self._may_run:
            # What ended the last burst most likely lasts: let the classes do this tick.
            self._has_ended = False
            return self._rows[:0]
        senses = brain.senses()
        steady = brain.mission.steady(senses)
        if steady is None:
            return self._rows[:0]
        start, next_look = (senses.pose.x, senses.pose.y), self._next_look
        self._begin(steady)
        ticks = run(
            self._burst,
            self._world,
            self._place(),
            self._sight(),
            self._drive(steady),
            self._floor(),
            self._rows,
        )
        rows = self._rows[:ticks].copy()
        if ticks:
            believed = self._end(np.vstack((start, rows[:-1, BELIEVED][:, :2])))
            has_looked = self._next_look != next_look
            is_done = bool(self._burst[0]["is_left"]) or has_looked
            self._has_ended = ticks < len(self._rows) and not is_done
            # The end of a burst finishes the scan under way: place and bias may differ from those
            # of its last tick.
            rows[-1, BELIEVED] = believed.x, believed.y, believed.theta
            rows[-1, BIAS] = brain.keeper.gyro_bias
        return rows

    @property
    def _next_look(self) -> float:
        """When the classes look at a growing map again, s; infinite without one."""
        growing = self._brain.growing
        return math.inf if growing is None else growing.next_look

    @property
    def _mapper(self) -> Mapper | None:
        """The mapper, while there is no localizer."""
        return self._brain.mapper if self._brain.localizer is None else None

    @property
    def _cleaned(self) -> CoverageMap:
        """The coverage of the clean under way; without a clean the truth's stands in its place."""
        cleaning = self._brain.mission.cleaning
        return self._truth if cleaning is None else cleaning.ledger.coverage

    @property
    def _may_run(self) -> bool:
        if len(self._rows) == 0 or self._brain.walking.is_under_way:
            return False
        return self._brain.keeper.place.is_calm

    def _begin(self, steady: Steady) -> None:
        """Copy the state of the classes into the burst."""
        brain, row = self._brain, self._burst[0]
        mission, last = brain.mission, brain.mission.last
        until = min(steady.until, self._next_look)
        capacity = brain.robot_config.battery.capacity
        row["drives"], row["limit"] = steady.driver is not None, steady.limit
        row["until"] = until - _EARLY
        row["least_charge"] = steady.least_level * capacity / _HARDLY_LESS
        row["most_charge"] = steady.most_energy * _HARDLY_LESS
        row["goal"], row["near"] = steady.goal, steady.near
        row["watches_dirt"] = steady.watches_dirt
        row["most_in_bin"] = steady.most_in_bin * MICROGRAMS_PER_GRAM * _HARDLY_LESS
        row["most_silent"] = steady.most_silent
        row["cell_area"] = self._cleaned.cell_area
        if steady.driver is not None:
            row["off_path"] = brain.config.driving.off_path
        row["felt_version"] = mission.obstacles.felt_version
        row["clock"] = brain.readings.time - self._body.simulator.time
        row["scans"], row["seen_at"] = self._body.scans, brain.keeper.scans.seen_at
        mapper = self._mapper
        if mapper is not None:
            at = mapper.at_scan
            row["at_scan"] = at.x, at.y, at.theta
            row["submap"] = mapper.submap_pose
            row["unsure"] = mapper.estimate.position_deviation
        row["last"], row["way"] = (last.now, last.pose.x, last.pose.y), 0.0
        row["sweeps"] = mission.sweeps
        cleaning = mission.cleaning
        row["swept_at"] = _place_of(None if cleaning is None else cleaning.ledger.coverage.at)
        row["true_at"] = _place_of(self._truth.at)
        row["swept"] = row["truth_swept"] = 0
        row["is_left"] = row["is_followed"] = False

    def _place(self) -> PlaceParts:
        brain = self._brain
        beams = brain.beams_of(brain.keeper.lidar(self._body.lidar))
        localizer, mapper = brain.localizer, self._mapper
        sights = None if localizer is None else localizer.sights(self._body.lidar.beams)
        following = None if mapper is None else mapper.following
        place = brain.keeper.place
        return PlaceParts(
            place.belief, place.numbers, place.path, beams, sights, following, *self._sweep
        )

    def _sight(self) -> Sight:
        things = self._brain.things
        return Sight(things.arrays, things.field.values, things.field.place)

    def _drive(self, steady: Steady) -> Drive:
        driver = steady.driver
        if driver is None:
            return self._nowhere
        tracker = driver.tracker
        before, ahead = np.zeros(1, TRACK), driver.ahead.rows
        return Drive(tracker.state, before, tracker.course, driver.progress, ahead)

    def _floor(self) -> Floor:
        """Return the arrays of the floor that is cleaned now."""
        mission, truth, coverage = self._brain.mission, self._truth, self._cleaned
        dirt = mission.dirt
        return Floor(
            coverage.cells,
            coverage.place,
            truth.cells,
            truth.place,
            truth.radius,
            dirt.grains,
            dirt.way,
            dirt.place,
            mission.dust,
            mission.carpet.rows,
            *_watched(mission.cleaning),
        )

    def _end(self, places: Floats) -> Pose:
        """Hand the state back to the classes; ticks began at ``places``, float64 [n, 2], m.

        Returns the pose that the robot believes.
        """
        brain, row = self._brain, self._burst[0]
        mission = brain.mission
        self._tell_floor()
        self._body.scans = int(row["scans"])
        brain.keeper.scans.resumed(float(row["seen_at"]))
        readings, clock = self._body.read(), float(row["clock"])
        if clock != 0.0:
            readings = replace(readings, time=readings.time + clock)
        brain.drove_on(readings)
        self._finish_scan(readings.time)
        time, x, y = row["last"].tolist()
        senses = brain.senses()
        last = replace(senses, now=time, pose=Pose(x, y, 0.0))
        mission.caught_up(last, places, float(row["way"]))
        brain.use_newer_map()
        return senses.pose

    def _tell_floor(self) -> None:
        """Hand back to the classes what was swept."""
        row, cleaning = self._burst[0], self._brain.mission.cleaning
        if row["sweeps"] and cleaning is not None:
            x, y = row["swept_at"].tolist()
            cleaning.ledger.coverage.resumed(int(row["swept"]), (x, y))
        x, y = row["true_at"].tolist()
        self._truth.resumed(int(row["truth_swept"]), (x, y))

    def _finish_scan(self, now: float) -> None:
        """Process the rest of the newest scan."""
        brain, scan = self._brain, None
        if self._burst[0]["is_left"]:
            scan = self._body.newest_scan()
            late = scan.stamp + float(self._burst[0]["clock"])
            stamp = late if self._body.has_late_scans else now
            scan = replace(scan, stamp=stamp, lidar=brain.keeper.lidar(scan.lidar))
        if brain.localizer is not None:
            brain.localizer.resumed(now)
            if scan is not None:
                brain.localizer.reconsider(scan.stamp, scan.ranges, scan.lidar)
                scan = brain.keeper.recalibrated(replace(scan, lidar=self._body.lidar))
        elif brain.mapper is not None:
            brain.mapper.resumed()
            if scan is not None and self._burst[0]["is_followed"]:
                brain.mapper.finish_scan(scan.stamp, scan.ranges)
            elif scan is not None:
                brain.mapper.see(scan.stamp, scan.ranges, scan.lidar)
        if scan is not None:
            brain.look()


def _place_of(place: tuple[float, float] | None) -> tuple[float, float]:
    return (np.nan, np.nan) if place is None else place


def _watched(cleaning: Cleaning | None) -> tuple[NDArray[np.void], NDArray[np.bool_]]:
    """Return what a clean remembers of its search for dirty floor."""
    return _UNWATCHED if cleaning is None else (cleaning.dirty.watch, cleaning.dirty.done)


def _nowhere(brain: Brain) -> Drive:
    """Return the drive of a robot that stands."""
    robot = brain.robot_config
    points = np.array([[0.0, 0.0], [1.0, 0.0]])
    tracker = PathTracker(points, robot.tracking, robot.body, robot.timing.tick)
    before, progress, ahead = np.zeros(1, TRACK), np.zeros(1, PROGRESS), np.zeros(1, AHEAD)
    return Drive(tracker.state, before, tracker.course, progress, ahead)


_UNWATCHED: Final = np.zeros(1, WATCH), np.zeros((1, 1), np.bool_)
