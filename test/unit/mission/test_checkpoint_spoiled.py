"""Any checkpoint: the mission resumes from it and can go on, or refuses it and is idle.

``ROOMBA_EXAMPLES=5000`` tries so many, others each time.
"""

from __future__ import annotations

import functools
import json
import os
import time
from typing import Any, Final

import pytest
from fixtures.homes.worlds import IDEAL
from fixtures.robots.missions import HOME, wait
from fixtures.spoiled import NUMBERS, spoiled_values
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.checkpoint import CheckpointError
from roomba.mission.commands import CommandRefusedError
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Event
from roomba.vocabulary import CleanMode, Phase

MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
FUZZ: Final = settings(
    max_examples=MORE or 60,
    derandomize=not MORE,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
SOON: Final = 5.0
"""s of processor time."""


@functools.cache
def robot() -> HeadlessMission:
    """Return a robot in the middle of a clean."""
    found = HeadlessMission(HOME, IDEAL)
    found.mission.clean(CleanRequest(), found.senses())
    wait(found, 60.0)
    return found


def fresh() -> Mission:
    it = robot()
    return Mission(
        it.context, it.robot_config, it.config, DockingConfig(), it.things, it.dirt, it.senses()
    )


@functools.cache
def values_of(phase: str) -> str:
    """Return a whole checkpoint of a phase, as JSON."""
    it = robot()
    if phase == "paused":
        it.mission.command(Event.PAUSE, it.senses())
    values = it.mission.checkpoint(it.senses())
    assert values is not None
    if phase == "paused":
        it.mission.command(Event.RESUME, it.senses())
    return json.dumps(values)


@pytest.mark.parametrize("phase", ["cleaning", "paused"])
def test_a_spoiled_checkpoint_is_taken_up_or_refused(phase: str) -> None:
    whole = json.loads(values_of(phase))

    @FUZZ
    @given(spoiled_values(whole))
    def try_one(values: dict[str, Any]) -> None:
        began, mission, it, refusal = time.process_time(), fresh(), robot(), ""
        try:
            mission.restore(values, it.senses())
        except CheckpointError as error:
            refusal = str(error) or "nothing was said"
        assert refusal != "nothing was said"
        assert not refusal or mission.state.phase in (Phase.IDLE, Phase.DOCKED)
        for _ in range(3):
            assert mission.tick(it.senses()).twist.is_finite
        again = mission.checkpoint(it.senses())
        json.dumps(again, allow_nan=False)
        assert time.process_time() - began < SOON

    try_one()


ANY: Final = st.one_of(
    st.floats(), st.sampled_from([float(number) for number in NUMBERS]), st.floats(-5.0, 5.0)
)
TEXTS: Final = st.text(max_size=60)


@FUZZ
@given(
    mode=st.sampled_from(CleanMode),
    rooms=st.lists(st.one_of(TEXTS, st.sampled_from(["hall", "den"])), max_size=3),
    zones=st.lists(st.tuples(ANY, ANY, ANY, ANY), max_size=3),
    spot=st.one_of(st.none(), st.tuples(ANY, ANY)),
    passes=st.integers(-3, 5),
)
def test_a_goal_is_taken_or_refused_with_the_reason(
    mode: CleanMode,
    rooms: list[str],
    zones: list[tuple[float, float, float, float]],
    spot: tuple[float, float] | None,
    passes: int,
) -> None:
    began, mission, it, refusal = time.process_time(), fresh(), robot(), "none"
    try:
        request = CleanRequest(mode, tuple(rooms), tuple(zones), spot, passes)
        mission.clean(request, it.senses())
    except (CleanRefusedError, CommandRefusedError) as error:
        refusal = str(error)
    else:
        assert mission.tick(it.senses()).twist.is_finite
        json.dumps(mission.checkpoint(it.senses()), allow_nan=False)
    assert 0 < len(refusal) < 2000
    assert time.process_time() - began < SOON
