"""A Neato that takes errands but no drive commands: what its bridge reports, and sends to it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from fixtures.bridges.openneato_mock import OpenNeatoMock, openneato_mock
from fixtures.robots.neato_rig import NEATO, neato_world

from roomba.configuration.robot import load_robot_config
from roomba.drivers.line import LineError
from roomba.drivers.neato.bridge_remote import BridgeRemote, hands_on_commands
from roomba.drivers.neato.bridge_requests import BridgeAddress
from roomba.emulators.neato.bridge import NeatoBridge
from roomba.emulators.neato.robot import NeatoRobot
from roomba.robot.remote import RemoteWish, WishRefusedError
from roomba.vocabulary import Phase

LIDAR = load_robot_config(NEATO).lidar


@pytest.fixture
def mock() -> Iterator[OpenNeatoMock]:
    with openneato_mock() as made:
        yield made


def remote_of(mock: OpenNeatoMock) -> BridgeRemote:
    return BridgeRemote(BridgeAddress.of(mock.address), LIDAR)


def phase(mock: OpenNeatoMock) -> Phase:
    return remote_of(mock).look().phase


@pytest.mark.parametrize("has_serial", [False, True])
def test_a_mock_hands_on_no_commands_of_any_age(has_serial: bool) -> None:
    with openneato_mock(has_serial=has_serial) as mock:
        assert not hands_on_commands(BridgeAddress.of(mock.address))


def test_a_bridge_with_a_robot_hands_them_on() -> None:
    with NeatoBridge(NeatoRobot(neato_world()), speed=5.0) as bridge:
        assert hands_on_commands(BridgeAddress.of(bridge.address))


@pytest.mark.parametrize(
    ("text", "hands_on"),
    [
        ("Component,Major,Minor,Build,Aux\r\nLDS Software,V2.6,15295,,", True),
        ("GetVersion\r\r\nComponent,Major,Minor,Build,Aux\r\n", True),
        ("GetVersion\r\n", True),
        ("", True),
        ("<!doctype html><title>another page</title>", False),
        ("GetVersion\r\nMock response\r\n", False),
    ],
)
def test_commands_are_handed_on_where_a_robot_answers(
    mock: OpenNeatoMock, text: str, hands_on: bool
) -> None:
    mock.text = text
    assert hands_on_commands(BridgeAddress.of(mock.address)) is hands_on


def test_a_bridge_that_is_busy_hands_them_on_later(mock: OpenNeatoMock) -> None:
    mock.is_busy = True
    assert hands_on_commands(BridgeAddress.of(mock.address))


def test_a_bridge_that_is_not_there_is_told_with_what_helps() -> None:
    with openneato_mock() as mock:
        place = BridgeAddress.of(mock.address)
    with pytest.raises(LineError, match="Is the robot switched on"):
        hands_on_commands(place)


def test_it_tells_its_charge_and_that_it_does_nothing(mock: OpenNeatoMock) -> None:
    told = remote_of(mock).look()
    assert (told.phase, told.level) == (Phase.IDLE, pytest.approx(0.85))
    assert (told.is_charging, told.is_taken, told.trouble) == (False, False, "")
    mock.is_docked = mock.is_charging = True
    told = remote_of(mock).look()
    assert (told.phase, told.is_charging) == (Phase.DOCKED, True)
    mock.is_charging = False
    assert not remote_of(mock).look().is_charging


def test_it_cleans_pauses_goes_on_and_goes_home(mock: OpenNeatoMock) -> None:
    remote = remote_of(mock)
    remote.tell(RemoteWish.CLEAN_HOUSE)
    assert phase(mock) is Phase.CLEANING
    remote.tell(RemoteWish.PAUSE)
    assert phase(mock) is Phase.PAUSED
    remote.tell(RemoteWish.RESUME)
    assert (phase(mock), mock.kind) == (Phase.CLEANING, "House")
    remote.tell(RemoteWish.DOCK)
    assert phase(mock) is Phase.RETURNING
    remote.tell(RemoteWish.STOP)
    assert phase(mock) is Phase.IDLE
    remote.tell(RemoteWish.BEEP)
    assert mock.asked[-1] == "/api/sound?id=3"


def test_a_spot_that_was_paused_goes_on_as_a_spot(mock: OpenNeatoMock) -> None:
    remote = remote_of(mock)
    remote.tell(RemoteWish.CLEAN_SPOT)
    remote.tell(RemoteWish.PAUSE)
    remote.tell(RemoteWish.RESUME)
    assert (phase(mock), mock.kind) == (Phase.CLEANING, "Spot")


def test_what_is_not_paused_does_not_begin_anew(mock: OpenNeatoMock) -> None:
    with pytest.raises(WishRefusedError, match="expected a clean that is paused"):
        remote_of(mock).tell(RemoteWish.RESUME)
    assert not mock.kind


def test_between_two_halves_of_a_clean_it_charges(mock: OpenNeatoMock) -> None:
    mock.is_suspended = mock.is_docked = True
    assert phase(mock) is Phase.CHARGING


def test_another_program_that_drives_it_is_seen(mock: OpenNeatoMock) -> None:
    mock.is_manual = True
    told = remote_of(mock).look()
    assert told.is_taken
    assert told.phase is Phase.IDLE


def test_an_error_is_its_trouble_and_a_reminder_is_not(mock: OpenNeatoMock) -> None:
    words = "Main brush is stuck"
    mock.error |= {"hasError": True, "kind": "error", "errorCode": 265, "displayMessage": words}
    assert remote_of(mock).look().trouble == words
    mock.error |= {"displayMessage": ""}
    assert remote_of(mock).look().trouble == "its error 265"
    mock.error |= {"kind": "warning", "displayMessage": "Time to replace the brush"}
    assert remote_of(mock).look().trouble == ""


def test_a_scan_is_where_beams_met_something(mock: OpenNeatoMock) -> None:
    points = remote_of(mock).scan()
    ahead = LIDAR.mount_ahead
    assert points.dtype == np.float32
    np.testing.assert_allclose(points, [[2.0 + ahead, 0.0], [ahead, 1.0]], atol=1e-6)
    mock.rotation = 0.0
    assert remote_of(mock).scan().shape == (0, 2)
    mock.rotation, mock.points = 4.0, []
    assert remote_of(mock).scan().shape == (0, 2)


def test_a_state_of_the_page_that_was_left_behind_is_no_clean(mock: OpenNeatoMock) -> None:
    start = {"uiState": "UIMGR_STATE_STARTHOUSECLEANING"}
    mock.other_state = start | {"robotState": "ST_C_Standby"}
    assert phase(mock) is Phase.IDLE
    mock.other_state = start | {"robotState": "ST_F1_Undocking"}
    assert phase(mock) is Phase.CLEANING


def test_a_bridge_that_refuses_is_told_with_its_reason(mock: OpenNeatoMock) -> None:
    mock.has_faults = True
    with pytest.raises(WishRefusedError, match="status 500: UART timeout"):
        remote_of(mock).tell(RemoteWish.CLEAN_HOUSE)


@pytest.mark.parametrize("fuel", [101, -1, None, "85", True, pytest.param(10**400, id="huge")])
def test_a_charge_that_is_none_is_refused(mock: OpenNeatoMock, fuel: object) -> None:
    mock.fuel = fuel
    with pytest.raises(LineError, match="expected a"):
        remote_of(mock).look()


def test_a_wish_to_a_bridge_that_is_gone_is_not_refused_but_not_reached() -> None:
    with openneato_mock() as mock:
        remote = remote_of(mock)
    with pytest.raises(LineError, match="Is the robot switched on"):
        remote.tell(RemoteWish.STOP)


@pytest.mark.parametrize("points", [None, "many"])
def test_a_scan_without_points_is_refused(mock: OpenNeatoMock, points: object) -> None:
    mock.points = points
    with pytest.raises(LineError, match="expected points"):
        remote_of(mock).scan()
