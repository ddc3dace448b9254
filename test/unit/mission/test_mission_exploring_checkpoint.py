"""An exploration that goes on after it was ended at any moment."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from fixtures.missions.exploring import AWAY, DOCKED, HALL, LOW, Rig, exploring
from fixtures.missions.told_mission import TICK

from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.mission.cleaning.checkpoint import CheckpointError, Values
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.machine import Errand, Event
from roomba.vocabulary import Phase


def taken_up(values: Values, senses: Senses, known: OccupancyMap = HALL) -> Rig:
    rig = Rig(senses, known)
    rig.mission.restore(json.loads(json.dumps(values)), senses)
    return rig


def test_it_is_taken_up_from_a_checkpoint() -> None:
    rig = exploring()
    assert rig.mission.exploration is not None
    rig.mission.exploration.give_up((1.5, 0.5))
    rig.tick(100, pose=Pose(1.3, 1.2, 0.0))
    values = rig.mission.checkpoint(rig.senses)
    assert values is not None
    again = taken_up(values, replace(AWAY, now=1e4))
    assert again.mission.state.errand is Errand.EXPLORE
    assert again.phase is Phase.UNDOCKING
    assert again.mission.exploration is not None
    assert again.mission.exploration.unseen == [(1.5, 0.5)]
    again.tick(3)
    assert again.phase is Phase.EXPLORING
    again.command(Event.STOP)
    result = again.result
    assert result.distance == pytest.approx(0.1)
    assert result.duration == pytest.approx(108 * TICK, abs=3 * TICK)
    # Nothing there is unknown on this map.
    assert result.unseen == ()


def test_taken_up_on_its_station_it_comes_out_or_charges() -> None:
    rig = exploring()
    values = rig.mission.checkpoint(rig.senses)
    assert values is not None
    assert taken_up(values, DOCKED).phase is Phase.UNDOCKING
    rig.tick(round(6.0 / TICK), battery=LOW)
    values = rig.mission.checkpoint(rig.senses)
    assert values is not None
    assert taken_up(values, DOCKED).phase is Phase.CHARGING
    rig = exploring()
    rig.command(Event.PAUSE)
    values = rig.mission.checkpoint(rig.senses)
    assert values is not None
    paused = taken_up(values, DOCKED)
    assert paused.phase is Phase.PAUSED
    paused.command(Event.RESUME)
    assert paused.phase is Phase.CHARGING


@pytest.mark.parametrize("junk", [None, [[1.0]], "far", [["x", "y"]]])
def test_a_checkpoint_of_junk_is_refused(junk: object) -> None:
    values = exploring().mission.checkpoint(AWAY)
    assert values is not None
    expected = "expected the exploration" if junk is None else "expected a checkpoint"
    with pytest.raises(CheckpointError, match=expected):
        taken_up({**values, "exploration": junk}, AWAY)
    del values["exploration"]
    with pytest.raises(CheckpointError, match="exploration"):
        taken_up(values, AWAY)
