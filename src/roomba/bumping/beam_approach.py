"""Docking by the station's beams, for a robot that knows neither its pose nor the station's.

The receiver tells which beams it sees, but not from which direction they come. Where the robot
crosses the middle of the beams, it knows on which side of it the station is. It turns to that side,
backs off, and drives at the station, steering by the beam that it sees. Places where it sees both
beams tell the direction of the station more exactly.
"""

from __future__ import annotations

import math
from enum import Enum

from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import STANDSTILL, Pose, Twist, wrap_angle
from roomba.robot.readings import Readings

_QUARTER = 0.5 * math.pi


class Approach(Enum):
    """The stage of an approach."""

    CROSSING = "through the beams, until their middle was crossed"
    FACING = "turning to the station"
    BACKING = "backing off, to see which way the beams lead"
    DRIVING = "driving at the station"
    DOCKED = "docked"
    LOST = "it has to find the beams again"


class BeamApproach:
    """One approach to the station, from the first beam on; poses are by odometry."""

    def __init__(self, config: BumpingConfig) -> None:
        """Begin."""
        self._config = config
        self.state = Approach.CROSSING
        self._side = 0
        self._crossed_to = self._told = self._learned = 0.0
        self._middles: list[Pose] = []
        self._entered: Pose | None = None
        self._seen_at = self._since = math.inf
        self._last = math.inf
        self._attempts = 0

    def tick(self, readings: Readings) -> Twist:
        """Return the twist that is wanted now."""
        now = readings.time
        dt, self._last = min(max(now - self._last, 0.0), 0.1), now
        if self._entered is None:
            self._seen_at = now
            self._enter(Approach.CROSSING, readings)
        if readings.beams.leads:
            self._seen_at = now
        if readings.battery.is_docked:
            self._enter(Approach.DOCKED, readings)
        match self.state:
            case Approach.CROSSING:
                return self._cross(readings)
            case Approach.FACING:
                return self._face(readings)
            case Approach.BACKING:
                return self._back_off(readings)
            case Approach.DRIVING:
                return self._drive(readings, dt)
            case _:
                return STANDSTILL

    def _enter(self, state: Approach, readings: Readings) -> Twist:
        self.state, self._entered, self._since = state, readings.odometry, readings.time
        return STANDSTILL

    def _way(self, readings: Readings) -> float:
        entered = self._entered or readings.odometry
        return readings.odometry.distance_to(entered.x, entered.y)

    def _cross(self, readings: Readings) -> Twist:
        config = self._config
        is_gone = readings.time - self._seen_at > config.beams_gone
        is_far = self._way(readings) > config.beam_way
        if is_gone or is_far or readings.bumps or readings.cliff.any:
            return self._enter(Approach.LOST, readings)
        side = self._crossed_from(readings)
        if side == 0:
            return Twist(config.beam_speed, 0.0)
        # A robot that crosses from the green side to the red one has the station on its left.
        self._crossed_to = self._told = readings.odometry.theta + side * _QUARTER
        return self._enter(Approach.FACING, readings)

    def _crossed_from(self, readings: Readings) -> int:
        """Return from which side the robot crossed the middle: 1 green, -1 red, 0 not crossed."""
        beams, before = readings.beams, self._side
        side = int(beams.green) - int(beams.red)
        self._side = side or before
        if beams.green and beams.red:
            self._note_middle(readings.odometry)
            return before
        if side != 0 and before == 0 and self._middles:
            # The robot began in the middle and leaves it to this side.
            return -side
        return before if side * before < 0 else 0

    @property
    def _heading(self) -> float:
        """Heading to the station, rad: by the beams' middle, corrected while driving."""
        return wrap_angle(self._told + self._learned)

    def _note_middle(self, pose: Pose) -> None:
        """Remember a place in the middle of the beams; two of them tell where the beams lead."""
        apart = self._config.middles_apart
        for middle in reversed(self._middles):
            if middle.distance_to(pose.x, pose.y) >= apart:
                along = math.atan2(pose.y - middle.y, pose.x - middle.x)
                if math.cos(along - self._crossed_to) < 0.0:
                    along += math.pi
                self._told, self._learned = along, 0.0
                break
        self._middles.append(pose)

    def _face(self, readings: Readings) -> Twist:
        wrong = wrap_angle(self._heading - readings.odometry.theta)
        took = readings.time - self._since
        if abs(wrong) <= self._config.aimed or took > math.tau / self._config.turning_speed:
            return self._enter(Approach.BACKING, readings)
        return Twist(0.0, math.copysign(self._config.turning_speed, wrong))

    def _back_off(self, readings: Readings) -> Twist:
        config = self._config
        took = readings.time - self._since
        way = config.beam_back
        if self._way(readings) >= way or took > 2.0 * way / config.beam_speed:
            self._attempts += 1
            if self._attempts > config.beam_attempts:
                return self._enter(Approach.LOST, readings)
            self._seen_at = readings.time
            return self._enter(Approach.DRIVING, readings)
        wrong = wrap_angle(self._heading - readings.odometry.theta)
        return Twist(-config.beam_speed, max(min(2.0 * wrong, 1.0), -1.0))

    def _drive(self, readings: Readings, dt: float) -> Twist:
        """Drive at the station; the beam that is seen corrects the aim and the learned heading."""
        config, beams = self._config, readings.beams
        way = self._way(readings)
        # At the beginning the robot may still be too far away for the beams.
        is_gone = readings.time - self._seen_at > config.beams_gone and way > 1.5 * config.beam_back
        is_past = way > config.beam_way + config.beam_back
        if is_gone or is_past or (readings.bumps and way > config.backing_way):
            return self._enter(Approach.BACKING, readings)
        if readings.cliff.any:
            return self._enter(Approach.LOST, readings)
        side = int(beams.green) - int(beams.red)
        if beams.green and beams.red:
            self._note_middle(readings.odometry)
        learned = self._learned - side * config.beam_learning * dt
        self._learned = min(max(learned, -config.beam_doubt), config.beam_doubt)
        aim = self._heading - side * config.beam_aside
        wrong = wrap_angle(aim - readings.odometry.theta)
        speed = config.beam_speed * (0.5 if beams.halo else 1.0)
        share = max(0.0, 1.0 - abs(wrong))
        return Twist(speed * share, max(min(2.0 * wrong, 1.0), -1.0))
