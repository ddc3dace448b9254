import copy
import re
from typing import Any

import gymnasium
import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import roomba.gym
from roomba.errors import HomeError
from roomba.gym import RoombaClean, RoombaCleanVector
from roomba.gym.observation import SIZE
from roomba.world.home.home import DirtSource

ROBOTS = 16
TASK: dict[str, Any] = {
    "home": room_home(sources=(DirtSource("dust", 2.5, 2.0, 1.0, 5.0, 40.0),)),
    "duration": 2.0,
}


def test_make_vec_makes_it() -> None:
    robots = gymnasium.make_vec(
        roomba.gym.ENVIRONMENT,
        num_envs=3,
        vectorization_mode="vector_entry_point",
        home="studio",
        duration=10.0,
    )
    assert isinstance(robots, RoombaCleanVector)
    assert robots.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    assert robots.num_envs == 3
    robots.close()
    robots.close()


def test_arrays_have_a_row_for_each_robot() -> None:
    robots = RoombaCleanVector(ROBOTS, **TASK)
    observations, infos = robots.reset(seed=0)
    assert robots.observation_space.contains(observations)
    assert robots.single_observation_space.shape == (SIZE,)
    for _ in range(3):
        actions = robots.action_space.sample()
        observations, rewards, terminated, truncated, infos = robots.step(actions)
        assert robots.observation_space.contains(observations)
        assert rewards.shape == terminated.shape == truncated.shape == (ROBOTS,)
        assert (rewards.dtype, terminated.dtype, truncated.dtype) == (np.float64, bool, bool)
        assert infos["pose"].shape == (ROBOTS, 3)
        assert infos["_pose"].all()
        assert {name for name in infos if name[0] != "_"} == {
            "pose",
            "covered",
            "dirt_removed",
            "energy",
            "distance",
            "collisions",
            "time",
        }


def test_what_was_returned_stays_as_it_was() -> None:
    robots = RoombaCleanVector(ROBOTS, **TASK)
    robots.reset(seed=0)
    first = robots.step(np.ones((ROBOTS, 2), np.float32))
    observations, rewards = first[0].copy(), first[1].copy()
    infos = {name: values.copy() for name, values in first[4].items()}
    robots.step(np.zeros((ROBOTS, 2), np.float32))
    assert np.array_equal(first[0], observations)
    assert np.array_equal(first[1], rewards)
    for name, values in first[4].items():
        assert np.array_equal(values, infos[name]), name


@pytest.mark.parametrize("threads", [1, 2])
def test_every_robot_lives_as_it_would_alone(threads: int) -> None:
    """Bit for bit what gymnasium's own loop over single environments gives, through autoresets."""
    ours = RoombaCleanVector(ROBOTS, threads=threads, **TASK)
    theirs: Any = SyncVectorEnv([lambda: RoombaClean(**TASK)] * ROBOTS)
    ours_first, theirs_first = ours.reset(seed=11), theirs.reset(seed=11)
    assert np.array_equal(ours_first[0], theirs_first[0])
    random = np.random.default_rng(0)
    ended = 0
    for _ in range(25):
        actions = random.uniform(-1.0, 1.0, (ROBOTS, 2)).astype(np.float32)
        got, wanted = ours.step(actions), theirs.step(actions)
        parts: list[tuple[Any, Any]] = list(zip(got[:4], wanted[:4], strict=True))
        for ours_part, theirs_part in parts:
            assert np.array_equal(ours_part, theirs_part)
        assert got[4].keys() == wanted[4].keys()
        for name, values in got[4].items():
            assert np.array_equal(values, wanted[4][name]), name
        ended += int(got[3].sum())
    assert ended == 2 * ROBOTS


def test_what_has_ended_begins_anew_with_the_next_step() -> None:
    robots = RoombaCleanVector(2, **TASK)
    robots.reset(seed=0)
    actions = np.ones((2, 2), np.float32)
    for _ in range(10):
        _, rewards, _, truncated, infos = robots.step(actions)
    assert truncated.all()
    assert infos["time"] == pytest.approx([2.0, 2.0])
    _, rewards, terminated, truncated, infos = robots.step(actions)
    assert not (terminated | truncated).any()
    assert rewards.tolist() == infos["time"].tolist() == infos["distance"].tolist() == [0.0, 0.0]
    _, rewards, _, _, infos = robots.step(actions)
    assert infos["time"] == pytest.approx([0.2, 0.2])


