"""Whichever faults the robot has, its promises hold.

The examples are few and the same in every run of the suite. ``ROOMBA_EXAMPLES=2000`` tries so many
others; ``./roomba soak --headless HOURS`` tries ten an hour.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Final

import numpy as np
import pytest
from fixtures.homes.worlds import IDEAL
from fixtures.robots.faulty_robot import FaultyRobot
from fixtures.robots.missions import FLOOR_TOO_LITTLE, HOME, floor_clean
from fixtures.thoroughness import core_first
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule, run_state_machine_as_test

from roomba.clean_request import CleanRequest
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.phases.machine import Event
from roomba.vocabulary import CleanMode
from roomba.world.engine.state.arrays import Fault

MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
SETTINGS: Final = settings(
    max_examples=MORE or 12,
    stateful_step_count=12,
    derandomize=not MORE,
    deadline=None,
    print_blob=True,
    suppress_health_check=list(HealthCheck),
)
SMALL_BIN: Final = IDEAL.with_sensors("noisy").model_copy(
    update={"brush": IDEAL.brush.model_copy(update={"bin_capacity": 1.5})}
)
REQUESTS: Final = (
    CleanRequest(),
    CleanRequest(passes=2),
    CleanRequest(CleanMode.SPOT, spot=(2.0, 0.6)),
    CleanRequest(CleanMode.ZONES, zones=((0.8, 1.6, 1.6, 2.3),)),
    CleanRequest(CleanMode.EDGES),
)
COMMANDS: Final = (
    Event.PAUSE,
    Event.RESUME,
    Event.STOP,
    Event.DOCK,
    Event.UNDOCK,
    Event.EMERGENCY,
    Event.RELEASE,
)


class Faults(RuleBasedStateMachine):
    """A robot to which everything happens in any order; see :class:`FaultyRobot` for what holds."""

    def __init__(self) -> None:
        super().__init__()
        self.folder = tempfile.TemporaryDirectory()

    @initialize(seed=st.integers(0, 50), has_small_bin=st.booleans())
    def begin(self, seed: int, has_small_bin: bool) -> None:
        config = SMALL_BIN if has_small_bin else None
        self.it = FaultyRobot(Path(self.folder.name), seed, config)
        self.it.clean(CleanRequest())

    @rule(request=st.sampled_from(REQUESTS))
    def clean(self, request: CleanRequest) -> None:
        self.it.clean(request)

    @rule(event=st.sampled_from(COMMANDS))
    def command(self, event: Event) -> None:
        self.it.command(event)

    @rule(seconds=st.floats(0.1, 40.0))
    def wait(self, seconds: float) -> None:
        self.it.wait(seconds)

    @rule(fault=st.sampled_from(list(Fault)), value=st.sampled_from([0.0, 0.5, 1.0]))
    def fail(self, fault: Fault, value: float) -> None:
        self.it.inject(fault, value)

    @rule(x=st.floats(0.2, 2.8), y=st.floats(0.2, 2.3), theta=st.floats(-3.1, 3.1))
    def carry(self, x: float, y: float, theta: float) -> None:
        self.it.carry(x, y, theta)

    @rule(x=st.floats(0.1, 2.9), y=st.floats(0.1, 2.4))
    def block(self, x: float, y: float) -> None:
        self.it.block(x, y)

    @rule()
    def block_station(self) -> None:
        self.it.block(HOME.station.x + 0.5, HOME.station.y)

    @rule(level=st.floats(0.02, 1.0))
    def discharge(self, level: float) -> None:
        self.it.discharge(level)

    @rule(grams=st.floats(0.1, 3.0))
    def spill(self, grams: float) -> None:
        self.it.spill(grams)

    @rule()
    def empty_bin(self) -> None:
        self.it.empty_bin()

    @rule(by=st.sampled_from([-1e5, -10.0, -0.3, 3600.0]))
    def set_clock(self, by: float) -> None:
        self.it.set_clock(by)

    @rule()
    def kill(self) -> None:
        self.it.kill()

    @rule()
    def mend(self) -> None:
        self.it.mend()

    def teardown(self) -> None:
        try:
            if hasattr(self, "it"):
                self.it.end()
        finally:
            self.folder.cleanup()


def test_whatever_happens_what_is_promised_holds() -> None:
    run_state_machine_as_test(Faults, settings=SETTINGS)


@pytest.mark.parametrize("seed", range(MORE) if MORE else core_first(range(3), {0}))
def test_killed_anywhere_the_same_floor_is_clean_at_the_end(tmp_path: Path, seed: int) -> None:
    whole = HeadlessMission(HOME, IDEAL, seed=seed).clean()
    random = np.random.default_rng(seed)
    it = FaultyRobot(tmp_path, seed, IDEAL)
    it.clean(CleanRequest())
    while it.ended < it.accepted:
        it.wait(float(random.uniform(0.0, 30.0)))
        it.kill()
    (result,) = it.results
    assert result.outcome is whole.result.outcome is CleanOutcome.COMPLETED
    assert floor_clean(it.robot) >= FLOOR_TOO_LITTLE
    assert result.wanted == whole.result.wanted
    assert result.covered == pytest.approx(whole.result.covered, rel=0.002)
