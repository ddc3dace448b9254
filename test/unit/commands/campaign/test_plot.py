"""The picture of a campaign's differences: how far it reaches."""

from __future__ import annotations

import pytest

from roomba.commands.campaign.comparison import Comparison
from roomba.commands.campaign.plot import reach_of


def compared(difference: float, half: float | None, mean: float = 100.0) -> Comparison:
    """A difference with its interval to either side; in % of a mean of 100."""
    low, high = (None, None) if half is None else (difference - half, difference + half)
    return Comparison(
        "other", "distance_m", "", 9, 0, mean, mean + difference, difference, low, high
    )


def test_the_widest_interval_sets_the_scale() -> None:
    found = reach_of([compared(4.0, 2.0), compared(-10.0, 6.0)])
    assert found == pytest.approx(1.25 * 16.0)


def test_a_rare_thing_does_not_press_all_others_together() -> None:
    rare = compared(-0.05, 0.1, mean=0.05)
    assert reach_of([compared(4.0, 2.0), rare]) == pytest.approx(1.25 * 6.0)


@pytest.mark.parametrize("shown", [[], [compared(3.0, None)], [compared(0.0, 0.0)]])
def test_without_an_interval_nothing_sets_it(shown: list[Comparison]) -> None:
    assert reach_of(shown) is None
