"""Clocks in other units, and such as are a little fast or slow."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.recordings.times.clock_rate import drift_of, drift_of_played, drift_of_recorder, unit_of

Floats = NDArray[np.float64]


def drive(seconds: float = 100.0) -> tuple[Floats, Floats]:
    """Return stamps and arrivals of a clock that is right, s; some messages are held up."""
    random = np.random.default_rng(1)
    stamps = 1.6e9 + np.arange(0.0, seconds, 0.1)
    delays = random.uniform(0.02, 0.04, len(stamps))
    delays[random.integers(0, len(stamps), 20)] += 0.5
    return stamps, stamps + delays


@pytest.mark.parametrize(("unit", "name"), [(1.0, "s"), (1e3, "ms"), (1e6, "µs"), (1e9, "ns")])
@pytest.mark.parametrize("since", [0.0, -1.59e9])
def test_the_unit_of_stamps_is_found(unit: float, name: str, since: float) -> None:
    stamps, arrivals = drive()
    assert unit_of(unit * (stamps + since), arrivals) == (unit, name)


@pytest.mark.parametrize("rate", [-0.02, -0.001, 0.001, 0.02])
def test_a_clock_that_is_fast_or_slow_is_told(rate: float) -> None:
    stamps, arrivals = drive()
    told = stamps[0] + (1.0 + rate) * (stamps - stamps[0])
    assert drift_of(told, arrivals) == pytest.approx(-rate, abs=3e-4)


def test_the_clock_of_the_recorder_goes_at_any_rate_that_two_channels_tell() -> None:
    assert drift_of_recorder(0.5, [0.5, 0.502, 0.0]) == 0.5
    assert drift_of_recorder(-1.0, [-1.01, -1.0]) == -1.0
    assert drift_of_recorder(0.5, [0.0, 0.5]) == 0.0


@pytest.mark.parametrize("rate", [0.1, 0.5, 2.0, 10.0])
def test_a_rate_at_which_something_was_played_is_told(rate: float) -> None:
    stamps, arrivals = drive()
    told = stamps[0] + rate * (stamps - stamps[0])
    assert drift_of_played(told, arrivals) == pytest.approx(1.0 - rate, rel=0.01)


def test_stamps_that_do_not_go_on_at_one_rate_tell_none() -> None:
    stamps, arrivals = drive()
    half = len(stamps) // 2
    set_back = np.concatenate((stamps[:half], stamps[:half]))
    two_rates = stamps + np.maximum(stamps - stamps[half], 0.0)
    for wrong in (set_back, two_rates, stamps[::-1], np.zeros(len(stamps))):
        assert drift_of_played(wrong, arrivals) == 0.0
    assert drift_of_played(stamps[:40], arrivals[:40]) == 0.0
    assert drift_of_played(stamps, np.zeros(len(stamps))) == 0.0


def test_a_clock_that_is_right_does_not_drift() -> None:
    assert abs(drift_of(*drive())) < 2e-4


def test_a_clock_that_jumps_or_of_which_little_is_known_tells_nothing() -> None:
    stamps, arrivals = drive()
    jumped = np.where(np.arange(len(stamps)) < 600, stamps, stamps + 0.8)
    assert drift_of(jumped, arrivals) == 0.0
    assert drift_of(stamps[:40], arrivals[:40]) == 0.0
    assert drift_of(stamps, np.zeros(len(stamps))) == 0.0
    assert unit_of(1e3 * stamps, np.zeros(len(stamps))) == (1.0, "s")
    assert unit_of(np.zeros(len(stamps)), arrivals) == (1.0, "s")
    # Of a coarse clock steps are mistaken for a drift.
    assert drift_of(np.floor(2.0 * stamps[:205]) / 2.0, arrivals[:205]) == 0.0
    # Far too much for a clock: something else is wrong.
    assert drift_of(stamps[0] + 1.2 * (stamps - stamps[0]), arrivals) == 0.0
