"""The station empties the bin as long as it is told to, and reports its bag; without a graph."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest
from fixtures.nodes.lockstep import Lockstep
from std_msgs.msg import Bool

from roomba.configuration.simulation import SimulatedStation
from roomba.world.emptying import EmptyingStation
from roomba_ros.simulation.station_link import StationLink

TICK, SILENCE = 0.05, 0.5
GRAMS = 5.0
CONFIG = SimulatedStation()
Told = tuple[bool, float]


class Rig:
    """A link, the bin of a robot on the station, and what the station tells."""

    def __init__(self, lockstep: Lockstep, station: EmptyingStation | None) -> None:
        self.lockstep, self.station, self.in_bin, self.ticks = lockstep, station, GRAMS, 0
        self.link = StationLink(station, SILENCE, threading.Lock())
        self.link.start()
        self.told: list[Told] = []
        lockstep.hear(
            "/emptying_station", lambda told: self.told.append((told.is_at_work, told.bag))
        )

    def passes(self, seconds: float, *, wanted: bool | None) -> None:
        """Let time pass, in which it is told at each tick what is wanted; None: nothing is."""
        for _ in range(round(seconds / TICK)):
            if wanted is not None:
                self.lockstep.publish("/emptying_wanted", Bool(wanted))
            self.link.step(TICK)
            if self.station is not None:
                self.in_bin -= self.station.pass_time(TICK, self.in_bin, is_docked=True)
            self.ticks += 1
            self.link.tell(self.ticks)
            self.lockstep.deliver()


@pytest.fixture
def lockstep() -> Iterator[Lockstep]:
    with Lockstep().installed() as ros:
        yield ros


def test_it_empties_the_bin_while_it_is_told_to_and_tells_of_each_change(
    lockstep: Lockstep,
) -> None:
    rig = Rig(lockstep, EmptyingStation(CONFIG))
    rig.passes(0.1, wanted=None)
    assert rig.told == [(False, 0.0)]
    rig.passes(CONFIG.emptying_time + 0.1, wanted=True)
    assert rig.in_bin == 0.0
    # Once a second, and when it begins and ends.
    bag = pytest.approx(GRAMS / CONFIG.bag)
    assert rig.told[1] == (True, 0.0)
    assert rig.told[-1] == (False, bag)
    assert len(rig.told) == pytest.approx(CONFIG.emptying_time + 3, abs=1)
    assert rig.station is not None
    rig.station.replace_bag()
    rig.passes(TICK, wanted=False)
    assert rig.told[-1] == (False, 0.0)


def test_a_gap_between_two_messages_is_bridged_and_silence_ends_it(lockstep: Lockstep) -> None:
    rig = Rig(lockstep, EmptyingStation(CONFIG))
    rig.passes(1.0, wanted=True)
    rig.passes(SILENCE - 2 * TICK, wanted=None)
    rig.passes(1.0, wanted=True)
    assert (False, 0.0) not in rig.told[1:]
    rig.passes(SILENCE + 2 * TICK, wanted=None)
    assert rig.told[-1] == (False, 0.0)
    assert rig.in_bin == GRAMS


def test_it_ends_at_once_when_it_is_told_so(lockstep: Lockstep) -> None:
    rig = Rig(lockstep, EmptyingStation(CONFIG))
    rig.passes(1.0, wanted=True)
    rig.passes(TICK, wanted=False)
    assert rig.told[-1] == (False, 0.0)


def test_another_station_tells_nothing(lockstep: Lockstep) -> None:
    rig = Rig(lockstep, None)
    rig.passes(2.0, wanted=True)
    assert rig.told == []
