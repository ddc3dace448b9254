"""Driving onto a station whose beams are computed, with a body that follows exactly."""

from __future__ import annotations

import math

import pytest

from roomba.bumping.beam_approach import Approach, BeamApproach
from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import Pose, wrap_angle
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import Battery
from roomba.robot.readings import Readings

CONFIG, TICK = BumpingConfig(), 0.05
FRONT, DOCKED = 0.2, 0.02
"""m; from the docked robot's middle to the station's front, and within which contacts touch."""


def beams_at(pose: Pose) -> StationBeams:
    """What is seen before a station whose docked robot is at the origin, looking along x."""
    ahead, aside = FRONT - pose.x, pose.y
    away, angle = math.hypot(ahead, aside), math.degrees(math.atan2(aside, ahead))
    is_seen = away < 1.0
    return StationBeams(
        away < 0.6, is_seen and -2.0 < angle < 20.0, is_seen and -20.0 < angle < 2.0
    )


class Approached:
    """A body before the station."""

    def __init__(self, pose: Pose) -> None:
        self.pose, self.time = pose, 0.0
        self.approach = BeamApproach(CONFIG)

    def tick(self) -> None:
        pose = self.pose
        is_docked = pose.x > -DOCKED and abs(pose.y) < 0.03 and abs(pose.theta) < 0.3
        is_in_front = pose.x > -DOCKED and abs(wrap_angle(pose.theta)) < 1.5
        twist = self.approach.tick(
            Readings(
                self.time,
                # Its odometry began somewhere.
                Pose(3.0, -2.0, 1.0).compose(pose),
                beams=beams_at(pose),
                bumper_left=is_in_front,
                battery=Battery(0.5, 40.0, is_docked),
            )
        )
        turn, way = twist.angular * TICK, twist.linear * TICK
        moved = pose.compose(Pose(way * math.cos(turn / 2), way * math.sin(turn / 2), turn))
        # The station stands in its way.
        self.pose = Pose(min(moved.x, 0.0), moved.y, moved.theta)
        self.time += TICK

    def to_the_end(self) -> Approach:
        while self.time < 300.0:
            self.tick()
            if self.approach.state in (Approach.DOCKED, Approach.LOST):
                return self.approach.state
        raise AssertionError(f"no end: {self.approach.state} at {self.pose}")


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("slant", [-0.6, 0.0, 0.5])
@pytest.mark.parametrize("away", [0.2, 0.5])
def test_crossing_the_beams_it_comes_onto_the_station(
    side: float, slant: float, away: float
) -> None:
    aside = side * 0.3 * (away + FRONT)
    heading = -side * (0.5 * math.pi + slant)
    robot = Approached(Pose(-away, aside, heading))
    assert robot.to_the_end() is Approach.DOCKED


def test_beams_that_vanish_and_things_that_are_touched_end_it() -> None:
    robot = Approached(Pose(-0.5, 0.1, 0.5 * math.pi))
    assert robot.to_the_end() is Approach.LOST
    touching = BeamApproach(CONFIG)
    beams = StationBeams(green=True)
    touching.tick(Readings(0.0, Pose(), beams=beams))
    touching.tick(Readings(TICK, Pose(), beams=beams, bumper_right=True))
    assert touching.state is Approach.LOST
