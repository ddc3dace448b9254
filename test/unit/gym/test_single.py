import math
import re
import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from gymnasium.utils.env_checker import check_env

import roomba.gym
from roomba.configuration.body import BatteryConfig, BrushConfig
from roomba.configuration.simulation import SimulatedBrush, SimulatedRobotConfig, SimulationConfig
from roomba.errors import HomeError
from roomba.gym import RoombaClean, Task
from roomba.gym.observation import BATTERY, SIZE
from roomba.world.home.home import DirtSource, Home

AHEAD = np.array([1.0, 0.0], np.float32)
STANDING = np.zeros(2, np.float32)
EAST_WARD = {"start": (0.6, 2.0, 0.0)}


def dirty_room(grams: float = 5.0) -> Home:
    return room_home(sources=(DirtSource("dust", 2.5, 2.0, 3.0, grams, 0.0),))


def test_it_keeps_gymnasiums_rules() -> None:
    environment = gymnasium.make(roomba.gym.ENVIRONMENT, home="studio", duration=60.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(environment.unwrapped)


@pytest.mark.parametrize("sensors", ["noisy", "ideal"])
def test_the_same_seed_and_actions_give_the_same_observations(sensors: str) -> None:
    seen = []
    for _ in range(2):
        environment = RoombaClean(home=dirty_room(), sensors=sensors)
        environment.action_space.seed(4)
        observations = [environment.reset(seed=3)[0], environment.reset()[0]]
        for _ in range(40):
            observations.append(environment.step(environment.action_space.sample())[0])
        seen.append(np.stack(observations))
    assert np.array_equal(seen[0], seen[1])
    assert not np.array_equal(seen[0][0], seen[0][1]), "each episode has a start of its own"


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ({}, "noisy"),
        ({"config": SimulatedRobotConfig(brush=BrushConfig(bin_capacity=1.0))}, "noisy"),
        ({"config": SimulatedRobotConfig().with_sensors("ideal")}, "ideal"),
        ({"config": SimulatedRobotConfig().with_sensors("ideal"), "sensors": "noisy"}, "noisy"),
        ({"sensors": "ideal"}, "ideal"),
    ],
)
def test_sensors_are_noisy_unless_the_robot_or_the_task_says_otherwise(
    arguments: dict[str, Any], expected: str
) -> None:
    assert RoombaClean(home=dirty_room(), **arguments).task.robot.simulation.sensors == expected


def test_another_seed_starts_elsewhere() -> None:
    environment = RoombaClean(home=dirty_room())
    starts = [environment.reset(seed=seed)[1]["pose"] for seed in range(8)]
    assert len({tuple(start) for start in starts}) == 8


def test_the_options_say_where_to_start() -> None:
    environment = RoombaClean(home=dirty_room())
    _, info = environment.reset(seed=1, options={"start": (3.0, 1.0, 0.5)})
    assert info["pose"] == pytest.approx((3.0, 1.0, 0.5))
    _, info = environment.reset(options={"at_station": True})
    assert info["pose"] == pytest.approx((0.5, 0.5, 0.0))


