"""A robot that cleans by its own brain, seen and commanded as a page does it."""

from __future__ import annotations

import contextlib
import datetime as dt
import json
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from fixtures.robots.heard_remote import Heard
from fixtures.robots.neato_rig import NEATO
from fixtures.waiting import wait_until
from numpy.typing import NDArray

from roomba.clean_request import CleanRequest
from roomba.client.plain import state_of
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.client.view import LayerName
from roomba.configuration.household import HouseholdConfig
from roomba.configuration.robot import load_robot_config
from roomba.drivers.line import LineError
from roomba.headless.live.remote.client import RemoteClient
from roomba.headless.live.remote.view import BY_ITSELF
from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper
from roomba.history.report.words import figure_rows
from roomba.history.run import RunSource
from roomba.household.household import LiveHousehold
from roomba.plans.plan import Plan
from roomba.robot.remote import RemoteWish, WishRefusedError
from roomba.ui.web.streams.told import Told
from roomba.vocabulary import CleanMode, Phase

DEADLINE = 20.0
"""s of wall time."""
CONFIG = load_robot_config(NEATO)


@pytest.fixture
def robot() -> Heard:
    return Heard()


@pytest.fixture
def client(robot: Heard) -> Iterator[RemoteClient]:
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


def test_before_it_told_anything_there_is_nothing_to_show(robot: Heard) -> None:
    client = RemoteClient("openneato", robot, CONFIG)
    with pytest.raises(RobotUnavailableError):
        client.robot()
    client.end()


def test_it_cleans_is_paused_goes_on_and_comes_home(client: RemoteClient, robot: Heard) -> None:
    now = client.robot()
    assert (now.vacuum.state, now.vacuum.battery, now.charges) == ("docked", 0.5, True)
    assert now.doubt == BY_ITSELF
    client.clean(CleanRequest())
    wait_for(client, Phase.CLEANING)
    client.pause()
    wait_for(client, Phase.PAUSED)
    client.resume()
    wait_for(client, Phase.CLEANING)
    client.dock()
    wait_for(client, Phase.RETURNING)
    robot.phase = Phase.DOCKED
    wait_for(client, Phase.DOCKED)
    client.clean(CleanRequest(mode=CleanMode.SPOT))
    client.stop()
    client.locate()
    assert robot.wishes[-3:] == [RemoteWish.CLEAN_SPOT, RemoteWish.STOP, RemoteWish.BEEP]


def test_a_plan_is_cleaned_once_and_its_run_is_kept(
    client: RemoteClient, robot: Heard, tmp_path: Path
) -> None:
    now = [dt.datetime(2026, 3, 2, 8, 0, tzinfo=dt.timezone.utc)]
    fail = lambda text: pytest.fail(text)  # noqa: E731
    keeper = HistoryKeeper(History(tmp_path), RunSource("play", "openneato"), fail)
    household = LiveHousehold(
        client, tmp_path, HouseholdConfig(), client.bin_capacity, fail, now=lambda: now[0]
    )

    def look(minutes: int) -> None:
        for _ in range(minutes):
            now[0] += dt.timedelta(minutes=1)
            household.look()
            keeper.look(client.robot(), client.home(), client.layer)

    household.put_plan(Plan(name="daily", at=(dt.time(9),)))
    look(61)
    wait_for(client, Phase.CLEANING)
    look(40)
    robot.phase = Phase.DOCKED
    wait_for(client, Phase.DOCKED)
    look(120)
    assert robot.wishes == [RemoteWish.CLEAN_HOUSE]
    assert [note.text for note in household.plans().notes] == ["began", "done"]
    (run,) = keeper.history.runs()
    assert (run.figures.outcome, run.figures.kind) == ("completed", "clean")
    assert figure_rows(run.figures)


def test_its_scan_is_shown_while_it_moves(client: RemoteClient, robot: Heard) -> None:
    client.clean(CleanRequest())
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
        lambda client: client.clean(CleanRequest(mode=CleanMode.ROOMS, rooms=("Kitchen",))),
        lambda client: client.clean(CleanRequest(mode=CleanMode.SPOT, spot=(1.0, 1.0))),
        lambda client: client.change_rooms(()),
        lambda client: client.remove_zone("a"),
        lambda client: client.empty_at_station(),
    ],
)
def test_what_it_cannot_is_refused(
    client: RemoteClient, robot: Heard, ask: Callable[[RemoteClient], None]
) -> None:
    with pytest.raises(RequestRefusedError):
        ask(client)
    assert robot.wishes == []
    assert client.layer(LayerName.MAP) is None
    assert client.home().rooms == ()


