"""When another round over what a stage missed is worth it."""

from __future__ import annotations

import pytest

from roomba.configuration.mission import CleaningConfig
from roomba.mission.cleaning.rounds import Rounds

CONFIG = CleaningConfig()


@pytest.fixture
def rounds() -> Rounds:
    return Rounds(CONFIG)


def test_the_first_round_is_one_that_was_not_begun(rounds: Rounds) -> None:
    assert rounds.is_first
    rounds.begin(10.0)
    assert not rounds.is_first
    rounds.begin_stage()
    assert rounds.is_first
    rounds.begin_stage(is_driven=True)
    assert not rounds.is_first


def test_they_are_over_when_one_gains_little(rounds: Rounds) -> None:
    rounds.begin(10.0)
    assert not rounds.is_over(5.0)
    rounds.begin(5.0)
    enough, little = (5.0 * (1.0 - CONFIG.little_gain * part) for part in (1.01, 0.99))
    assert not rounds.is_over(enough)
    assert rounds.is_over(little)
    rounds.cut_off()
    assert not rounds.is_over(little)


def test_they_are_over_when_there_were_enough(rounds: Rounds) -> None:
    missed = 1.0
    for _ in range(CONFIG.most_rounds):
        rounds.begin(missed)
        missed /= 10.0
        assert not rounds.is_over(missed)
    rounds.begin(missed)
    assert rounds.is_over(0.0)


def test_what_was_cut_off_is_no_round_a_limited_number_of_times(rounds: Rounds) -> None:
    for _ in range(CONFIG.most_cut_offs):
        rounds.begin(1.0)
        rounds.cut_off()
        assert not rounds.is_over(1.0)
    for _ in range(CONFIG.most_rounds):
        rounds.begin(1.0)
        rounds.cut_off()
    assert rounds.is_over(1.0)


def test_a_plan_that_is_made_anew_is_so_once(rounds: Rounds) -> None:
    rounds.begin(1.0)
    assert not rounds.take_anew()
    rounds.begin_anew()
    assert not rounds.is_over(1.0)
    assert rounds.take_anew()
    assert not rounds.take_anew()


def test_a_short_way_is_not_planned_anew_nor_one_too_soon_nor_too_often(rounds: Rounds) -> None:
    least, period, begin = CONFIG.least_way_to_replan, CONFIG.replan_period, 500.0
    assert not rounds.begin_replan(begin, 0.99 * least)
    assert rounds.begin_replan(begin, least)
    assert not rounds.begin_replan(begin + 0.99 * period, least)
    # A clock that was set back holds up nothing.
    assert rounds.begin_replan(begin - 1.0, least)
    done = 2
    while rounds.begin_replan(begin + done * period, least):
        done += 1
    assert done == CONFIG.most_replans


def test_a_robot_that_is_shut_in_tries_to_get_out_a_limited_number_of_times(
    rounds: Rounds,
) -> None:
    rounds.begin(3.0)
    tries = 0
    while rounds.count_way_out():
        rounds.take_back()
        assert rounds.is_first
        rounds.begin(3.0)
        tries += 1
    assert tries == CONFIG.most_ways_out