def test_only_what_has_ended_begins_anew() -> None:
    home = room_home(sources=(DirtSource("crumbs", 2.0, 2.0, 0.02, 1.0, 0.0),))
    robots = RoombaCleanVector(2, home=home)
    robots.reset(seed=0, options={"start": (1.5, 2.0, 0.0)})
    actions = np.array([[1.0, 0.0], [0.0, 0.0]], np.float32)
    back = np.array([[-1.0, 0.0], [0.0, 0.0]], np.float32)
    for number in range(400):
        terminated = robots.step(actions if number % 20 < 10 else back)[2]
        if terminated.any():
            break
    assert terminated.tolist() == [True, False]
    infos = robots.step(actions)[4]
    assert infos["time"][0] == 0.0
    assert infos["time"][1] == pytest.approx(0.2 * (number + 2))


def test_a_copy_goes_on_as_the_original_does() -> None:
    robots = RoombaCleanVector(ROBOTS, threads=2, **TASK)
    robots.reset(seed=3)
    actions = np.ones((ROBOTS, 2), np.float32)
    robots.step(actions)
    other = copy.deepcopy(robots)
    for _ in range(12):
        seen, expected = other.step(actions), robots.step(actions)
        assert np.array_equal(seen[0], expected[0])
        assert np.array_equal(seen[1], expected[1])
    robots.close()
    other.close()


def test_seeds_are_one_for_each_or_the_first_in_a_row() -> None:
    robots = RoombaCleanVector(3, **TASK)
    in_a_row, _ = robots.reset(seed=7)
    by_list, _ = robots.reset(seed=[7, 8, 9])
    onwards, _ = robots.reset()
    assert np.array_equal(in_a_row, by_list)
    assert not np.array_equal(by_list, onwards)
    robots.reset(seed=7)
    assert np.array_equal(robots.reset()[0], onwards), "also what comes later is of the seed"
    with pytest.raises(ValueError, match="3 seeds"):
        robots.reset(seed=[1, 2])


def test_it_must_be_reset_first() -> None:
    with pytest.raises(RuntimeError, match="reset"):
        RoombaCleanVector(2, **TASK).step(np.zeros((2, 2), np.float32))


@pytest.mark.parametrize("shape", [(2,), (3, 2), (2, 3), (2, 2, 1), ()])
def test_actions_of_another_shape_are_refused(shape: tuple[int, ...]) -> None:
    robots = RoombaCleanVector(2, **TASK)
    robots.reset(seed=1)
    with pytest.raises(ValueError, match=re.escape(f"shape (2, 2), got {shape}")):
        robots.step(np.zeros(shape, np.float32))


def test_an_action_that_is_not_finite_is_told_with_its_robot() -> None:
    robots = RoombaCleanVector(2, **TASK)
    robots.reset(seed=1)
    with pytest.raises(ValueError, match=r"finite numbers, got \[0.0, inf\] for robot 1"):
        robots.step(np.array([(0.0, 0.0), (0.0, np.inf)], np.float32))


def test_after_a_refused_reset_all_episodes_go_on() -> None:
    robots, untouched = (RoombaCleanVector(3, **TASK) for _ in range(2))
    actions = np.ones((3, 2), np.float32)
    for each in (robots, untouched):
        each.reset(seed=1)
        for _ in range(5):
            each.step(actions)
    with pytest.raises(HomeError, match="does not fit"):
        robots.reset(seed=9, options={"start": (99.0, 99.0, 0.0)})
    with pytest.raises(ValueError, match="3 seeds"):
        robots.reset(seed=[1, 2])
    # Past the end of these episodes: the next ones are those of the first seeds too.
    for _ in range(8):
        seen, expected = robots.step(actions), untouched.step(actions)
        assert np.array_equal(seen[0], expected[0])
        assert np.array_equal(seen[1], expected[1])


def test_at_least_one_robot_is_expected() -> None:
    with pytest.raises(ValueError, match="1 or more"):
        RoombaCleanVector(0)


def test_each_world_has_its_picture() -> None:
    robots = RoombaCleanVector(2, render_mode="rgb_array", **TASK)
    robots.reset(seed=0)
    first, second = robots.render() or ()
    assert first.shape == second.shape
    assert (first != second).any()
    assert RoombaCleanVector(2, **TASK).render() is None