def test_the_emergency_stop_tells_it_again_until_it_is_released(
    client: RemoteClient, robot: Heard
) -> None:
    client.clean(CleanRequest())
    wait_for(client, Phase.CLEANING)
    client.emergency_stop("the cat")
    wait_until(lambda: robot.phase is Phase.IDLE, DEADLINE, "it stops")
    wait_for(client, Phase.EMERGENCY)
    assert client.robot().held == "the cat"
    robot.phase = Phase.CLEANING  # its own button was pressed
    wait_until(lambda: robot.phase is Phase.IDLE, DEADLINE, "it stops again")
    for ask in (client.dock, client.resume, lambda: client.clean(CleanRequest())):
        with pytest.raises(RequestRefusedError, match="release it first"):
            ask()
    client.release()
    client.clean(CleanRequest())
    wait_for(client, Phase.CLEANING)


def test_a_stop_that_is_not_heard_is_told_again(client: RemoteClient, robot: Heard) -> None:
    client.clean(CleanRequest())
    wait_for(client, Phase.CLEANING)
    robot.is_reached = False
    client.emergency_stop("the cat")
    wait_until(lambda: "radio" in client.robot().vacuum.message, DEADLINE, "it is told")
    robot.is_reached = True
    wait_until(lambda: robot.phase is Phase.IDLE, DEADLINE, "it stops")


def test_a_stop_that_was_kept_holds_from_the_start(robot: Heard, tmp_path: Path) -> None:
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
    client: RemoteClient, robot: Heard
) -> None:
    robot.is_reached = False
    wait_for(client, Phase.ERROR)
    assert client.robot().vacuum.message == "the radio is gone"
    with pytest.raises(RobotUnavailableError, match="the radio is gone"):
        client.dock()
    robot.is_reached = True
    wait_for(client, Phase.DOCKED)


def test_its_own_trouble_is_shown(client: RemoteClient, robot: Heard) -> None:
    robot.trouble = "Main brush is stuck"
    wait_for(client, Phase.ERROR)
    assert client.robot().vacuum.message == "Main brush is stuck"


def test_while_another_program_drives_it_only_stop_and_beep_are_told(
    client: RemoteClient, robot: Heard
) -> None:
    robot.is_taken = True
    wait_until(lambda: "another program" in client.robot().vacuum.message, DEADLINE, "it is seen")
    with pytest.raises(RequestRefusedError, match="another program"):
        client.clean(CleanRequest())
    client.stop()
    client.locate()
    assert robot.wishes == [RemoteWish.STOP, RemoteWish.BEEP]


class Slow(Heard):
    """A robot that hears each wish only when it may, and can refuse."""

    def __init__(self) -> None:
        super().__init__()
        self.may_hear, self.is_told = threading.Event(), threading.Event()
        self.refuses: RemoteWish | None = None
        self.began: list[RemoteWish] = []

    def tell(self, wish: RemoteWish) -> None:
        self.began.append(wish)
        self.is_told.set()
        assert self.may_hear.wait(DEADLINE)
        if wish is self.refuses:
            raise WishRefusedError("status 500")
        super().tell(wish)


@pytest.fixture
def slow() -> Iterator[Slow]:
    robot = Slow()
    yield robot
    robot.may_hear.set()


@contextlib.contextmanager
def in_thread(call: Callable[[], None]) -> Iterator[list[Exception]]:
    """Call in another thread until the end of the block; what it raised is there then."""
    raised: list[Exception] = []

    def run() -> None:
        try:
            call()
        except Exception as error:
            raised.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    yield raised
    thread.join(DEADLINE)
    assert not thread.is_alive()


def test_its_state_is_told_as_json(client: RemoteClient) -> None:
    told = json.loads(Told(state_of(client.robot())).text)
    assert told["dirt"] is None
    assert told["vacuum"]["phase"] == "docked"