def test_what_cannot_be_meant_is_refused_with_the_reason() -> None:
    environment = RoombaClean(home=dirty_room())
    with pytest.raises(HomeError, match="does not fit"):
        environment.reset(options={"start": (0.0, 0.0, 0.0)})
    with pytest.raises(ValueError, match="start or at_station"):
        environment.reset(options={"stort": (1.0, 1.0, 0.0)})
    environment.reset(seed=0)
    with pytest.raises(ValueError, match=r"finite numbers, got \[nan, 0.0\] for robot 0"):
        environment.step(np.array([np.nan, 0.0], np.float32))
    for shape in [(3,), (1, 2), ()]:
        with pytest.raises(ValueError, match=re.escape(f"shape (2,), got {shape}")):
            environment.step(np.zeros(shape, np.float32))
    with pytest.raises(ValueError, match="render_mode"):
        RoombaClean(home=dirty_room(), render_mode="human")
    with pytest.raises(HomeError, match="did you mean"):
        RoombaClean(home="apartmint")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"stort": (1.0, 1.0, 0.0)}, "expected the options start or at_station, got ['stort']"),
        ({"start": 5}, "start: expected finite (x, y, theta), m and rad, got 5"),
        ({"start": [None, 1, 1]}, "start: expected finite (x, y, theta)"),
        ({"start": (1.0, 1.0)}, "start: expected finite (x, y, theta)"),
        ({"start": (1.0, 1.0, math.nan)}, "start: expected finite (x, y, theta)"),
        ({"start": (10**400, 1.0, 0.0)}, "start: expected finite (x, y, theta)"),
        ({"start": "xyz"}, "start: expected finite (x, y, theta)"),
        ({"at_station": "no"}, "at_station: expected True or False, got 'no'"),
        ({"at_station": 1}, "at_station: expected True or False, got 1"),
        ({"start": (1.0, 1.0, 0.0), "at_station": True}, "expected start or at_station, got both"),
    ],
)
def test_options_that_cannot_be_meant_are_refused_with_the_reason(
    options: dict[str, Any], said: str
) -> None:
    with pytest.raises(ValueError, match=re.escape(said)):
        RoombaClean(home=dirty_room()).reset(options=options)


def test_options_may_say_nothing() -> None:
    environment = RoombaClean(home=dirty_room())
    expected, _ = environment.reset(seed=1)
    seen, _ = environment.reset(seed=1, options={"start": None, "at_station": False})
    assert np.array_equal(seen, expected)


@pytest.mark.parametrize("options", [{"start": (99.0, 99.0, 0.0)}, {"start": (1.0, 1.0)}])
def test_after_a_refused_reset_the_episode_goes_on(options: dict[str, Any]) -> None:
    environment, untouched = (RoombaClean(home=dirty_room()) for _ in range(2))
    for each in (environment, untouched):
        each.reset(seed=1, options=EAST_WARD)
        for _ in range(20):
            each.step(AHEAD)
    with pytest.raises((HomeError, ValueError)):
        environment.reset(seed=9, options=options)
    seen, reward, _, _, info = environment.step(AHEAD)
    expected, expected_reward, _, _, expected_info = untouched.step(AHEAD)
    assert np.array_equal(seen, expected)
    assert reward == expected_reward
    assert repr(info) == repr(expected_info)
    assert np.array_equal(environment.reset()[0], untouched.reset()[0]), "nor was it seeded"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("dt", 0.0),
        ("dt", 1e9),
        ("dt", 1e-9),
        ("dt", math.nan),
        ("steps_per_action", 0),
        ("steps_per_action", 1.5),
        ("steps_per_action", 10**9),
        ("duration", -1),
        ("duration", 1e12),
        ("max_speed", 100.0),
        ("energy_weight", -1.0),
        ("time_weight", math.inf),
    ],
)
def test_a_number_out_of_range_is_refused_by_name(name: str, value: float) -> None:
    task: dict[str, Any] = {name: value}
    with pytest.raises(ValueError, match=f"^{name}: expected .*got {value}"):
        Task(**task)


def test_rewards_add_up_to_dirt_less_energy_and_time() -> None:
    environment = RoombaClean(home=dirty_room(), energy_weight=2.0, time_weight=0.01)
    environment.reset(seed=1, options=EAST_WARD)
    world = environment.fleet
    charge, floor = world.robots["charge"][0], world.dirt(0).total
    total = 0.0
    for _ in range(35):
        _, reward, _, _, info = environment.step(AHEAD)
        total += reward
    assert info["dirt_removed"] == pytest.approx((floor - world.dirt(0).total) / 1e6)
    assert info["energy"] == pytest.approx(charge - world.robots["charge"][0])
    assert info["time"] == pytest.approx(7.0)
    assert info["dirt_removed"] > 0.1
    expected = info["dirt_removed"] - 2.0 * info["energy"] - 0.01 * info["time"]
    assert total == pytest.approx(expected)


