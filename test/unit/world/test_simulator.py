import math
import os
import subprocess
import sys

import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import IDEAL, drive, drive_around, simulator
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.errors import HomeError
from roomba.geometry import Pose, Twist
from roomba.world.home.home import DirtSource
from roomba.world.simulator import Simulator


def test_same_seed_and_commands_give_the_same_trace_in_another_process_too() -> None:
    program = (
        "from fixtures.homes.worlds import drive_around, simulator\n"
        "print(drive_around(simulator()))"
    )
    elsewhere = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    assert elsewhere.stdout.strip() == drive_around(simulator())


def test_another_seed_lets_dirt_fall_elsewhere() -> None:
    dirt = []
    for seed in (1, 1, 2):
        world = simulator(seed)
        world.advance(Twist(), 1.0, 600)  # it stands: only what falls makes a difference
        dirt.append(world.dirt.micrograms.tobytes())
    assert dirt[0] == dirt[1] != dirt[2]


@settings(max_examples=examples(25))
@given(st.integers(0, 2**31), st.integers(20, 400))
def test_dirt_is_conserved_exactly(seed: int, steps: int) -> None:
    world = simulator(seed)
    drive_around(world, steps, seed)
    assert world.dirt.total + world.in_bin == world.brought_in


def test_dirt_falls_at_its_sources_rate() -> None:
    world = simulator()
    before = world.brought_in
    world.set_power(brush=0.0, fan=0.0)
    for _ in range(3600):
        world.step(Twist(), 1.0)
    fallen = (world.brought_in - before) / 1e6
    assert fallen == pytest.approx(230.0, rel=0.05)


def test_driving_over_dirt_picks_it_up_and_standing_does_not() -> None:
    world = Simulator(room_home(sources=(DirtSource("crumbs", 2.0, 0.5, 0.1, 10.0, 0.0),)))
    for _ in range(40):
        world.step(Twist(), 0.025)
    assert world.in_bin == 0
    for _ in range(400):
        seen = world.step(Twist(0.3, 0.0), 0.025)
    # The brush is 0.2 m wide: of a Gaussian of 0.1 m two thirds lie under it, of which 80 % come.
    assert seen.in_bin == pytest.approx(10.0 * 0.683 * 0.8, rel=0.1)


def test_dirt_under_the_robot_is_told_in_grams() -> None:
    world = Simulator(room_home())
    assert world.observe().dirt_under == 0.0
    world.spill(0.5, 0.5, 0.02, 3.0)
    assert world.observe().dirt_under == pytest.approx(3.0, abs=1e-3)


def test_a_full_bin_takes_no_more() -> None:
    world = Simulator(room_home())
    capacity = world.config.brush.bin_capacity
    world.spill(2.0, 0.5, 0.3, 400.0)
    for _ in range(20):
        for speed in (0.5, -0.5):
            for _ in range(240):
                seen = world.step(Twist(speed, 0.0), 0.025)
    assert seen.in_bin == pytest.approx(capacity)
    assert world.dirt.total + world.in_bin == world.brought_in


@settings(max_examples=examples(20))
@given(st.floats(-3.0, 3.0), st.floats(-0.5, 0.5), st.floats(-2.0, 2.0))
def test_ideal_odometry_begins_at_zero_and_tells_the_way_since(
    theta: float, linear: float, angular: float
) -> None:
    start = Pose(2.5, 2.0, theta)
    world = Simulator(room_home(), IDEAL, start=start)
    assert world.observe().odometry.distance_to(0.0, 0.0) < 1e-12
    assert world.observe().odometry.theta == 0.0
    for _ in range(60):
        seen = world.step(Twist(linear, angular), 0.025)
    believed = start.compose(seen.odometry)
    assert math.hypot(believed.x - seen.pose.x, believed.y - seen.pose.y) < 1e-9


def at_emptying_station(seed: int = 0) -> Simulator:
    """A robot that stands there with dirt in its bin, which is being taken out."""
    sources = (DirtSource("crumbs", 1.0, 0.5, 0.1, 10.0, 0.0),)
    world = Simulator(room_home(sources=sources), IDEAL.with_emptying_station(), seed=seed)
    drive(world, 0.3, 0.0, 4.0)
    world.put(world.start)
    assert world.emptying is not None
    world.emptying.is_wanted = True
    drive(world, 0.0, 0.0, 3.0)
    assert world.emptying.is_at_work
    return world


def test_what_a_station_empties_is_saved_with_the_world_and_restored() -> None:
    world, other = at_emptying_station(), at_emptying_station(1)
    saved, then = world.save(), world.digest()
    drive(world, 0.0, 0.0, 6.0)
    later, in_bag = world.digest(), world.emptying and world.emptying.in_bag
    assert in_bag
    for restored in (world, other):
        restored.restore(saved)
        assert restored.digest() == then
        drive(restored, 0.0, 0.0, 6.0)
        assert restored.emptying
        assert restored.emptying.in_bag == in_bag
        assert restored.digest() == later
    assert other.emptying
    other.emptying.replace_bag()
    assert other.digest() != later


def test_a_station_that_empties_is_not_restored_from_one_that_does_not() -> None:
    emptying = at_emptying_station()
    plain = Simulator(emptying.home, IDEAL)
    for world, other, said in (
        (emptying, plain, "a station that empties the bin"),
        (plain, emptying, "a station that does not empty the bin"),
    ):
        before = world.digest()
        with pytest.raises(ValueError, match=said):
            world.restore(other.save())
        assert world.digest() == before


@pytest.mark.parametrize("dt", [0.0, -0.1, math.nan, math.inf])
def test_time_must_pass_forwards(dt: float) -> None:
    with pytest.raises(ValueError, match="dt > 0"):
        simulator().step(Twist(), dt)


@pytest.mark.parametrize("twist", [Twist(math.nan, 0.0), Twist(0.0, math.inf)])
def test_what_cannot_be_driven_is_refused(twist: Twist) -> None:
    with pytest.raises(ValueError, match="finite twist"):
        simulator().step(twist, 0.1)


def test_a_start_in_the_wall_is_refused_with_the_place() -> None:
    with pytest.raises(HomeError, match=r"does not fit at \(0.10, 2.00\)"):
        Simulator(room_home(), start=Pose(0.1, 2.0, 0.0))


def test_a_thing_on_no_map_can_be_put_in_the_way_but_not_on_the_robot() -> None:
    world = simulator()
    with pytest.raises(ValueError, match="robot itself"):
        world.place_obstacle(0.6, 0.5, 0.1)
    world.place_obstacle(2.0, 0.5, 0.1)
    for _ in range(300):
        seen = world.step(Twist(0.5, 0.0), 0.025)
    assert seen.bumper.pressed
    assert seen.pose.x < 2.0 - 0.1 - world.config.body.radius + 0.001
