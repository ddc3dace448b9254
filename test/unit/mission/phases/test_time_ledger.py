"""How the time of a clean is spent: tick by tick, and over a whole run."""

from __future__ import annotations

from dataclasses import asdict
from functools import cache

import numpy as np
import pytest
from fixtures.robots.missions import HOME

from roomba.clean_request import CleanRequest
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanResult
from roomba.mission.phases.time_ledger import TimeLedger
from roomba.time_spent import TimeSpent
from roomba.vocabulary import Phase

TICK, LIMIT = 0.05, 0.3
FULL = LIMIT * TICK
"""m of way in a tick at top speed."""


def spent(
    phase: Phase, ways: list[float], *, is_again: bool = False, stands: bool = False
) -> TimeSpent:
    ledger = TimeLedger()
    ledger.note(phase, np.array(ways), TICK, LIMIT, is_again=is_again, stands=stands)
    return ledger.spent(0.0, 0.2)


def test_what_is_slower_than_it_may_be_is_told_apart_from_turns() -> None:
    found = spent(Phase.CLEANING, [FULL, 0.5 * FULL, 0.0, 0.05 * FULL, 1.1 * FULL])
    assert found.straight == pytest.approx((1.0 + 0.5 + 0.0 + 0.05 + 1.0) * TICK)
    assert found.slowed == pytest.approx(0.5 * TICK)
    assert found.turning == pytest.approx((1.0 + 0.95) * TICK)
    assert found.under_way == pytest.approx(5.0 * TICK)


@pytest.mark.parametrize(
    ("phase", "part"),
    [
        (Phase.UNDOCKING, "station"),
        (Phase.RETURNING, "station"),
        (Phase.DOCKING, "station"),
        (Phase.EMPTYING, "station"),
        (Phase.CHARGING, "charging"),
        (Phase.PAUSED, "waiting"),
        (Phase.BIN_FULL, "waiting"),
        (Phase.ERROR, "waiting"),
        (Phase.EMERGENCY, "waiting"),
    ],
)
def test_a_phase_counts_as_one_part(phase: Phase, part: str) -> None:
    assert spent(phase, [FULL, 0.0]) == TimeSpent(**{part: 2.0 * TICK})


def test_at_rest_nothing_counts() -> None:
    assert spent(Phase.DOCKED, [0.0]) == spent(Phase.IDLE, [0.0]) == TimeSpent()


def test_later_rounds_and_waits_count_as_such_whatever_it_drives() -> None:
    ways = [FULL, 0.0]
    assert spent(Phase.CLEANING, ways, is_again=True) == TimeSpent(again=2.0 * TICK)
    assert spent(Phase.CLEANING, ways, stands=True) == TimeSpent(waiting=2.0 * TICK)


def test_the_least_is_by_the_top_speed_of_the_clean() -> None:
    ledger = TimeLedger()
    for limit in (0.15, LIMIT, 0.2):
        ledger.note(Phase.CLEANING, np.zeros(1), TICK, limit, is_again=False, stands=False)
    assert ledger.spent(6.0, 0.2).least == pytest.approx(6.0 / (0.2 * LIMIT))


def test_it_goes_on_from_what_was_remembered() -> None:
    ledger, other = TimeLedger(), TimeLedger()
    ledger.note(Phase.CLEANING, np.array([0.01]), TICK, LIMIT, is_again=False, stands=False)
    other.restore(ledger.values())
    assert other.spent(1.0, 0.2) == ledger.spent(1.0, 0.2)
    other.restore({})
    assert other.spent(1.0, 0.2) == TimeSpent()


@cache
def cleaned(longest_burst: int, request: CleanRequest) -> CleanResult:
    robot = HeadlessMission(HOME, seed=3, longest_burst=longest_burst)
    return robot.clean(request).result


def test_all_of_a_clean_is_counted_with_and_without_bursts() -> None:
    found = [cleaned(longest, CleanRequest()) for longest in (0, 100)]
    for result in found:
        parts = asdict(result.times)
        least = parts.pop("least")
        assert sum(parts.values()) == pytest.approx(result.duration, abs=0.2)
        assert least == pytest.approx(result.covered / (0.2 * LIMIT), rel=1e-6)
        assert min(parts["straight"], parts["turning"], parts["slowed"], parts["station"]) > 1.0
    assert asdict(found[0].times) == pytest.approx(asdict(found[1].times), abs=1e-6)


def test_with_two_passes_the_least_is_twice_as_long() -> None:
    once, twice = (cleaned(100, CleanRequest(passes=passes)) for passes in (1, 2))
    assert twice.times.least == pytest.approx(2.0 * once.times.least, rel=0.02)
