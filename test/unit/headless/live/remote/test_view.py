"""What a page shows of a robot that cleans by its own brain."""

from __future__ import annotations

import math

import pytest
from fixtures.robots.neato_rig import NEATO

from roomba.configuration.robot import load_robot_config
from roomba.headless.live.remote.view import BY_ITSELF, TAKEN, Failures, remote_home, remote_view
from roomba.robot.remote import RemoteState
from roomba.vocabulary import Phase


@pytest.mark.parametrize(
    ("phase", "state"),
    [
        (Phase.DOCKED, "docked"),
        (Phase.CLEANING, "cleaning"),
        (Phase.RETURNING, "returning"),
        (Phase.PAUSED, "paused"),
        (Phase.CHARGING, "docked"),
        (Phase.IDLE, "idle"),
    ],
)
def test_its_phase_is_told_in_the_words_of_pages(phase: Phase, state: str) -> None:
    seen = remote_view(3.0, RemoteState(phase, 0.4, is_charging=False))
    assert (seen.time, seen.vacuum.phase, seen.vacuum.state) == (3.0, phase.value, state)
    assert (seen.vacuum.message, seen.doubt, seen.vacuum.battery) == ("", BY_ITSELF, 0.4)
    assert not seen.charges
    assert math.isnan(seen.dirt)


def test_what_is_wrong_comes_before_what_it_does() -> None:
    state = RemoteState(Phase.CLEANING, 0.4, is_charging=False, is_taken=True)
    assert remote_view(0.0, state).vacuum.message == TAKEN
    gone = Failures(lost="the radio is gone")
    lost = remote_view(0.0, state, failures=gone)
    assert (lost.vacuum.phase, lost.vacuum.message, lost.doubt) == (
        "error", "the radio is gone", "the radio is gone",
    )  # fmt: skip
    held = remote_view(0.0, state, held="the cat", failures=gone)
    assert (held.vacuum.phase, held.held) == ("emergency stop", "the cat")


def test_its_battery_fills_where_current_comes_into_it_and_not_by_its_place_alone() -> None:
    seen = [
        remote_view(0.0, RemoteState(Phase.DOCKED, 0.4, is_charging=charges)).charges
        for charges in (True, False)
    ]
    assert seen == [True, False]


def test_a_stop_that_was_not_obeyed_is_told_where_it_is_held() -> None:
    state = RemoteState(Phase.CLEANING, 0.4, is_charging=False)
    failures = Failures(stop="status 500")
    held = remote_view(0.0, state, held="the cat", failures=failures)
    assert held.held == "the cat; but it did not obey the stop: status 500"
    assert held.vacuum.message == "it did not obey the stop: status 500"
    assert remote_view(0.0, state, failures=failures).held == ""


def test_a_scan_that_failed_is_told_beside_what_it_does() -> None:
    state = RemoteState(Phase.CLEANING, 0.4, is_charging=False)
    seen = remote_view(0.0, state, failures=Failures(scan="no points"))
    assert (seen.vacuum.phase, seen.vacuum.message) == ("cleaning", "")
    assert seen.doubt == "its scan is not shown: no points"


def test_it_has_no_rooms_and_its_bodys_size() -> None:
    config = load_robot_config(NEATO)
    home = remote_home("openneato", config)
    assert (home.rooms, home.zones, home.radius) == ((), (), config.body.radius)
