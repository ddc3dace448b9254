"""Parts wear by work alone, are due at their hours, and the bin's filling is learned."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.household import UpkeepConfig
from roomba.upkeep.parts import HOUR, Part, PartState, Wear, states_of

CONFIG = UpkeepConfig(brush=300, side_brush=200, filter=150, sensors=30, bin=10, soon=0.1)
CAPACITY = 100.0


def state(wear: Wear, part: Part) -> PartState:
    (found,) = [each for each in states_of(wear, CONFIG, CAPACITY) if each.part is part]
    return found


def test_each_part_has_its_own_hours() -> None:
    wear = Wear().after(20 * HOUR, 0.0)
    left = {each.part: each.left for each in states_of(wear, CONFIG, CAPACITY)}
    assert left == {
        Part.BRUSH: 280.0,
        Part.SIDE_BRUSH: 180.0,
        Part.FILTER: 130.0,
        Part.SENSORS: 10.0,
        Part.BIN: 0.0,
    }


def test_what_is_to_be_done_is_told_soon_and_when_it_is_due() -> None:
    wear = Wear().after(26 * HOUR, 0.0)
    assert state(wear, Part.SENSORS).advice == ""
    wear = wear.after(1.5 * HOUR, 0.0)
    assert state(wear, Part.SENSORS).advice.endswith("contacts soon")
    assert not state(wear, Part.SENSORS).is_due
    wear = wear.after(3 * HOUR, 0.0)
    assert state(wear, Part.SENSORS).is_due
    assert state(wear, Part.SENSORS).advice.endswith("then reset it")
    assert state(wear.reset(Part.SENSORS), Part.SENSORS).left == 30.0
    assert state(wear.reset(Part.SENSORS), Part.BRUSH).left == pytest.approx(300 - 30.5)


def test_a_bin_that_fills_fast_is_due_sooner() -> None:
    wear = Wear().after(HOUR, 40.0)
    assert state(wear, Part.BIN).left == pytest.approx(1.5)
    assert state(wear, Part.BIN).life == pytest.approx(2.5)
    assert state(wear.after(HOUR, 100.0), Part.BIN).is_due


def test_how_fast_the_bin_fills_is_remembered_when_it_is_emptied() -> None:
    full = Wear().after(2 * HOUR, 80.0)
    for emptied in (full.reset(Part.BIN), full.after(0.0, 1.0)):
        assert emptied.rate() * HOUR == pytest.approx(40.0, rel=0.03)
        assert state(emptied, Part.BIN).left == pytest.approx(2.5, rel=0.05)
    slower = full.reset(Part.BIN).after(HOUR, 20.0)
    assert slower.rate() * HOUR == pytest.approx(30.0)


def test_a_bin_that_is_nearly_empty_is_not_taken_for_emptied() -> None:
    wear = Wear().after(HOUR, 0.9).after(HOUR, 0.1)
    assert wear.hours(Part.BIN) == 2.0


def test_what_is_no_work_is_refused() -> None:
    for work, in_bin in ((-1.0, 0.0), (math.nan, 0.0), (math.inf, 0.0), (1.0, -1.0)):
        with pytest.raises(ValueError, match="seconds and grams"):
            Wear().after(work, in_bin)


@given(
    st.lists(
        st.tuples(st.floats(0.0, 50 * HOUR), st.floats(0.0, 150.0), st.sampled_from([None, *Part])),
        max_size=30,
    )
)
def test_no_part_has_more_than_its_life_or_less_than_nothing(
    steps: list[tuple[float, float, Part | None]],
) -> None:
    wear, worked = Wear(), dict.fromkeys(Part, 0.0)
    for work, in_bin, reset in steps:
        wear = wear.after(work, in_bin)
        worked = {part: before + work for part, before in worked.items()}
        if reset is not None:
            wear, worked[reset] = wear.reset(reset), 0.0
    for each in states_of(wear, CONFIG, CAPACITY):
        assert each.left >= 0.0
        assert 0.0 <= each.share <= 1.0
        assert each.is_due == (each.left == 0.0)
    for part in set(Part) - {Part.BIN}:  # which is emptied by the dirt in it, too
        assert wear.hours(part) * HOUR == pytest.approx(worked[part])