def test_a_wish_that_waited_too_long_is_never_told(
    slow: Slow, monkeypatch: pytest.MonkeyPatch
) -> None:
    client = RemoteClient("openneato", slow, CONFIG)
    monkeypatch.setattr("roomba.headless.live.remote.teller._DEADLINE", 0.05)
    with in_thread(client.pause):
        assert slow.is_told.wait(DEADLINE)
        with pytest.raises(RobotUnavailableError, match=r"go home within .* left undone"):
            client.dock()
        slow.may_hear.set()
    client.end()
    assert slow.began == [RemoteWish.PAUSE]


def test_a_clean_that_waits_while_the_emergency_stop_comes_is_refused(slow: Slow) -> None:
    client = RemoteClient("openneato", slow, CONFIG)
    cleaning = lambda: client.clean(CleanRequest())  # noqa: E731
    with in_thread(client.pause), in_thread(cleaning) as raised:
        assert slow.is_told.wait(DEADLINE)
        wait_until(lambda: len(client._teller._waiting) == 2, DEADLINE, "it waits")
        client.emergency_stop("the cat")
        slow.may_hear.set()
    client.end()
    assert slow.wishes == [RemoteWish.PAUSE, RemoteWish.STOP]
    assert "release it first" in str(raised[0])


def test_where_a_stop_is_refused_it_is_looked_at_all_the_same(slow: Slow) -> None:
    slow.may_hear.set()
    slow.refuses, slow.phase = RemoteWish.STOP, Phase.CLEANING
    client = RemoteClient("openneato", slow, CONFIG)
    client.emergency_stop("the cat")
    client.start()
    wait_until(lambda: phase(client) == "emergency stop", DEADLINE, "it is looked at")
    wait_until(lambda: "status 500" in client.robot().held, DEADLINE, "it is told")
    assert client.robot().doubt == BY_ITSELF
    with pytest.raises(RequestRefusedError, match="status 500"):
        client.stop()
    slow.refuses = None
    wait_until(lambda: client.robot().held == "the cat", DEADLINE, "it stops")
    client.end()


def test_a_scan_that_fails_is_no_error_of_the_robot(
    client: RemoteClient, robot: Heard, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail() -> NDArray[np.float32]:
        raise LineError("no points")

    monkeypatch.setattr(robot, "scan", fail)
    client.clean(CleanRequest())
    wait_until(lambda: "no points" in client.robot().doubt, DEADLINE, "it is told")
    assert phase(client) == "cleaning"
    client.stop()
    wait_until(lambda: client.robot().doubt == BY_ITSELF, DEADLINE, "it stands")


def test_an_emergency_stop_goes_out_before_the_end(slow: Slow) -> None:
    client = RemoteClient("openneato", slow, CONFIG)
    with in_thread(client.pause), in_thread(client.dock) as raised:
        assert slow.is_told.wait(DEADLINE)
        wait_until(lambda: len(client._teller._waiting) == 2, DEADLINE, "it waits")
        client.emergency_stop("the cat")
        with in_thread(client.end):
            wait_until(lambda: client._teller._is_over, DEADLINE, "it ends")
            slow.may_hear.set()
    assert slow.wishes == [RemoteWish.PAUSE, RemoteWish.STOP]
    assert isinstance(raised[0], RobotUnavailableError)
    for ask in (client.dock, client.stop, lambda: client.emergency_stop("again")):
        with pytest.raises(RobotUnavailableError, match="not told anything any more"):
            ask()


def test_a_stop_that_comes_while_one_is_told_is_told_too(
    slow: Slow, monkeypatch: pytest.MonkeyPatch
) -> None:
    client = RemoteClient("openneato", slow, CONFIG)
    client.hold("the cat")
    assert slow.is_told.wait(DEADLINE)
    assert not client._has_to_stop
    # One that is lost would leave it to the next look alone.
    monkeypatch.setattr(client._teller, "put", lambda wish, tell: None)
    client.hold("the dog")
    slow.may_hear.set()
    wait_until(lambda: slow.wishes == [RemoteWish.STOP], DEADLINE, "it is told")
    wait_until(lambda: not client._teller._waiting, DEADLINE, "it was told")
    assert client._has_to_stop
    client.end()


def test_a_stop_that_failed_is_due_again_until_it_is_released(slow: Slow) -> None:
    slow.may_hear.set()
    slow.refuses = RemoteWish.STOP
    client = RemoteClient("openneato", slow, CONFIG)
    client.hold("the cat")
    wait_until(lambda: not client._teller._waiting, DEADLINE, "it was told")
    assert client._has_to_stop
    client.let_go()
    assert not client._has_to_stop
    client.end()
