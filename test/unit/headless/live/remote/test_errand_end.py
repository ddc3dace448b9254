"""Where a robot with its own brain comes to rest shows how its clean ended."""

from __future__ import annotations

import math

import pytest

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.headless.live.remote.errand_end import ErrandEnd
from roomba.robot.remote import RemoteState
from roomba.vocabulary import Phase


def after(*phases: Phase, trouble: str = "") -> CleanReport | None:
    """Return what is told after looks at these phases, a minute apart, the last with a trouble."""
    errand = ErrandEnd()
    for index, phase in enumerate(phases):
        told = trouble if index == len(phases) - 1 else ""
        errand.look(RemoteState(phase, 0.5, is_charging=False, trouble=told), 60.0 * index)
    return errand.last


@pytest.mark.parametrize(
    ("rest", "trouble", "outcome"),
    [
        (Phase.DOCKED, "", ErrandOutcome.COMPLETED),
        (Phase.DOCKED, "the bin is missing", ErrandOutcome.FAULT),
        (Phase.IDLE, "", ErrandOutcome.STOPPED),
        (Phase.IDLE, "a wheel is stuck", ErrandOutcome.FAULT),
    ],
)
def test_a_clean_ended_by_where_it_rests(rest: Phase, trouble: str, outcome: ErrandOutcome) -> None:
    last = after(Phase.DOCKED, Phase.CLEANING, Phase.RETURNING, rest, trouble=trouble)
    assert last is not None
    assert (last.outcome, last.duration) == (outcome, 120.0)
    assert trouble in last.message
    assert math.isnan(last.covered)


def test_until_it_rests_it_goes_on() -> None:
    """Also where it stands meanwhile, to charge or because it was told to pause."""
    way = (Phase.DOCKED, Phase.CLEANING, Phase.PAUSED, Phase.CLEANING, Phase.CHARGING)
    assert after(*way, Phase.CLEANING, Phase.RETURNING) is None
    last = after(*way, Phase.CLEANING, Phase.RETURNING, Phase.DOCKED, Phase.DOCKED)
    assert last is not None
    assert last.duration == 360.0


def test_a_way_home_alone_is_no_clean_but_one_that_was_under_way_already_may_be() -> None:
    assert after(Phase.IDLE, Phase.RETURNING, Phase.DOCKED) is None
    assert after(Phase.RETURNING, Phase.DOCKED) is not None
