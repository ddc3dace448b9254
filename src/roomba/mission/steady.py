"""Steady ticks: ticks whose work is known in advance, as long as nothing comes up.

A program that lets time pass may do them in compiled code, with the same result. The mission's own
tick takes over at the first tick at which a bound given here does not hold any more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

from roomba.mission.driving.drives import Drives
from roomba.mission.driving.path_driver import PathDriver
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.at_station import AtStation
from roomba.mission.phases.job import Job
from roomba.mission.phases.monitor import Monitor
from roomba.vocabulary import Phase

_ALONG_PATHS: Final = (Phase.CLEANING, Phase.EXPLORING, Phase.RETURNING)


@dataclass(frozen=True, slots=True)
class Steady:
    """The bounds that end steady ticks; they are checked before each tick.

    ``driver`` is tracked along its path, at up to ``limit`` m/s; None: it stands and charges.
    ``until``
        s of the robot's clock, at which the mission has something to check.
    ``least_level``, ``most_energy``
        0..1 and Wh; steady ticks end with less, or with as much, in the battery.
    ``most_in_bin``, ``most_silent``
        g in the dust bin, and m2 of floor that became clean without a grain that came in.
    ``goal``, ``near``
        m; where the robot is to get, and how near to it the robot is there.
    ``watches_dirt``
        Dirty floor close by is swept once more before the robot goes on.
    """

    driver: PathDriver | None
    limit: float = 0.0
    until: float = math.inf
    least_level: float = 0.0
    most_energy: float = math.inf
    most_in_bin: float = math.inf
    most_silent: float = math.inf
    goal: tuple[float, float] = (0.0, 0.0)
    near: float = -1.0
    watches_dirt: bool = False


class SteadyTicks:
    """Finds out whether the next ticks are steady, and what ends them."""

    def __init__(
        self,
        job: Job,
        drives: Drives,
        at_station: AtStation,
        monitor: Monitor,
        retries: RetryPolicy,
    ) -> None:
        """Take the mission's parts."""
        self._job, self._drives, self._at_station = job, drives, at_station
        self._monitor, self._retries = monitor, retries

    def after(self, senses: Senses, phase: Phase, limit: float, *, sweeps: bool) -> Steady | None:
        """Return what the mission does from these senses on; None: its own tick decides.

        It drives at ``limit`` m/s at most; ``sweeps``: what it drives over counts as cleaned.
        """
        if phase is Phase.CHARGING:
            return self._charging(senses)
        driver = self._driver_in(phase)
        if driver is None:
            return None
        if phase is Phase.RETURNING:
            steady = self._returning(driver, limit)
        else:
            ledger = self._job.ledger
            steady = Steady(driver, limit, ledger.next_check(senses), ledger.least_ample(senses))
            steady = replace(steady, watches_dirt=self._watches_dirt(phase))
        return self._until_bin_full(steady, senses) if sweeps else steady

    def _charging(self, senses: Senses) -> Steady | None:
        needed = self._at_station.needed
        if needed is None or not senses.battery.is_docked:
            return None
        return Steady(None, most_energy=self._job.ledger.charged_at(senses, needed))

    def _driver_in(self, phase: Phase) -> PathDriver | None:
        """Return what drives along a path with nothing else to decide."""
        driver = self._drives.driver
        if phase not in _ALONG_PATHS or driver is None or not driver.is_tracking:
            return None
        is_retrying = self._retries.is_pending and phase is not Phase.EXPLORING
        return None if is_retrying or self._monitor.is_astray else driver

    def _watches_dirt(self, phase: Phase) -> bool:
        cleaning = self._job.cleaning
        is_round = phase is Phase.CLEANING and self._drives.is_round
        return is_round and cleaning is not None and cleaning.watches_dirt

    def _returning(self, driver: PathDriver, limit: float) -> Steady:
        context, empty = self._drives.context, self._job.ledger.empty
        goal = context.staging.x, context.staging.y
        near = context.staging_tolerance
        return Steady(driver, limit, least_level=empty, goal=goal, near=near)

    def _until_bin_full(self, steady: Steady, senses: Senses) -> Steady:
        """Let steady ticks end when the bin may have become full."""
        dust_bin = self._job.bin
        most_silent = dust_bin.most_silent if dust_bin.heeds_silence(senses.in_bin) else math.inf
        return replace(steady, most_in_bin=dust_bin.full_from, most_silent=most_silent)
