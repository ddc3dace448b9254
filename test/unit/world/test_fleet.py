"""Many robots: each as it would be alone, several in one home, saved, restored and repeated."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, NOISY, SOURCES, block_that_moves
from fixtures.thoroughness import core_first, examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.sensors import LidarConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import HomeError
from roomba.files.home_layer import list_homes
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist
from roomba.world.engine.state.arrays import MOST_DISCS, Fault
from roomba.world.fleet import Fleet
from roomba.world.home.home import Home, Move
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator

RADIUS = SimulatedRobotConfig().body.radius
Twists = NDArray[np.float64]


def varied_homes() -> list[Home]:
    """Three different homes, one twice, with dirt that falls, stairs and a thing that moves."""
    slides = block_that_moves(
        Move(1.0, 4.0, Pose(3.0, 3.0, 1.0)), pose=Pose(1.0, 3.0, 0.0), period=6.0
    )
    first = room_home(sources=SOURCES, moving=[slides])
    second = room_home(3.0, 6.0, carpets=((0.0, 0.0, 3.0, 6.0),), stairs=((0.0, 5.0, 3.0, 6.0),))
    third = load_home("family", HOMES)
    return [first, second, first, third]


def random_twists(steps: int, robots: int, seed: int = 0) -> Twists:
    random = np.random.default_rng(seed)
    low, high = np.array([-0.2, -2.0]), np.array([0.6, 2.0])
    return random.uniform(low, high, (steps, robots, 2))


def run(fleet: Fleet, twists: Twists, steps: int = 25) -> None:
    for wanted in twists:
        fleet.step(wanted, DT, steps)


def without_places(state: dict[str, NDArray[Any]], robot: int) -> dict[str, object]:
    """Return what can be compared of one robot's world: all but the rows' numbers."""
    world = state["worlds"][robot]
    parts: dict[str, object] = {
        "robot": state["robots"][robot].tobytes(),
        "ranges": state["ranges"][robot].tobytes(),
        "dirt": state["dirt"][world["dirt_at"] : world["dirt_end"]].tobytes(),
        "falls": state["falls"]["time"][world["falls_at"] : world["falls_end"]].tobytes(),
    }
    things = state["things"][world["things_at"] : world["things_end"]]
    for name in ("x", "y", "theta", "present", "time"):
        parts[name] = things[name].tobytes()
    for name in ("time", "random", "brought_in"):
        parts[f"world {name}"] = world[name].tobytes()
    return parts


@pytest.mark.parametrize("threads", [1, 2])
def test_a_robot_is_the_same_alone_and_in_a_fleet_to_the_last_bit(threads: int) -> None:
    homes = varied_homes()
    seeds = [3, 1, 4, 1]
    fleet = Fleet(homes, NOISY, seeds=seeds, threads=threads)
    twists = random_twists(24, 4)
    run(fleet, twists)
    together = fleet.save()
    fleet.close()
    for robot, (home, seed) in enumerate(zip(homes, seeds, strict=True)):
        alone = Simulator(home, NOISY, seed=seed)
        for wanted in twists[:, robot].tolist():
            for _ in range(25):
                alone.step(Twist(*wanted), DT)
        expected = without_places(alone.save(), 0)
        for name, value in without_places(together, robot).items():
            assert value == expected[name], (robot, name)


def test_threads_and_the_other_worlds_change_nothing() -> None:
    homes = varied_homes() * 5
    twists = random_twists(10, 20, 1)
    digests = set()
    for threads in (1, 2, 5):
        fleet = Fleet(homes, NOISY, threads=threads)
        run(fleet, twists)
        digests.add(fleet.digest())
        fleet.close()
        run(fleet, twists[:1])  # it may still be used
        fleet.close()
    assert len(digests) == 1


def test_many_steps_at_once_are_as_many_steps() -> None:
    one, many = (Fleet(varied_homes(), NOISY) for _ in range(2))
    for wanted in random_twists(4, 4):
        many.step(wanted, DT, 30)
        for _ in range(30):
            one.step(wanted, DT)
    assert one.digest() == many.digest()


def test_the_seed_decides() -> None:
    home = varied_homes()[0]
    twists = random_twists(5, 1)
    digests = []
    for seed in (1, 1, 2):
        fleet = Fleet([home], NOISY, seeds=[seed])
        run(fleet, twists)
        digests.append(fleet.digest())
    assert digests[0] == digests[1] != digests[2]
    worlds = Fleet([home, home], NOISY)
    run(worlds, np.repeat(twists, 2, axis=1))
    assert worlds.poses[0].tolist() != worlds.poses[1].tolist()


@settings(max_examples=examples(12))
@given(st.integers(0, 2**31), st.integers(2, 5))
def test_robots_of_one_home_never_overlap(seed: int, robots: int) -> None:
    fleet = Fleet([room_home(3.0, 2.0)], robots_per_home=robots, seeds=[seed])
    assert fleet.poses[0].tolist() == [0.5, 0.5, 0.0]
    for wanted in random_twists(30, robots, seed):
        for _ in range(10):
            fleet.step(wanted, DT)
            for one, other in itertools.combinations(fleet.poses, 2):
                assert math.dist(one[:2], other[:2]) >= 2.0 * RADIUS - 1e-6
            x, y = fleet.poses[:, 0], fleet.poses[:, 1]
            assert min(x.min(), y.min(), 3.0 - x.max(), 2.0 - y.max()) >= RADIUS - 1e-6


def test_robots_bump_each_other_and_worlds_know_nothing_of_each_other() -> None:
    starts = np.array([(1.0, 2.0, 0.0), (2.0, 2.0, 0.0)])
    both = np.array([(0.3, 0.0), (0.0, 0.0)])
    together = Fleet([room_home()], robots_per_home=2, starts=starts)
    together.step(both, DT, 200)
    assert math.dist(*together.poses[:, :2]) == pytest.approx(2.0 * RADIUS, abs=1e-6)
    assert together.robots["bumper_left"].tolist() == [1.0, 0.0]
    assert together.robots["hits"].tolist() == [1.0, 0.0]
    assert together.gap(0) == pytest.approx(0.0, abs=1e-6)
    apart = Fleet([room_home(), room_home()], starts=starts)
    apart.step(both, DT, 200)
    assert apart.poses[0, 0] > 2.0
    assert not apart.robots["hits"].any()


def test_robots_start_where_nothing_stands_nor_will_they_fall() -> None:
    home = load_home("family", HOMES)
    for seed in range(20):
        fleet = Fleet([home], robots_per_home=6, seeds=[seed])
        for robot, (x, y, _) in enumerate(fleet.poses.tolist()):
            assert fleet.gap(robot) >= 0.0
            assert not home.drop[home.frame.cell_of(x, y)]


def test_dirt_things_and_discs_are_those_of_their_world() -> None:
    fleet = Fleet(varied_homes())
    assert [len(fleet.things(world)) for world in range(4)] == [1, 0, 1, 4]
    before = fleet.dirt(2).total
    fleet.dirt(0).spread(2.0, 2.0, 0.2, 5.0)
    assert fleet.dirt(2).total == before
    fleet.put_discs(1, np.array([[1.5, 3.0, 0.1]]))
    assert [len(fleet.discs(world)) for world in range(4)] == [0, 1, 0, 0]
    assert fleet.discs(1).tolist() == [[1.5, 3.0, 0.1]]
    fleet.inject(2, Fault.LIFTED, 1.0)
    assert fleet.robots["lifted"].tolist() == [0.0, 0.0, 1.0, 0.0]


def test_a_world_holds_so_many_discs_and_gives_them_back() -> None:
    fleet = Fleet([room_home(), room_home()])
    for number in range(MOST_DISCS):
        fleet.put_discs(0, np.array([[2.0 + 0.1 * number, 2.0, 0.05]]))
    with pytest.raises(ValueError, match="at most 16 things"):
        fleet.put_discs(0, np.array([[2.0, 3.0, 0.05]]))
    assert len(fleet.discs(1)) == 0
    fleet.remove_discs(0)
    fleet.put_discs(0, np.array([[2.0, 3.0, 0.05]]))
    assert fleet.discs(0).tolist() == [[2.0, 3.0, 0.05]]


@pytest.mark.parametrize(
    "disc",
    [
        (0.6, 0.5, 0.1),
        (0.5, 0.8, 0.2),
        (math.nan, 1.0, 0.1),
        (2.0, math.inf, 0.1),
        (2.0, 2.0, 0.0),
        (2.0, 2.0, -1.0),
        (2.0, 2.0, math.nan),
    ],
)
def test_discs_that_make_no_sense_are_refused(disc: tuple[float, float, float]) -> None:
    fleet = Fleet([room_home()])
    before = fleet.digest()
    with pytest.raises(ValueError, match=r"expected places|the robot itself"):
        fleet.put_discs(0, np.array([disc]))
    assert fleet.digest() == before


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"homes": []}, "a home or more"),
        ({"robots_per_home": 0}, "a robot or more"),
        ({"seeds": [1, 2]}, "a seed of 0 or more for each of 1 worlds"),
        ({"seeds": [-1]}, "a seed of 0 or more"),
        ({"threads": 0}, "1 thread or more"),
        ({"max_speed": -0.5}, "max_speed"),
        ({"starts": np.zeros((2, 3))}, "finite starts of shape"),
        ({"starts": np.array([(1.0, math.nan, 0.0)])}, "finite starts"),
    ],
)
def test_what_makes_no_fleet_is_refused(arguments: dict[str, object], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Fleet(**({"homes": [room_home()]} | arguments))  # type: ignore[arg-type]


def test_robots_that_do_not_fit_are_refused_with_the_place() -> None:
    with pytest.raises(HomeError, match=r"does not fit at \(0.10, 1.00\)"):
        Fleet([room_home()], starts=np.array([(0.1, 1.0, 0.0)]))
    starts = np.array([(1.0, 1.0, 0.0), (1.3, 1.0, 0.0)])
    with pytest.raises(HomeError, match="does not fit"):
        Fleet([room_home()], robots_per_home=2, starts=starts)
    with pytest.raises(HomeError, match="expected room for 40 robots, found it for"):
        Fleet([room_home(1.5, 1.5)], robots_per_home=40)


@pytest.mark.parametrize(
    ("twists", "dt", "steps", "said"),
    [
        (np.zeros((1, 2)), 0.1, 1, "twists of shape"),
        (np.zeros((2, 3)), 0.1, 1, "twists of shape"),
        (np.zeros(2), 0.1, 1, "twists of shape"),
        (np.array([(0.0, math.nan), (0.0, 0.0)]), 0.1, 1, "not finite"),
        (np.array([(math.inf, 0.0), (0.0, 0.0)]), 0.1, 1, "not finite"),
        (np.zeros((2, 2)), 0.0, 1, "dt > 0"),
        (np.zeros((2, 2)), -0.1, 1, "dt > 0"),
        (np.zeros((2, 2)), math.nan, 1, "dt > 0"),
        (np.zeros((2, 2)), 0.1, 0, "1 step or more"),
    ],
)
def test_steps_that_make_no_sense_are_refused_and_no_time_passes(
    twists: Twists, dt: float, steps: int, said: str
) -> None:
    fleet = Fleet([room_home(), room_home()])
    before = fleet.digest()
    with pytest.raises(ValueError, match=said):
        fleet.step(twists, dt, steps)
    assert fleet.digest() == before


def test_what_was_saved_goes_on_as_it_would_have() -> None:
    fleet = Fleet(varied_homes(), NOISY)
    twists = random_twists(12, 4, 7)
    run(fleet, twists[:6])
    saved = fleet.save()
    then = fleet.digest()
    run(fleet, twists[6:])
    later = fleet.digest()
    assert later != then
    other = Fleet(varied_homes(), NOISY, seeds=[9, 9, 9, 9])
    for restored in (fleet, other):
        restored.restore(saved)
        assert restored.digest() == then
        run(restored, twists[6:])
    assert fleet.digest() == other.digest()
    assert fleet.digest() != then


def test_a_world_that_begins_anew_is_as_in_a_new_fleet_and_others_go_on() -> None:
    fleet, untouched = (Fleet(varied_homes(), NOISY, seeds=[1, 2, 3, 4]) for _ in range(2))
    new = Fleet(varied_homes(), NOISY, seeds=[11, 12, 13, 14])
    twists = random_twists(8, 4, 9)
    run(fleet, twists)
    run(untouched, twists)
    fleet.put_discs(3, np.array([[0.0, -1.0, 0.1]]))
    for world in (2, 3):
        fleet.reset_world(world, 11 + world)
    assert fleet.seeds == (1, 2, 13, 14)
    for other in (fleet, untouched, new):
        run(other, twists[::-1])
    for robot in range(4):
        expected = (untouched if robot < 2 else new).save()
        assert without_places(fleet.save(), robot) == without_places(expected, robot)
    with pytest.raises(ValueError, match="a seed of 0 or more"):
        fleet.reset_world(0, -1)


def test_what_was_saved_is_a_copy() -> None:
    fleet = Fleet([room_home()])
    saved = fleet.save()
    before = {name: values.tobytes() for name, values in saved.items()}
    fleet.step(np.array([(0.3, 0.2)]), DT, 20)
    assert {name: values.tobytes() for name, values in saved.items()} == before


@pytest.mark.parametrize(
    "other",
    [
        lambda: Fleet([room_home(4.0, 4.0)]),
        lambda: Fleet([room_home(), room_home()]),
        lambda: Fleet([room_home()], robots_per_home=2),
        lambda: Fleet([room_home()], SimulatedRobotConfig(lidar=LidarConfig(beams=90))),
    ],
)
def test_what_was_saved_of_another_fleet_is_refused_and_changes_nothing(other: object) -> None:
    fleet = Fleet([room_home()])
    before = fleet.digest()
    with pytest.raises(ValueError, match="restore it into a fleet of the same homes"):
        fleet.restore(other().save())  # type: ignore[operator]
    with pytest.raises(ValueError, match="expected worlds to be"):
        fleet.restore({})
    assert fleet.digest() == before


@pytest.mark.parametrize("name", core_first(list_homes(HOMES), {"bay", "cottage", "family"}))
def test_every_shipped_home_gives_the_same_twice_and_after_a_restore(name: str) -> None:
    home = load_home(name, HOMES)
    twists = random_twists(12, 2, 3)

    def new() -> Fleet:
        return Fleet([home], NOISY, robots_per_home=2, seeds=[5], threads=1)

    first, second = new(), new()
    run(first, twists, 40)
    run(second, twists[:5], 40)
    saved = second.save()
    run(second, twists[5:], 40)
    assert first.digest() == second.digest()
    assert first.robots["distance"].min() > 0.1
    third = new()
    third.restore(saved)
    run(third, twists[5:], 40)
    assert first.digest() == third.digest()
    field = first.dirt(0)
    in_bins = int(first.robots["in_bin"].sum())
    assert field.total + in_bins == first.worlds["brought_in"][0]
