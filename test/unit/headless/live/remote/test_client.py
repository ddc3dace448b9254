"""A robot that cleans by its own brain, seen and told as a page does it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from fixtures.robots.neato_rig import NEATO
from fixtures.waiting import wait_until
from numpy.typing import NDArray

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.client.view import CleanOrder, LayerName
from roomba.configuration.robot import load_robot_config
from roomba.drivers.line import LineError
from roomba.headless.live.remote.client import RemoteClient
from roomba.headless.live.remote.view import BY_ITSELF
from roomba.robot.remote import RemoteState, RemoteWish
from roomba.vocabulary import Phase

DEADLINE = 20.0
"""s of wall time."""
CONFIG = load_robot_config(NEATO)
_CAME = {
    RemoteWish.CLEAN_HOUSE: Phase.CLEANING,
    RemoteWish.CLEAN_SPOT: Phase.CLEANING,
    RemoteWish.PAUSE: Phase.PAUSED,
    RemoteWish.RESUME: Phase.CLEANING,
    RemoteWish.STOP: Phase.IDLE,
    RemoteWish.DOCK: Phase.RETURNING,
}


class Told:
    """A robot that does at once what it is told, while it is reached."""

    def __init__(self) -> None:
        self.phase, self.wishes, self.is_reached = Phase.DOCKED, list[RemoteWish](), True
        self.is_taken, self.trouble = False, ""
        self.scans = 0

    def look(self) -> RemoteState:
        self._require_reached()
        has_power = self.phase is Phase.DOCKED
        return RemoteState(self.phase, 0.5, has_power, has_power, self.trouble, self.is_taken)

    def scan(self) -> NDArray[np.float32]:
        self.scans += 1
        return np.array([[1.0, 2.0]], np.float32)

    def tell(self, wish: RemoteWish) -> None:
        self._require_reached()
        self.wishes.append(wish)
        self.phase = _CAME.get(wish, self.phase)

    def _require_reached(self) -> None:
        if not self.is_reached:
            raise LineError("the radio is gone")


@pytest.fixture
def robot() -> Told:
    return Told()


@pytest.fixture
def client(robot: Told) -> Iterator[RemoteClient]:
    made = RemoteClient("openneato", robot, CONFIG)
    made.start()
    wait_until(lambda: phase(made) != "", DEADLINE, "it was looked at")
    yield made
    made.end()


def phase(client: RemoteClient) -> str:
    try:
        return client.robot().vacuum.phase
    except RobotUnavailableError:
        return ""


def wait_for(client: RemoteClient, expected: Phase) -> None:
    wait_until(lambda: phase(client) == expected.value, DEADLINE, lambda: phase(client))


def test_before_it_told_anything_there_is_nothing_to_show(robot: Told) -> None:
    client = RemoteClient("openneato", robot, CONFIG)
    with pytest.raises(RobotUnavailableError):
        client.robot()
    client.end()


def test_it_cleans_is_paused_goes_on_and_comes_home(client: RemoteClient, robot: Told) -> None:
    now = client.robot()
    assert (now.vacuum.state, now.vacuum.battery, now.charges) == ("docked", 0.5, True)
    assert now.doubt == BY_ITSELF
    client.clean(CleanOrder())
    wait_for(client, Phase.CLEANING)
    client.pause()
    wait_for(client, Phase.PAUSED)
    client.resume()
    wait_for(client, Phase.CLEANING)
    client.dock()
    wait_for(client, Phase.RETURNING)
    robot.phase = Phase.DOCKED
    wait_for(client, Phase.DOCKED)
    client.clean(CleanOrder(mode="spot"))
    client.stop()
    client.locate()
    assert robot.wishes[-3:] == [RemoteWish.CLEAN_SPOT, RemoteWish.STOP, RemoteWish.BEEP]


def test_its_scan_is_shown_while_it_moves(client: RemoteClient, robot: Told) -> None:
    client.clean(CleanOrder())
    wait_until(lambda: len(client.robot().scan) == 1, DEADLINE, "a scan")
    client.stop()
    wait_until(lambda: len(client.robot().scan) == 0, DEADLINE, "no scan")
    assert robot.scans > 0


@pytest.mark.parametrize(
    "ask",
    [
        lambda client: client.drive(0.1, 0.0),
        lambda client: client.explore(),
        lambda client: client.go_to(1.0, 1.0),
        lambda client: client.set_top_speed(0.2),
        lambda client: client.clean(CleanOrder(mode="rooms", rooms=("Kitchen",))),
        lambda client: client.clean(CleanOrder(mode="spot", spot=(1.0, 1.0))),
        lambda client: client.change_rooms(()),
        lambda client: client.remove_zone("a"),
        lambda client: client.empty_at_station(),
    ],
)
def test_what_it_cannot_is_refused(
    client: RemoteClient, robot: Told, ask: Callable[[RemoteClient], None]
) -> None:
    with pytest.raises(RequestRefusedError):
        ask(client)
    assert robot.wishes == []
    assert client.layer(LayerName.MAP) is None
    assert client.home().rooms == ()


def test_the_emergency_stop_tells_it_again_until_it_is_released(
    client: RemoteClient, robot: Told
) -> None:
    client.clean(CleanOrder())
    wait_for(client, Phase.CLEANING)
    client.emergency_stop("the cat")
    wait_until(lambda: robot.phase is Phase.IDLE, DEADLINE, "it stops")
    wait_for(client, Phase.EMERGENCY)
    assert client.robot().held == "the cat"
    robot.phase = Phase.CLEANING  # its own button was pressed
    wait_until(lambda: robot.phase is Phase.IDLE, DEADLINE, "it stops again")
    for ask in (client.dock, client.resume, lambda: client.clean(CleanOrder())):
        with pytest.raises(RequestRefusedError, match="release it first"):
            ask()
    client.release()
    client.clean(CleanOrder())
    wait_for(client, Phase.CLEANING)


def test_a_stop_that_is_not_heard_is_told_again(client: RemoteClient, robot: Told) -> None:
    client.clean(CleanOrder())
    wait_for(client, Phase.CLEANING)
    robot.is_reached = False
    client.emergency_stop("the cat")
    wait_until(lambda: "radio" in client.robot().vacuum.message, DEADLINE, "it is told")
    robot.is_reached = True
    wait_until(lambda: robot.phase is Phase.IDLE, DEADLINE, "it stops")


def test_a_stop_that_was_kept_holds_from_the_start(robot: Told, tmp_path: Path) -> None:
    robot.phase = Phase.CLEANING
    before = RemoteClient("openneato", robot, CONFIG)
    before.keep_stop(tmp_path)
    before.emergency_stop("the cat")
    before.end()
    robot.phase = Phase.CLEANING
    client = RemoteClient("openneato", robot, CONFIG)
    client.keep_stop(tmp_path)
    client.start()
    wait_until(lambda: robot.phase is Phase.IDLE, DEADLINE, "it stops")
    client.end()


def test_a_robot_that_is_not_reached_is_told_with_the_reason(
    client: RemoteClient, robot: Told
) -> None:
    robot.is_reached = False
    wait_for(client, Phase.ERROR)
    assert client.robot().vacuum.message == "the radio is gone"
    with pytest.raises(RequestRefusedError, match="the radio is gone"):
        client.dock()
    robot.is_reached = True
    wait_for(client, Phase.DOCKED)


def test_its_own_trouble_is_shown(client: RemoteClient, robot: Told) -> None:
    robot.trouble = "Main brush is stuck"
    wait_for(client, Phase.ERROR)
    assert client.robot().vacuum.message == "Main brush is stuck"


def test_while_another_program_drives_it_only_stop_is_told(
    client: RemoteClient, robot: Told
) -> None:
    robot.is_taken = True
    wait_until(lambda: "another program" in client.robot().vacuum.message, DEADLINE, "it is seen")
    with pytest.raises(RequestRefusedError, match="another program"):
        client.clean(CleanOrder())
    client.stop()
    assert robot.wishes == [RemoteWish.STOP]


def test_a_command_that_takes_too_long_is_given_up(
    robot: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roomba.headless.live.remote.client._DEADLINE", 0.05)
    is_over = threading.Event()
    monkeypatch.setattr(robot, "tell", lambda wish: is_over.wait(DEADLINE))
    client = RemoteClient("openneato", robot, CONFIG)
    with pytest.raises(RobotUnavailableError, match="go home within"):
        client.dock()
    is_over.set()
    client.end()
