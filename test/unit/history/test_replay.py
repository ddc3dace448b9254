"""A recording as a robot."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.waiting import wait_until

from roomba.clean_request import CleanRequest
from roomba.client.observed import ObservedRobot, Timeline
from roomba.client.protocol import ErrandOutcome, RequestRefusedError
from roomba.client.view import GridLayer, LayerName
from roomba.history.replay import RecordedRobot
from roomba.history.run import TRACE, RunFigures, RunRecording
from roomba.history.run_file import RunFileError
from roomba.history.unfinished import INTERRUPTED, WHY
from roomba.vocabulary import EdgeReason, Hindrance


@pytest.fixture
def robot(figures: RunFigures, recording: RunRecording) -> RecordedRobot:
    return RecordedRobot(figures, recording, speed=50.0)


def coverage(robot: RecordedRobot) -> GridLayer:
    layer = robot.layer(LayerName.COVERAGE)
    assert layer is not None
    return layer


def test_it_is_where_it_was_at_the_time(robot: RecordedRobot) -> None:
    robot.seek(20.25)
    seen = robot.robot()
    assert seen.time == 20.25
    assert seen.pose == pytest.approx((0.5 + 20.25 / 20.0, 1.5, 0.0), abs=1e-5)
    assert seen.vacuum.phase == "cleaning"
    assert seen.vacuum.room == "hall"
    assert seen.vacuum.battery == pytest.approx(1.0 - 20.0 / 120.0, abs=1e-5)
    assert seen.last is None
    assert len(robot.way()) == 41
    robot.seek(0.0)
    assert robot.robot().vacuum.phase == "docked"
    robot.seek(1e9)
    assert robot.timeline().at == 60.0
    last = robot.robot().last
    assert last is not None
    assert last.outcome.value == "completed"
    assert last.missed[0].room == "hall"
    assert last.open_edges[0].reason is EdgeReason.NO_ECHO


@pytest.mark.parametrize(
    ("word", "hindrance"),
    [("no way", Hindrance.NO_WAY), ("", Hindrance.NONE), ("of a newer program", Hindrance.NONE)],
)
def test_what_hindered_it_is_shown_as_far_as_it_is_known(
    figures: RunFigures, recording: RunRecording, word: str, hindrance: Hindrance
) -> None:
    words = tuple(replace(said, hindrance=word) for said in recording.words)
    robot = RecordedRobot(figures, replace(recording, words=words))
    assert robot.robot().vacuum.hindrance is hindrance


def test_a_run_that_was_interrupted_is_shown_to_its_end(
    figures: RunFigures, recording: RunRecording
) -> None:
    robot = RecordedRobot(replace(figures, outcome=INTERRUPTED, message=WHY), recording)
    robot.seek(1e9)
    last = robot.robot().last
    assert last is not None
    assert (last.outcome, last.message) == (ErrandOutcome.INTERRUPTED, WHY)


def test_coverage_grows_and_shrinks_with_the_time(robot: RecordedRobot) -> None:
    counts = []
    for at in (5.0, 30.0, 60.0, 30.0, 0.0):
        robot.seek(at)
        counts.append(np.count_nonzero(coverage(robot).cells))
    assert counts[0] == counts[4] == 0
    assert counts[1] == counts[3]
    # 0.5 s rows from 10 s to 50 s at 0.05 m/s, a tool of 0.18 m, cells of 0.05 m
    assert counts[2] * 0.05**2 == pytest.approx(2.0 * 0.18, rel=0.25)
    assert 0.4 * counts[2] < counts[1] < 0.6 * counts[2]


def test_time_passes_while_it_plays(robot: RecordedRobot) -> None:
    assert robot.timeline().at == 0.0
    robot.play(is_playing=True)
    wait_until(lambda: not robot.timeline().is_playing, 30.0, "the end of the recording")
    assert robot.timeline().at == 60.0
    jumps = robot.timeline().jumps
    robot.play(is_playing=True)
    assert robot.timeline().at < 60.0
    assert robot.timeline().jumps == jumps + 1
    robot.play(is_playing=False)
    stood = robot.timeline().at
    assert robot.timeline().at == stood


def test_commands_are_refused_with_the_reason(robot: RecordedRobot) -> None:
    observed: ObservedRobot = robot
    assert isinstance(observed, Timeline)
    with pytest.raises(RequestRefusedError, match="recorded run of 'box'"):
        observed.clean(CleanRequest())
    with pytest.raises(RequestRefusedError, match="nothing is driven"):
        observed.drive(0.1, 0.0)
    with pytest.raises(RequestRefusedError):
        observed.emergency_stop("a test")


def test_home_and_map_are_those_of_the_run(robot: RecordedRobot) -> None:
    home = robot.home()
    assert home.rooms[0].name == "hall"
    assert home.rooms[0].rings[0][1] == (4, 0)
    layer = robot.layer(LayerName.MAP)
    assert layer is not None
    assert layer.cells.shape == (60, 80)
    assert robot.layer(LayerName.DIRT) is None


def test_a_robot_that_was_carried_does_not_glide(
    figures: RunFigures, recording: RunRecording
) -> None:
    recording.trace[60:, TRACE.index("y")] = 3.0
    recording.trace[:, TRACE.index("battery")] = -1.0
    robot = RecordedRobot(figures, recording)
    robot.seek(29.9)
    assert robot.robot().pose[1] == 1.5
    assert math.isnan(robot.robot().vacuum.battery)


def test_nothing_cannot_be_played(figures: RunFigures, recording: RunRecording) -> None:
    empty = RunRecording(recording.trace[:0], recording.words, recording.home, recording.layers)
    with pytest.raises(RunFileError, match="at least one row"):
        RecordedRobot(figures, empty)
