"""For each phase, whether a run is under way."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fixtures.households.written_robot import VIEW

from roomba.client.protocol import VacuumSnapshot
from roomba.client.under_way import goes_on, is_done, is_running
from roomba.mission.phases.machine import VACUUM_STATES
from roomba.vocabulary import Phase

UNKNOWN = (Phase.EMPTYING, Phase.BIN_FULL, Phase.ERROR, Phase.EMERGENCY)
AT_REST = (Phase.IDLE, Phase.DOCKED)


def told(phase: Phase, to_go: float = 60.0) -> VacuumSnapshot:
    return replace(VIEW.vacuum, state=VACUUM_STATES[phase], phase=phase.value, seconds_to_go=to_go)


@pytest.mark.parametrize("phase", Phase)
def test_a_run_lasts_through_its_charge_and_what_tells_nothing_changes_nothing(
    phase: Phase,
) -> None:
    for before in (None, False, True):
        expected = before if phase in UNKNOWN else phase not in AT_REST
        assert is_running(told(phase), before=before) is expected


@pytest.mark.parametrize("phase", Phase)
def test_it_goes_on_by_itself_unless_it_rests_waits_or_is_done(phase: Phase) -> None:
    waits = (*AT_REST, Phase.PAUSED, Phase.ERROR, Phase.EMERGENCY)
    assert goes_on(told(phase)) is (phase not in waits)
    ends = (*waits, Phase.RETURNING, Phase.DOCKING, Phase.EMPTYING)
    assert goes_on(told(phase, to_go=0.0)) is (phase not in ends)


@pytest.mark.parametrize("phase", Phase)
def test_it_is_done_when_nothing_is_left_but_the_way_home(phase: Phase) -> None:
    assert not is_done(told(phase))
    assert is_done(told(phase, to_go=0.0)) is (phase in (Phase.RETURNING, Phase.DOCKING))
