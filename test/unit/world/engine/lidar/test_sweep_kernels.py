"""A lidar that turns while it measures: where each beam was, when scans come, how they are off."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, EXACT, block_that_moves
from fixtures.references.slow_lidar import ranges_to_box, ranges_to_cells, ranges_to_disc
from numpy.typing import NDArray

from roomba.configuration.sensors import LidarConfig
from roomba.configuration.simulation import SimulatedLidar, SimulatedRobotConfig, SimulationConfig
from roomba.geometry import Pose, Twist
from roomba.world.engine.state.arrays import Fault
from roomba.world.simulator import Simulator

HOME = room_home(blocks=((1.0, 1.0, 1.3, 1.2),))
BOX, SIZE = (3.6, 1.0, 0.5), (0.6, 0.3)
DISC = (1.0, 3.0, 0.25)
START = Pose(2.0, 2.0, 0.3)
TURNING = LidarConfig(rate=4.0, sweep_time=0.25)


def robot(
    lidar: LidarConfig = TURNING, errors: SimulatedLidar | None = None
) -> SimulatedRobotConfig:
    """A robot whose lidar has these errors and no other, and whose wheels and gyro are exact."""
    if errors is None:
        return SimulatedRobotConfig(lidar=lidar).with_sensors("ideal")
    return SimulatedRobotConfig(lidar=lidar, simulation=SimulationConfig(lidar=errors))


def errors(**given: float) -> SimulatedLidar:
    return EXACT.simulation.lidar.model_copy(update={"noise": 0.0, "misses": 0.0, **given})


def next_scan(world: Simulator, twist: Twist | None = None) -> NDArray[np.float32]:
    before = world.observe().scans
    for _ in range(1000):
        if world.step(twist or Twist(), DT).scans > before:
            return world.ranges
    raise AssertionError("no scan came")


def scans_of(config: SimulatedRobotConfig, count: int) -> NDArray[np.float32]:
    world = Simulator(HOME, config, seed=3, start=START)
    return np.array([next_scan(world) for _ in range(count)])


def slow(x: float, y: float, theta: float, beams: int = 360) -> NDArray[np.float64]:
    """Ranges to walls, box and disc from one pose, by plain geometry."""
    found = ranges_to_cells(HOME.solid, HOME.frame, x, y, theta, beams)
    found = np.minimum(found, ranges_to_box(x, y, theta, beams, BOX, SIZE))
    return np.minimum(found, ranges_to_disc(x, y, theta, beams, DISC))


@pytest.mark.parametrize("ahead", [0.0, -0.1])
@pytest.mark.parametrize(("speed", "turning"), [(0.25, 1.1), (0.25, -0.4), (0.0, 1.5), (0.25, 0.0)])
def test_each_beam_is_measured_where_the_lidar_was_at_its_time(
    ahead: float, speed: float, turning: float
) -> None:
    home = room_home(
        blocks=((1.0, 1.0, 1.3, 1.2),), moving=[block_that_moves(pose=Pose(*BOX), size=SIZE)]
    )
    lidar = LidarConfig(rate=4.0, sweep_time=0.25, mount_ahead=ahead)
    world = Simulator(home, robot(lidar), start=START)
    world.place_obstacle(*DISC)
    for _ in range(5):
        scan = next_scan(world, Twist(speed, turning))
    seen = world.observe()
    assert (seen.twist.linear, seen.twist.angular) == pytest.approx((speed, turning))
    wrong = 0
    for beam in range(0, 360, 4):
        # At constant speeds the way is a circle; back from where the robot is now.
        ago = seen.time - (seen.scan_stamp + beam * 0.25 / 360)
        theta = seen.pose.theta - turning * ago
        chord = speed * ago * float(np.sinc(0.5 * turning * ago / math.pi))
        along = seen.pose.theta - 0.5 * turning * ago
        x = seen.pose.x - chord * math.cos(along) + ahead * math.cos(theta)
        y = seen.pose.y - chord * math.sin(along) + ahead * math.sin(theta)
        wrong += abs(float(scan[beam]) - slow(x, y, theta)[beam]) > 1e-3
    # A beam that just grazes a corner may see past it.
    assert wrong <= 1


def test_scans_come_late_and_their_stamp_is_that_of_the_first_beam() -> None:
    late = errors(delay=0.5)
    world = Simulator(HOME, robot(LidarConfig(rate=2.0, sweep_time=0.25), late), start=START)
    came = []
    for _ in range(200):
        before = world.observe().scans
        seen = world.step(Twist(), DT)
        if seen.scans > before:
            came.append((seen.scan_stamp, seen.time))
    stamps, times = np.array(came).T
    assert stamps == pytest.approx(0.5 * np.arange(len(came)))
    assert ((times - stamps >= 0.75 - 1e-6) & (times - stamps < 0.75 + DT)).all()
    assert len(came) == 9


@pytest.mark.parametrize("dt", [0.01, 0.03, 0.1])
def test_scans_come_at_their_rate_whatever_the_step(dt: float) -> None:
    world = Simulator(HOME, robot(), start=START)
    world.advance(Twist(), dt, round(20.0 / dt))
    assert world.observe().scans == pytest.approx(80, abs=1)


def test_a_fan_looks_ahead() -> None:
    config = robot(LidarConfig(beams=181, field=180.0, sweep_time=0.01))
    scan = next_scan(Simulator(HOME, config, start=START))
    around = ranges_to_cells(HOME.solid, HOME.frame, START.x, START.y, START.theta, 360)
    assert scan == pytest.approx(np.roll(around, 90)[:181], abs=1e-3)


def test_noise_grows_with_the_square_of_the_range_and_with_grazing_angles() -> None:
    config = robot(errors=errors(noise=0.002, noise_growth=0.004, grazing_noise=0.5))
    scans = scans_of(config, 400)
    exact = ranges_to_cells(HOME.solid, HOME.frame, START.x, START.y, START.theta, 360)
    angles = START.theta + np.radians(np.arange(360))
    checked = 0
    for beam in range(360):
        # Which wall a beam meets shows in where it ends: those of the room are the outer ones.
        x = START.x + exact[beam] * math.cos(angles[beam])
        y = START.y + exact[beam] * math.sin(angles[beam])
        to_x, to_y = min(abs(x), abs(5.0 - x)), min(abs(y), abs(4.0 - y))
        if min(to_x, to_y) > 1e-6 or max(to_x, to_y) < 0.1:
            continue
        facing = abs(math.cos(angles[beam]) if to_x < to_y else math.sin(angles[beam]))
        sigma = 0.002 + 0.004 * exact[beam] ** 2
        sigma *= 1.0 + 0.5 * (1.0 / max(facing, 0.1) - 1.0)
        assert scans[:, beam].std() == pytest.approx(sigma, rel=0.2)
        assert scans[:, beam].mean() == pytest.approx(exact[beam], abs=5.0 * sigma / 20.0)
        checked += 1
    assert checked > 100


def test_ranges_are_rounded() -> None:
    scans = scans_of(robot(errors=errors(noise=0.01, range_step=0.02)), 3)
    assert scans / 0.02 == pytest.approx(np.round(scans / 0.02), abs=1e-3)
    assert len(np.unique(scans)) > 20


def test_angles_are_told_no_better_than_to_their_rounding() -> None:
    scans = scans_of(robot(errors=errors(angle_rounding=2.0)), 200)
    exact = ranges_to_cells(HOME.solid, HOME.frame, START.x, START.y, START.theta, 3600)
    for beam in (40, 130, 220):
        near = exact[np.arange(10 * beam - 10, 10 * beam + 11) % 3600]
        low, high = scans[:, beam].min(), scans[:, beam].max()
        assert near.min() - 1e-3 <= low < high <= near.max() + 1e-3
        assert high - low > 0.7 * (near.max() - near.min())


def test_a_wide_beam_mixes_two_ranges_at_an_edge_and_a_thin_one_does_not() -> None:
    exact = slow_without_things()
    for spot, mixes in ((0.0, False), (1.0, True)):
        scans = scans_of(robot(errors=errors(spot=spot)), 50)
        around = np.stack([np.roll(exact, shift) for shift in (-1, 0, 1)])
        apart = np.abs(scans[:, None, :] - around).min(axis=1)
        assert bool((apart > 0.15).any()) == mixes
        low, high = around.min(axis=0) - 0.02, around.max(axis=0) + 0.02
        assert ((scans >= low) & (scans <= high)).all()


def slow_without_things() -> NDArray[np.float64]:
    return ranges_to_cells(HOME.solid, HOME.frame, START.x, START.y, START.theta, 360)


def test_dark_surfaces_vanish_with_the_range_and_shiny_ones_unless_met_squarely() -> None:
    exact = slow_without_things()
    dark = np.isfinite(scans_of(robot(errors=errors(white_reach=10.0, dark=1.0)), 1)[0])
    # Black gives back 1/22 of what white does: met squarely it is seen to 2.1 m of 10 m.
    assert not dark[exact > 2.7].any()
    assert dark[exact < 1.1].all()
    shiny = np.isfinite(scans_of(robot(errors=errors(white_reach=10.0, shiny=1.0)), 1)[0])
    angles = START.theta + np.radians(np.arange(360))
    square = np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    assert not shiny[square < 0.95].any()
    assert 20 < shiny.sum() < 180
    assert np.isfinite(scans_of(robot(errors=errors(white_reach=20.0)), 1)[0]).all()


def test_the_same_seed_sees_the_same_and_a_sweep_goes_on_after_a_restore() -> None:
    config = SimulatedRobotConfig().with_lidar("neato_serial")
    first, second = (Simulator(HOME, config, seed=7, start=START) for _ in range(2))
    for world in (first, second):
        world.advance(Twist(0.1, 0.4), DT, 33)
    saved = first.save()
    assert first.digest() == second.digest()
    second.advance(Twist(0.1, -0.4), DT, 70)
    digest = second.digest()
    first.advance(Twist(-0.1, 0.3), DT, 11)
    first.restore(saved)
    first.advance(Twist(0.1, -0.4), DT, 70)
    assert first.digest() == digest
    other = Simulator(HOME, config, seed=8, start=START)
    other.advance(Twist(0.1, 0.4), DT, 33)
    assert not np.array_equal(next_scan(other), next_scan(first))


def test_a_blocked_lidar_sees_nothing() -> None:
    world = Simulator(HOME, robot(), start=START)
    world.inject(Fault.LIDAR_BLOCKED, 1.0)
    assert (next_scan(world) == np.inf).all()