def test_standing_is_paid_for_and_brings_nothing() -> None:
    environment = RoombaClean(home=dirty_room())
    environment.reset(seed=1, options=EAST_WARD)
    reward, info = environment.step(STANDING)[1::3]
    assert reward < 0.0
    assert info["dirt_removed"] == info["distance"] == info["collisions"] == 0.0


def test_the_floor_it_drives_over_counts_as_covered() -> None:
    environment = RoombaClean(home=dirty_room())
    _, info = environment.reset(seed=1, options=EAST_WARD)
    at_start = info["covered"]
    for _ in range(25):
        _, _, _, _, info = environment.step(AHEAD)
    swath = 0.2 * info["distance"] / (4.9 * 3.9)
    assert info["covered"] - at_start == pytest.approx(swath, rel=0.05)
    _, info = environment.reset(options=EAST_WARD)
    assert info["covered"] == at_start


def test_an_episode_is_truncated_after_its_duration() -> None:
    environment = RoombaClean(home=dirty_room(), duration=1.0, dt=0.05, steps_per_action=2)
    environment.reset(seed=0)
    for _ in range(2):
        ends = [environment.step(STANDING)[2:4] for _ in range(10)]
        assert ends == [(False, False)] * 9 + [(False, True)]
        environment.reset()


def test_it_is_terminated_when_the_battery_is_empty() -> None:
    config = SimulatedRobotConfig(battery=BatteryConfig(capacity=0.002))
    environment = RoombaClean(home=dirty_room(), config=config)
    observation, _ = environment.reset(seed=0, options=EAST_WARD)
    assert 0.0 < observation[BATTERY] < 1.0
    ends = [environment.step(STANDING)[2] for _ in range(10)]
    assert ends[0] is False
    assert ends[-1] is True


@pytest.mark.parametrize(
    ("home", "capacity"),
    [
        (room_home(sources=(DirtSource("crumbs", 2.0, 2.0, 0.02, 1.0, 0.0),)), 100.0),
        (dirty_room(), 0.05),
    ],
    ids=["the dirt is gone", "the bin is full"],
)
def test_it_is_terminated_when_nothing_more_can_be_cleaned(home: Home, capacity: float) -> None:
    config = SimulatedRobotConfig(
        brush=BrushConfig(bin_capacity=capacity),
        simulation=SimulationConfig(brush=SimulatedBrush(pickup=1.0)),
    )
    environment = RoombaClean(home=home, config=config)
    environment.reset(seed=0, options=EAST_WARD)
    for _ in range(30):
        _, _, terminated, _, info = environment.step(AHEAD)
        if terminated:
            break
    assert terminated
    assert info["dirt_removed"] == pytest.approx(min(capacity, 1.0), rel=0.011)


def test_a_picture_shows_where_the_robot_is() -> None:
    environment = RoombaClean(home=dirty_room(), render_mode="rgb_array")
    environment.reset(seed=0, options={"start": (1.0, 2.0, 0.0)})
    left = environment.render()
    environment.reset(seed=0, options={"start": (4.0, 2.0, 0.0)})
    right = environment.render()
    assert left is not None
    assert right is not None
    assert left.dtype == np.uint8
    columns = np.flatnonzero((left != right).any(axis=(0, 2)))
    assert columns.min() < 0.35 * left.shape[1] < 0.65 * left.shape[1] < columns.max()
    assert RoombaClean(home=dirty_room()).render() is None


def test_observations_tell_nothing_that_the_sensors_do_not() -> None:
    environment = RoombaClean(home=dirty_room(1.0))
    little, _ = environment.reset(seed=2, options=EAST_WARD)
    much, _ = RoombaClean(home=dirty_room(9.0)).reset(seed=2, options=EAST_WARD)
    assert little.shape == (SIZE,)
    assert np.array_equal(little, much), "how much dirt lies about is not seen while standing"
