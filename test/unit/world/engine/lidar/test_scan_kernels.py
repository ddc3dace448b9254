"""The robot's scans: when they are made, what stands in their way, and their noise."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, EXACT, IDEAL, NOISY, block_that_moves, drive
from fixtures.references.slow_lidar import (
    disagreeing,
    ranges_to_box,
    ranges_to_cells,
    ranges_to_disc,
    within,
)
from fixtures.thoroughness import examples
from hypothesis import given, reject, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.simulation import SimulatedLidar, SimulatedRobotConfig, SimulationConfig
from roomba.errors import HomeError
from roomba.geometry import Pose, Twist
from roomba.world.fleet import Fleet
from roomba.world.simulator import Simulator

CONFIG = EXACT
LIDAR, TRUTH = CONFIG.lidar, CONFIG.simulation.lidar
BLOCKS = ((1.0, 1.0, 1.3, 1.2),)
BEAMS = LIDAR.beams


def errors(**given: float) -> SimulatedLidar:
    return TRUTH.model_copy(update=given)


def slow_walls(pose: Pose) -> NDArray[np.float64]:
    home = room_home(blocks=BLOCKS)
    return ranges_to_cells(home.solid, home.frame, pose.x, pose.y, pose.theta, BEAMS)


def cut(ranges: NDArray[np.float64]) -> NDArray[np.float64]:
    return within(ranges, LIDAR.min_range, LIDAR.max_range)


@pytest.mark.parametrize(("dt", "seconds"), [(0.025, 20.0), (0.01, 5.0), (0.1, 30.0), (0.03, 30.0)])
def test_it_scans_at_its_rate_whatever_the_step(dt: float, seconds: float) -> None:
    seen = drive(Simulator(room_home(), NOISY), 0.0, 0.0, seconds, dt)
    assert seen.scans == pytest.approx(seconds * LIDAR.rate, abs=1)


def test_what_is_missed_in_a_long_step_is_not_made_up_for() -> None:
    world = Simulator(room_home(), NOISY)
    assert drive(world, 0.0, 0.0, 10.0, 1.0).scans == 10
    assert drive(world, 0.0, 0.0, 1.0, 0.025).scans == pytest.approx(20, abs=1)


def test_before_the_first_step_nothing_was_seen_and_scans_are_of_where_it_was() -> None:
    world = Simulator(room_home(blocks=BLOCKS), IDEAL, start=Pose(2.0, 2.0, 0.3))
    assert (world.ranges == np.inf).all()
    for _ in range(40):
        before = world.observe().scans
        seen = world.step(Twist(0.4, 0.5), DT)
        if seen.scans > before:
            expected = cut(slow_walls(seen.pose))
            last = world.ranges
        assert (world.ranges == last).all()
    assert disagreeing(last, expected).sum() <= 1


places = st.tuples(st.floats(0.3, 4.7), st.floats(0.3, 3.7))


@settings(max_examples=examples(60))
@given(places, st.floats(-20.0, 20.0), places, st.floats(-20.0, 20.0), places, st.floats(0.02, 0.6))
def test_boxes_and_discs_are_seen_as_plain_geometry_has_them(
    place: tuple[float, float],
    theta: float,
    box: tuple[float, float],
    turn: float,
    disc: tuple[float, float],
    radius: float,
) -> None:
    size = (0.8, 0.25)
    thing = block_that_moves(pose=Pose(*box, turn), size=size)
    home = room_home(blocks=BLOCKS, moving=[thing])
    try:
        world = Simulator(home, IDEAL, start=Pose(*place, theta))
    except HomeError:
        reject()
    if math.dist(place, disc) > radius + CONFIG.body.radius:
        world.place_obstacle(*disc, radius)
    world.step(Twist(), 0.1)
    at = world.pose.x, world.pose.y, world.pose.theta
    expected = np.minimum(slow_walls(world.pose), ranges_to_box(*at, BEAMS, (*box, turn), size))
    for row in world.discs.tolist():
        expected = np.minimum(expected, ranges_to_disc(*at, BEAMS, tuple(row)))
    off = disagreeing(world.ranges, cut(expected))
    # A beam that just grazes a disc or a corner may see past it.
    assert off.sum() <= 2


def test_what_is_lower_than_the_lidar_is_not_seen_and_what_is_not_there_neither() -> None:
    empty = Simulator(room_home(), IDEAL, start=Pose(1.0, 2.0, 0.0))
    empty.step(Twist(), 0.1)
    here = Pose(2.0, 2.0, 0.0)
    for things, is_seen in (
        ([block_that_moves(pose=here, heights=(0.0, LIDAR.mount_height + 0.001))], True),
        ([block_that_moves(pose=here, heights=(0.0, LIDAR.mount_height - 0.001))], False),
        ([block_that_moves(pose=here, is_present=False)], False),
    ):
        world = Simulator(room_home(moving=things), IDEAL, start=Pose(1.0, 2.0, 0.0))
        world.step(Twist(), 0.1)
        assert (world.ranges != empty.ranges).any() == is_seen
    assert empty.ranges[0] == pytest.approx(4.0, abs=1e-5)


def test_other_robots_are_seen_as_discs() -> None:
    starts = np.array([(1.0, 2.0, 0.4), (2.5, 2.2, 1.0), (3.5, 1.0, 2.0)])
    fleet = Fleet([room_home(blocks=BLOCKS)], IDEAL, robots_per_home=3, starts=starts)
    fleet.step(np.zeros((3, 2)), 0.1)
    for robot, (here_x, here_y, theta) in enumerate(starts.tolist()):
        start = Pose(here_x, here_y, theta)
        expected = slow_walls(start)
        for other, (x, y, _) in enumerate(starts.tolist()):
            if other != robot:
                disc = x, y, CONFIG.body.radius
                expected = np.minimum(expected, ranges_to_disc(here_x, here_y, theta, BEAMS, disc))
        assert disagreeing(fleet.ranges[robot], cut(expected)).sum() <= 1
        assert np.abs(expected - slow_walls(start)).max() > 0.1


def test_noise_has_its_mean_its_deviation_and_its_misses_and_each_beam_its_own() -> None:
    start = Pose(2.2, 1.7, 0.3)
    home = room_home(blocks=BLOCKS)
    ideal = Simulator(home, IDEAL, start=start)
    ideal.step(Twist(), 0.1)
    noisy = Simulator(home, NOISY, start=start, seed=2)
    scans = []
    for _ in range(400):
        noisy.step(Twist(), 0.1)
        scans.append(noisy.ranges)
    seen = np.array(scans)
    missed = ~np.isfinite(seen)
    assert missed.mean() == pytest.approx(TRUTH.misses, rel=0.1)
    assert (seen[missed] == np.inf).all()
    assert missed.any(axis=0).mean() > 0.9
    residual = np.where(missed, 0.0, seen - ideal.ranges)
    assert residual.mean() == pytest.approx(0.0, abs=5e-5)
    assert residual[~missed].std() == pytest.approx(TRUTH.noise, rel=0.02)
    assert np.abs(residual).max() < 4.0 * TRUTH.noise
    assert (np.abs(residual.mean(axis=0)) < 5.0 * TRUTH.noise / 20.0).all()
    for one, other in (
        (residual[:, :-1], residual[:, 1:]),
        (residual[:-1], residual[1:]),
        (residual[:, :180], residual[:, 180:]),
    ):
        assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.02


def test_what_is_out_of_reach_stays_so_with_noise() -> None:
    config = SimulatedRobotConfig(
        lidar=LIDAR.model_copy(update={"min_range": 1.0, "max_range": 2.5}),
        simulation=SimulationConfig(lidar=errors(misses=0.0)),
    )
    world = Simulator(room_home(), config, start=Pose(0.9, 2.0, math.pi))
    world.step(Twist(), 0.1)
    assert world.ranges[0] == -np.inf
    assert world.ranges[180] == np.inf
    assert np.isfinite(world.ranges[90])


def test_all_may_be_missed() -> None:
    blind = SimulationConfig(lidar=errors(misses=1.0))
    config = SimulatedRobotConfig(lidar=LIDAR, simulation=blind)
    world = Simulator(room_home(), config)
    world.step(Twist(), 0.1)
    assert (world.ranges == np.inf).all()
