"""Making a map in the simulator, with the noise that sensors have: the place, and the drawing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.located import LIDAR
from fixtures.robots.mapped import (
    AROUND,
    CIRCLE,
    FURNISHED,
    START,
    Mapped,
    driven_around,
    row,
    wrong_cells,
)

from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.grid import FREE, UNKNOWN
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.mapper_state import MapperState

WORST = 0.03
"""m; farther from its true place it never is."""


@pytest.mark.parametrize("seed", range(3))
def test_it_knows_where_it_is_all_the_way(seed: int) -> None:
    robot = driven_around(seed)
    assert robot.world.numbers["distance"] > 5.0
    assert robot.worst < WORST
    assert robot.turn_error < math.radians(1.0)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.mapper.estimate.reason == ""
    assert robot.mapper.estimate.agreement > 0.7
    assert robot.mapper.hypotheses == [robot.mapper.pose]


@pytest.mark.parametrize("seed", range(2))
def test_the_finished_map_shows_the_home(seed: int) -> None:
    robot = driven_around(seed)
    made = robot.mapper.finish()
    assert wrong_cells(made, FURNISHED) == (0, 0)
    assert (made.values == FREE).sum() * 0.05**2 == pytest.approx(19.4, abs=0.3)
    assert made.frame.resolution == MappingConfig().resolution
    assert robot.error < WORST
    assert robot.turn_error < math.radians(1.0)


def test_the_map_so_far_shows_it_as_well() -> None:
    robot = driven_around(1, 5.0)
    early = robot.mapper.version
    assert wrong_cells(robot.mapper.occupancy(), FURNISHED)[0] <= 3
    robot.drive(CIRCLE, 5.0)
    assert robot.mapper.version > early
    assert wrong_cells(robot.mapper.occupancy(), FURNISHED)[0] <= 3


def test_the_same_seed_gives_the_same_map_and_another_one_another() -> None:
    maps = [driven_around(seed, 10.0).mapper for seed in (4, 4, 5)]
    finished = [mapper.finish().values.tobytes() for mapper in maps]
    assert finished[0] == finished[1]
    assert (maps[0].trajectory == maps[1].trajectory).all()
    assert maps[0].trajectory.tobytes() != maps[2].trajectory.tobytes()


def test_finished_twice_it_is_the_same() -> None:
    robot = driven_around(2)
    first = robot.mapper.finish()
    pose = robot.mapper.pose
    second = robot.mapper.finish()
    assert second.frame.extent == pytest.approx(first.frame.extent)
    assert second.frame.shape == first.frame.shape
    assert np.mean(second.values != first.values) < 0.01
    assert robot.mapper.pose.distance_to(pose.x, pose.y) < 0.003
    # And it may be driven on.
    assert robot.drive(CIRCLE, 3.0).worst < WORST


def test_a_single_scan_is_a_map() -> None:
    robot = Mapped().drive(Twist(), 0.5)
    assert len(robot.mapper.trajectory) == 1
    made = robot.mapper.finish()
    assert wrong_cells(made, FURNISHED) == (0, 0)
    assert robot.error < 0.005
    assert robot.drive(CIRCLE, AROUND).worst < WORST


def test_before_the_first_scan_there_is_no_map() -> None:
    robot = Mapped()
    assert robot.mapper.version == 0
    assert robot.mapper.pose == START
    assert robot.knowledge is not Knowledge.KNOWN
    with pytest.raises(ValueError, match="at least one scan"):
        robot.mapper.occupancy()
    with pytest.raises(ValueError, match="at least one scan"):
        robot.mapper.finish()


def test_a_scan_of_another_lidar_is_refused_but_another_lidar_may_take_over() -> None:
    """Every other beam of the old one; what was seen before is known to it, too."""
    robot = driven_around(0, 3.0)
    with pytest.raises(ValueError, match="expected a scan of 360 ranges"):
        robot.mapper.see(robot.world.time, np.ones(180, np.float32), LIDAR)
    half = LidarModel.all_around(180, 0.15, 12.0)
    version = robot.mapper.version
    robot.mapper.see(robot.world.time, robot.world.ranges[::2], half)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.error < WORST
    robot.drive(CIRCLE, 2.0)
    assert robot.mapper.version > version
    assert robot.worst < WORST


def test_the_frame_of_the_map_is_that_of_the_start() -> None:
    """Told that it stands elsewhere, and turned, it draws all moved and turned, then squares it."""
    plain = driven_around(3, 8.0)
    off = Pose(10.0, -7.0, 0.02)
    moved = Mapped(seed=3)
    mapper = moved.mapper
    mapper.__init__(  # type: ignore[misc]
        MappingConfig(), moved.world.config.localization, moved.world.config.gyro,
        off.compose(START),
    )  # fmt: skip
    moved.drive(CIRCLE, 8.0)
    expected = off.compose(plain.mapper.pose)
    assert mapper.pose.distance_to(expected.x, expected.y) < 0.001
    assert wrap_angle(mapper.pose.theta - expected.theta) == pytest.approx(0.0, abs=0.001)
    mapper.finish()
    plain.mapper.finish()
    # Walls lie along the axes then: turned back around where it began.
    turned = wrap_angle(mapper.pose.theta - plain.mapper.pose.theta)
    assert turned == pytest.approx(0.0, abs=0.002)
    assert mapper.trajectory[0, :2] == pytest.approx(row(off.compose(START))[:2], abs=0.01)


def test_submaps_that_moved_are_drawn_where_they_are_now() -> None:
    """As if all had been drawn anew: nothing is left where they were."""
    numbers = MappingConfig(submap_keyframes=6)
    robot = Mapped(seed=2, mapping=numbers).drive(CIRCLE, AROUND)
    config = robot.world.config

    def another(state: MapperState) -> Mapper:
        """Return a mapper that has drawn the whole map anew."""
        parts = config.localization, config.gyro
        return Mapper.taken_up(numbers, *parts, state, robot.mapper.pose)

    def state() -> MapperState:
        state = robot.mapper.state()
        assert state is not None
        return state

    # Two submaps lie wrongly until their links are used the next time.
    wrong = state().poses.copy()
    assert len(wrong) > 4
    wrong[1:3] += (0.3, -0.2, 0.1)
    robot.mapper = another(replace(state(), poses=wrong))
    robot.drive(CIRCLE, 0.3 * AROUND)
    assert np.abs(state().poses[1:3, :2] - wrong[1:3, :2]).min() > 0.15
    made, anew = robot.mapper.occupancy(), another(state()).occupancy()
    rows, columns = anew.frame.shape
    row = round((anew.frame.origin_y - made.frame.origin_y) / 0.05)
    column = round((anew.frame.origin_x - made.frame.origin_x) / 0.05)
    cut = made.values[row : row + rows, column : column + columns]
    assert np.mean(cut != anew.values) < 0.001
    assert (made.values != UNKNOWN).sum() == (cut != UNKNOWN).sum()


def test_keyframes_are_as_far_apart_as_wanted() -> None:
    for way in (0.15, 0.4):
        robot = Mapped(mapping=MappingConfig(keyframe_way=way, keyframe_turn=3.0))
        robot.drive(Twist(0.3, 0.0), 4.0)
        steps = np.hypot(*np.diff(robot.mapper.trajectory[:, :2], axis=0).T)
        assert steps == pytest.approx(way, abs=0.05)
    robot = Mapped(mapping=MappingConfig(keyframe_turn=0.5))
    robot.drive(Twist(0.0, 1.0), 6.0)
    turns = np.diff(np.unwrap(robot.mapper.trajectory[:, 2]))
    assert len(turns) >= 9
    assert turns == pytest.approx(0.55, abs=0.06)


def test_standing_it_keeps_nothing() -> None:
    robot = Mapped().drive(Twist(0.2, 0.0), 2.0).drive(Twist(), 1.0)
    version = robot.mapper.version
    robot.drive(Twist(), 5.0)
    assert robot.mapper.version == version
    assert robot.error < WORST
