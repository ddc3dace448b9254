"""The ledgers of an errand, and when they say that it is time to go home."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.mission import EnergyConfig
from roomba.geometry import Pose
from roomba.mission.inputs.senses import Battery, Senses
from roomba.mission.phases.energy import ChargeGains, EnergyLedger

CONFIG = EnergyConfig()
CAPACITY = 26.0


def senses(
    now: float = 0.0, x: float = 0.0, level: float = 1.0, in_bin: float = 0.0, y: float = 0.0
) -> Senses:
    return Senses(now, Pose(x, y, 0.0), battery=Battery(level, CAPACITY), in_bin=in_bin)


def no_way_home(senses: Senses) -> float:
    raise AssertionError("the way home is not needed")


def driven(metres: float, energy: float, level: float = 0.9) -> EnergyLedger:
    """A ledger after so much way, m, and energy, Wh, at such a level."""
    ledger = EnergyLedger(CONFIG, senses(level=level + energy / CAPACITY))
    count = math.ceil(metres / 0.1)
    for step in range(1, count + 1):
        left = energy * (1.0 - step / count)
        ledger.note(senses(0.1 * step, metres * step / count, level + left / CAPACITY))
    return ledger


def test_way_energy_and_dirt_are_counted() -> None:
    ledger = EnergyLedger(CONFIG, senses(in_bin=5.0))
    ledger.note(senses(1.0, 0.2, 0.99, 5.5))
    ledger.note(senses(2.0, 0.2, 0.98, 5.5, y=0.1))
    assert ledger.distance == pytest.approx(0.3)
    assert ledger.energy == pytest.approx(0.02 * CAPACITY)
    assert ledger.dirt == pytest.approx(0.5)


def test_charging_and_an_emptied_bin_take_nothing_away() -> None:
    ledger = EnergyLedger(CONFIG, senses(in_bin=5.0, level=0.5))
    ledger.note(senses(1.0, level=0.4, in_bin=6.0))
    ledger.note(senses(2.0, level=0.9, in_bin=0.0))
    ledger.note(senses(3.0, level=0.8, in_bin=0.5))
    assert ledger.energy == pytest.approx(0.2 * CAPACITY)
    assert ledger.dirt == pytest.approx(1.5)


def test_carried_it_did_not_drive() -> None:
    ledger = EnergyLedger(CONFIG, senses())
    ledger.note(senses(1.0, 3.0))
    assert ledger.distance == 0.0
    ledger.note(senses(1.1, 3.1))
    assert ledger.distance == pytest.approx(0.1)


def test_a_way_that_is_told_counts_whatever_the_straight_one_is() -> None:
    ledger = EnergyLedger(CONFIG, senses())
    ledger.note(senses(3.0, 0.8), 0.9)
    ledger.note(senses(6.0, 0.8), 0.5)
    assert ledger.distance == pytest.approx(1.4)


def test_begun_again_it_counts_from_there() -> None:
    ledger = driven(20.0, 1.0)
    ledger.begin(senses(100.0, 20.0, 0.9, 7.0))
    assert (ledger.distance, ledger.energy, ledger.dirt) == (0.0, 0.0, 0.0)
    ledger.note(senses(100.1, 20.1, 0.9, 7.25))
    assert (ledger.distance, ledger.dirt) == (pytest.approx(0.1), pytest.approx(0.25))


def test_what_a_metre_takes_is_learned() -> None:
    assert driven(5.0, 1.0).per_metre == CONFIG.per_metre
    assert driven(20.0, 1.0).per_metre == pytest.approx(0.05)
    # But it does not drive for nothing.
    assert 0.0 < driven(20.0, 0.0).per_metre < CONFIG.per_metre


def test_what_it_takes_to_stand_is_no_part_of_what_a_metre_takes() -> None:
    ledger = driven(20.0, 1.0)
    ledger.note(senses(4000.0, 20.0, 0.5), drives=False)
    assert ledger.energy == pytest.approx(1.0 + 0.4 * CAPACITY)
    assert ledger.per_metre == pytest.approx(0.05)
    # Its place is not told as the same each time, and that is no way that it drove.
    for step in range(200):
        ledger.note(senses(4001.0 + step, 20.0, 0.5, y=0.1 * (step % 2)), drives=False)
    assert ledger.per_metre == pytest.approx(0.05)


@given(st.floats(0.02, 1.0), st.floats(0.0, 200.0))
def test_it_goes_home_when_what_is_left_just_suffices(level: float, way: float) -> None:
    ledger = EnergyLedger(CONFIG, senses(level=level))
    spare = (level - CONFIG.reserve) * CAPACITY
    need = CONFIG.margin * CONFIG.per_metre * way
    must = ledger.must_go_home(senses(10.0, level=level), lambda senses: way)
    if abs(spare - need) > 1e-6:
        assert must == (spare < need)


def test_with_much_left_the_way_home_is_not_planned() -> None:
    ledger = EnergyLedger(CONFIG, senses())
    assert not ledger.must_go_home(senses(10.0, level=0.8), no_way_home)


def test_while_the_charge_is_ample_no_look_is_due() -> None:
    ledger = EnergyLedger(CONFIG, senses())
    least = CONFIG.reserve + CONFIG.ample
    much, little = senses(level=least + 0.01), senses(level=least - 0.01)
    assert ledger.next_check(much) == math.inf
    assert ledger.least_ample(much) == pytest.approx(least)
    assert ledger.next_check(little) == CONFIG.check_period
    assert ledger.least_ample(little) == CONFIG.empty


def test_where_the_way_home_may_be_long_it_looks_earlier() -> None:
    ledger = EnergyLedger(CONFIG, senses())
    ledger.longest_way_home = 600.0
    need = CONFIG.reserve * CAPACITY + CONFIG.margin * CONFIG.per_metre * 600.0
    much, little = senses(level=need / CAPACITY + 0.01), senses(10.0, level=need / CAPACITY - 0.01)
    assert ledger.next_check(much) == math.inf
    assert ledger.least_ample(much) == pytest.approx(need / CAPACITY)
    assert not ledger.must_go_home(much, no_way_home)
    assert ledger.must_go_home(little, lambda senses: 600.0)


def test_charges_are_in_vain_when_two_in_a_row_bring_nothing() -> None:
    gains = ChargeGains(CONFIG)
    assert [gains.note_charge(area) for area in (0.0, 2.0, 2.0, 2.5, 2.51, 2.52, 2.53)] == [
        False, False, False, False, False, True, True,
    ]  # fmt: skip
    # What grows in any way is progress.
    both = ChargeGains(CONFIG)
    assert not any(both.note_charge(3.0, 0.1 * charge) for charge in range(9))


def test_it_looks_every_few_seconds_whatever_the_clock_does() -> None:
    ledger = EnergyLedger(CONFIG, senses(level=0.1))
    low = 0.081

    def asks(now: float) -> bool:
        asked: list[float] = []

        def way_home(senses: Senses) -> float:
            asked.append(senses.now)
            return 0.0

        assert not ledger.must_go_home(senses(now, level=low), way_home)
        return bool(asked)

    assert [asks(now) for now in (1.0, 4.9, 5.1, 6.0, 10.0, 10.2)] == [
        False, False, True, False, False, True,
    ]  # fmt: skip
    # Set back, it looks at once, and goes on from there.
    assert [asks(now) for now in (-1e5, -1e5 + 1.0, -1e5 + 5.1)] == [True, False, True]


def test_empty_is_when_the_drive_would_stop() -> None:
    ledger = EnergyLedger(CONFIG, senses())
    assert ledger.is_empty(senses(level=0.004))
    assert not ledger.is_empty(senses(level=0.006))


def test_it_is_charged_for_what_is_left_or_nearly_full() -> None:
    ledger = EnergyLedger(CONFIG, senses())
    assert ledger.is_charged(senses(level=CONFIG.full_enough), 1e9)
    assert not ledger.is_charged(senses(level=CONFIG.full_enough - 0.01), 1e9)
    needed = 5.0
    enough = (CONFIG.margin * needed) / CAPACITY + 2.0 * CONFIG.reserve
    assert ledger.is_charged(senses(level=enough + 0.01), needed)
    assert not ledger.is_charged(senses(level=enough - 0.01), needed)
    # Charged, it does not have to go home again at once.
    assert not ledger.must_go_home(senses(10.0, level=enough), lambda senses: 30.0)
