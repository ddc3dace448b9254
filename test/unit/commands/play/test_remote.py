"""``./roomba play`` with a bridge that passes no drive commands: the robot gets errands."""

from __future__ import annotations

import argparse

import pytest
from fixtures.bridges.openneato_mock import openneato_mock
from fixtures.robots.neato_rig import neato_world
from fixtures.waiting import wait_until

from roomba.clean_request import CleanRequest
from roomba.client.protocol import RobotUnavailableError
from roomba.commands.play.remote import NOT_DRIVEN, remote_client
from roomba.drivers.line import LineError
from roomba.emulators.neato.bridge import NeatoBridge
from roomba.emulators.neato.robot import NeatoRobot
from roomba.headless.live.remote.client import RemoteClient

DEADLINE = 20.0
"""s of wall time."""


def wanted(line: str, robot: str = "openneato") -> argparse.Namespace:
    return argparse.Namespace(robot=robot, line=line)


def phase(client: RemoteClient) -> str:
    try:
        return client.robot().vacuum.phase
    except RobotUnavailableError:
        return ""


def test_a_robot_behind_the_mock_of_openneato_cleans_and_goes_home() -> None:
    told: list[str] = []
    with openneato_mock(has_serial=True) as mock:
        client = remote_client(wanted(mock.address), told.append)
        assert client is not None
        assert told == [NOT_DRIVEN]
        client.start()
        wait_until(lambda: phase(client) == "idle", DEADLINE, lambda: phase(client))
        client.clean(CleanRequest())
        wait_until(lambda: phase(client) == "cleaning", DEADLINE, lambda: phase(client))
        assert client.robot().vacuum.battery == pytest.approx(0.85)
        wait_until(lambda: len(client.robot().scan) == 2, DEADLINE, "its scan")
        client.dock()
        wait_until(lambda: phase(client) == "returning", DEADLINE, lambda: phase(client))
        client.end()


def test_a_robot_that_can_be_driven_is_not_only_told() -> None:
    told: list[str] = []
    with NeatoBridge(NeatoRobot(neato_world()), speed=5.0) as bridge:
        assert remote_client(wanted(bridge.address), told.append) is None
    assert remote_client(wanted("/dev/none", "neato"), told.append) is None
    assert told == []


def test_another_program_there_is_told_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    with openneato_mock() as mock:
        monkeypatch.setattr(mock, "told", lambda path: None)
        with pytest.raises(LineError, match="has no /api/state"):
            remote_client(wanted(mock.address), told.append)
    assert told == []


def test_where_no_bridge_is_that_is_told() -> None:
    with openneato_mock() as mock:
        address = mock.address
    with pytest.raises(LineError, match="Is the robot switched on"):
        remote_client(wanted(address), print)
