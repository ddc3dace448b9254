"""Scans in turns of the robot show how a lidar sweeps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.drives.made_logs import PERIOD, at, changed
from fixtures.drives.turning_drive import BEAM_TIME, half_circle, readings_of, turning_drive

from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.commands.map.drive.shown.shown_sweep import shown_sweep
from roomba.recordings.drives.sweeps import Sweep


def shown(told: float, *, beam_time: float = 0.0, is_backwards: bool = False) -> Sweep | None:
    items = turning_drive(beam_time=beam_time, is_backwards=is_backwards)
    return shown_sweep(LidarSamples(readings_of(items, half_circle(told))))


@pytest.mark.parametrize("is_backwards", [False, True])
def test_a_sweep_that_is_not_told_is_seen(is_backwards: bool) -> None:
    found = shown(0.0, beam_time=BEAM_TIME, is_backwards=is_backwards)
    assert found is not None
    assert (found.is_backwards, found.turn) == (is_backwards, pytest.approx(PERIOD))


def test_beams_that_a_driver_turned_round_are_seen() -> None:
    """As rplidar_ros does: Slamtec/rplidar_ros, issue 55."""
    assert shown(BEAM_TIME, beam_time=BEAM_TIME, is_backwards=True) == Sweep(is_backwards=True)


def test_a_time_between_beams_that_is_far_too_short_is_seen() -> None:
    """As an LDS driver tells it: ROBOTIS-GIT/turtlebot3, issue 634."""
    found = shown(0.05 * BEAM_TIME, beam_time=BEAM_TIME)
    assert found is not None
    assert (found.is_backwards, found.turn) == (False, pytest.approx(PERIOD))


def test_a_sweep_that_there_is_not_is_seen() -> None:
    assert shown(BEAM_TIME) == Sweep(turn=0.0)


@pytest.mark.parametrize(("told", "beam_time"), [(0.0, 0.0), (BEAM_TIME, BEAM_TIME)])
def test_one_that_is_told_right_is_left(told: float, beam_time: float) -> None:
    assert shown(told, beam_time=beam_time) is None


def test_one_that_is_told_right_is_left_though_scans_are_late() -> None:
    items = turning_drive(beam_time=BEAM_TIME)
    late = changed(items, "/scan", lambda _, item: at(item, item.stamp + 0.15))
    late.sort(key=lambda item: item.stamp)
    assert shown_sweep(LidarSamples(readings_of(late, half_circle(BEAM_TIME)))) is None


def test_too_few_scans_of_turns_tell_nothing() -> None:
    items = turning_drive(beam_time=BEAM_TIME, is_backwards=True)
    few = [item for item in items if item.stamp < items[0].stamp + 1.5]
    assert shown_sweep(LidarSamples(readings_of(few, half_circle(BEAM_TIME)))) is None


def test_scans_in_which_nothing_is_seen_tell_nothing() -> None:
    items = [
        replace(item, value=np.full(180, np.inf)) if isinstance(item.value, np.ndarray) else item
        for item in turning_drive()
    ]
    assert shown_sweep(LidarSamples(readings_of(items, half_circle(BEAM_TIME)))) is None
