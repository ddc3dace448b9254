"""A live robot as the menu and programs see it, in a tiny home, much faster than real time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol, TypeVar

import pytest
from fixtures.homes.tiny_home import DOORWAY, STATION, tiny_home
from fixtures.waiting import wait_until

from roomba.client.protocol import (
    ErrandOutcome,
    RequestRefusedError,
    RobotClient,
    RobotUnavailableError,
    WalkHandle,
    WalkOutcome,
    WalkReport,
)
from roomba.commands.play.living import live_client
from roomba.headless.live.client import LiveClient
from roomba.headless.live.robot_client import LiveRobotClient
from roomba.vocabulary import CleanMode, Hindrance

DEADLINE = 20.0
"""s of wall time."""
NEAR, FAR = (1.1, 0.4), (2.1, 0.5)
"""m; places in both rooms of the tiny home."""

_Report = TypeVar("_Report", covariant=True)


class Ending(Protocol[_Report]):
    def next_feedback(self, timeout: float) -> object: ...

    def report(self) -> _Report | None: ...


@pytest.fixture
def live(tmp_path: Path) -> Iterator[LiveClient]:
    live = live_client(str(tiny_home(tmp_path)), seed=1, speed=100.0, knows_map=True)
    live.start()
    yield live
    live.end()


@pytest.fixture
def unhurried(tmp_path: Path) -> Iterator[RobotClient]:
    """A robot whose walks take so long that they are told on the way."""
    live = live_client(str(tiny_home(tmp_path)), seed=1, speed=10.0, knows_map=True)
    live.start()
    yield LiveRobotClient(live)
    live.end()


@pytest.fixture
def robot(live: LiveClient) -> RobotClient:
    return LiveRobotClient(live)


def end_of(errand: Ending[_Report]) -> _Report:
    """Wait for the end of an errand as a program does."""

    def end() -> _Report | None:
        errand.next_feedback(0.25)
        return errand.report()

    return wait_until(end, DEADLINE, "the end of the errand")


def phase(robot: RobotClient) -> str:
    return robot.vacuum().phase


def become(robot: RobotClient, wanted: str) -> None:
    wait_until(lambda: phase(robot) == wanted, DEADLINE, wanted)


def walk_and_tell(walk: WalkHandle) -> tuple[list[float], WalkReport]:
    told: list[float] = []

    def end() -> WalkReport | None:
        left = walk.next_feedback(0.25)
        if left is not None:
            told.append(left)
        return walk.report()

    return told, wait_until(end, DEADLINE, "the end of the walk")


def test_a_walk_tells_its_way_and_arrives(unhurried: RobotClient) -> None:
    robot = unhurried
    length = robot.path_length(*FAR)
    told, report = walk_and_tell(robot.walk_to(*FAR))
    assert (report.outcome, report.message) == (WalkOutcome.ARRIVED, "")
    assert told[0] == pytest.approx(length, abs=0.05)
    assert told == sorted(told, reverse=True)
    assert report.distance == pytest.approx(length, abs=0.1)
    assert report.duration >= length / robot.limits().max_speed
    state = robot.state()
    assert math.dist((state.x, state.y), FAR) < 0.06
    assert state.doubt == ""


def test_a_walk_home_ends_on_the_station(robot: RobotClient) -> None:
    assert robot.station() == pytest.approx(STATION, abs=0.01)
    end_of(robot.walk_to(*NEAR))
    become(robot, "idle")
    assert end_of(robot.walk_to(*robot.station())).outcome is WalkOutcome.ARRIVED


@pytest.mark.parametrize(
    ("goal", "reason"),
    [
        ((50.0, 50.0), "the map ends before it"),
        ((DOORWAY[0] + 0.05, 0.05), "the body does not fit there"),
        ((math.nan, 0.0), "finite"),
    ],
)
def test_where_no_way_leads_is_refused_in_words(
    robot: RobotClient, goal: tuple[float, float], reason: str
) -> None:
    with pytest.raises(RequestRefusedError, match=reason):
        robot.path_length(*goal)
    walk = robot.walk_to(*goal)
    report = walk.report()
    assert report is not None
    assert report.outcome is WalkOutcome.REFUSED
    assert reason in report.message
    assert walk.next_feedback(DEADLINE) is None
    assert phase(robot) == "docked"


def test_a_cancelled_walk_ends_where_the_robot_stands(live: LiveClient, robot: RobotClient) -> None:
    # In the robot's own thread, and before it begins: else it might arrive first.
    live.watch(lambda one, _: one.brain.walking.end())
    walk = robot.walk_to(*FAR)
    report = end_of(walk)
    assert report.outcome is WalkOutcome.CANCELLED
    assert abs(robot.state().speed) < 0.03
    walk.cancel()
    assert walk.report() == report


def test_cancel_and_stop_end_a_walk(tmp_path: Path) -> None:
    live = live_client(str(tiny_home(tmp_path)), seed=1, speed=1.0, knows_map=True)
    live.start()
    robot = LiveRobotClient(live)
    try:
        for end in (lambda walk: walk.cancel(), lambda _: robot.stop()):
            walk = robot.walk_to(*FAR)
            wait_until(lambda: robot.state().speed > 0.05, DEADLINE, "the robot on its way")
            end(walk)
            report = end_of(walk)
            assert report.outcome is WalkOutcome.CANCELLED
            assert report.distance > 0.0
            assert robot.state().speed < 0.03
    finally:
        live.end()


def test_a_newer_walk_takes_over(robot: RobotClient) -> None:
    first, second = robot.walk_to(*FAR), robot.walk_to(*NEAR)
    report = end_of(first)
    assert report.outcome in (WalkOutcome.CANCELLED, WalkOutcome.ARRIVED)
    assert end_of(second).outcome is WalkOutcome.ARRIVED
    state = robot.state()
    assert math.dist((state.x, state.y), NEAR) < 0.06


def test_a_clean_ends_a_walk(robot: RobotClient) -> None:
    slow = robot.walk_to(*FAR)
    robot.clean()
    assert end_of(slow).outcome in (WalkOutcome.CANCELLED, WalkOutcome.ARRIVED)
    assert phase(robot) != "idle"


def test_a_whole_clean_is_told_and_reported(robot: RobotClient) -> None:
    clean = robot.clean()
    first = clean.next_feedback(DEADLINE)
    assert first is not None
    assert (first.state, first.covered < 1.0, first.wanted > 2.0) == ("cleaning", True, True)
    report = end_of(clean)
    assert (report.outcome, report.message) == (ErrandOutcome.COMPLETED, "")
    assert report.covered > 0.97 * report.wanted
    assert report.dirt > 1.0
    assert report.distance > 5.0
    assert report.energy > 0.0
    assert phase(robot) == "docked"
    assert clean.next_feedback(DEADLINE) is None


def test_a_clean_waits_for_a_walk_and_a_pause_and_goes_on(robot: RobotClient) -> None:
    clean = robot.clean(passes=5)
    become(robot, "cleaning")
    walk = robot.walk_to(*NEAR)
    become(robot, "paused")
    assert end_of(walk).outcome is WalkOutcome.ARRIVED
    with pytest.raises(RequestRefusedError, match="cannot pause now: the robot is paused"):
        robot.pause()
    assert clean.report() is None
    robot.resume()
    become(robot, "cleaning")
    robot.pause()
    assert phase(robot) == "paused"
    robot.resume()
    robot.stop()
    report = end_of(clean)
    assert report.outcome is ErrandOutcome.STOPPED
    assert report.missed
    assert phase(robot) == "idle"
    with pytest.raises(RequestRefusedError, match="cannot resume now: the robot is idle"):
        robot.resume()


def test_a_newer_errand_takes_over_and_a_refused_one_does_not(robot: RobotClient) -> None:
    first = robot.clean(passes=5)
    refused = end_of(robot.clean(CleanMode.ROOMS, rooms=("attic",)))
    assert refused.outcome is ErrandOutcome.REFUSED
    assert "attic" in refused.message
    become(robot, "cleaning")
    assert first.report() is None
    docking = robot.dock()
    ended = first.report()
    assert ended is not None
    assert (ended.outcome, ended.message) == (ErrandOutcome.STOPPED, "it was told to dock")
    assert docking.next_feedback(DEADLINE) in ("returning", "docking")
    again = robot.dock()
    assert end_of(docking).outcome is ErrandOutcome.STOPPED
    assert end_of(again).outcome is ErrandOutcome.COMPLETED
    assert phase(robot) == "docked"
    assert end_of(robot.undock()).outcome is ErrandOutcome.COMPLETED
    assert phase(robot) == "idle"


def test_errands_are_cancelled(robot: RobotClient) -> None:
    clean = robot.clean(passes=5)
    become(robot, "cleaning")
    clean.cancel()
    report = clean.report()
    assert report is not None
    assert report.outcome is ErrandOutcome.STOPPED
    docking = robot.dock()
    docking.cancel()
    docked = end_of(docking)
    assert docked.outcome in (ErrandOutcome.STOPPED, ErrandOutcome.COMPLETED)
    undocking = robot.undock()
    undocking.cancel()
    clean = robot.clean(passes=5)
    undocking.cancel()
    become(robot, "cleaning")
    assert clean.report() is None


def test_a_way_out_of_the_station_that_is_stopped_is_no_success(unhurried: RobotClient) -> None:
    undocking = unhurried.undock()
    assert undocking.next_feedback(DEADLINE) == "undocking"
    unhurried.stop()
    assert end_of(undocking).outcome is ErrandOutcome.STOPPED
    assert end_of(unhurried.dock()).outcome is ErrandOutcome.COMPLETED
    undocking = unhurried.undock()
    assert undocking.next_feedback(DEADLINE) == "undocking"
    undocking.cancel()
    assert end_of(undocking).outcome is ErrandOutcome.STOPPED


def test_rooms_are_cleaned_and_spots(robot: RobotClient) -> None:
    names = robot.rooms()
    assert names
    report = end_of(robot.clean(CleanMode.ROOMS, rooms=names[:1]))
    assert report.outcome is ErrandOutcome.COMPLETED
    spot = end_of(robot.clean(CleanMode.SPOT, spot=NEAR))
    assert spot.outcome is ErrandOutcome.COMPLETED
    assert spot.wanted < 2.5


@pytest.mark.parametrize("passes", [0, 6, 1000])
def test_what_cannot_be_asked_is_refused_at_once(robot: RobotClient, passes: int) -> None:
    with pytest.raises(RequestRefusedError, match="expected 1 to 5 passes"):
        robot.clean(passes=passes)


def test_dirt_limits_and_the_beep(robot: RobotClient) -> None:
    limits = robot.limits()
    assert (limits.low, limits.high) == (-100.0, 100.0)
    end_of(robot.walk_to(*NEAR))
    before = robot.state().dirt
    assert before > 0.0
    end_of(robot.clean(CleanMode.SPOT))
    end_of(robot.walk_to(*NEAR))
    assert robot.state().dirt < 0.5 * before
    robot.locate()


def test_a_full_bin_is_emptied_and_the_clean_goes_on(tmp_path: Path) -> None:
    home = str(tiny_home(tmp_path))
    live = live_client(home, seed=1, speed=100.0, knows_map=True, bin_grams=0.8)
    live.start()
    robot = LiveRobotClient(live)
    try:
        clean = robot.clean()
        become(robot, "bin full")
        assert "empty" in robot.vacuum().message
        assert robot.vacuum().hindrance is Hindrance.BIN_FULL
        assert clean.report() is None
        robot.empty_bin()
        wait_until(lambda: phase(robot) != "bin full", DEADLINE, "the clean to go on")
        assert robot.vacuum().message == ""
    finally:
        live.end()


def test_it_explores_a_home_without_a_map_once(tmp_path: Path) -> None:
    home = str(tiny_home(tmp_path))
    live = live_client(home, seed=1, speed=100.0, knows_map=False)
    live.start()
    robot = LiveRobotClient(live)
    try:
        with pytest.raises(RobotUnavailableError, match="explore the home first"):
            robot.rooms()
        exploring = robot.explore()
        known = exploring.next_feedback(DEADLINE)
        assert known is not None
        assert known > 0.5
        report = end_of(exploring)
        assert report.outcome is ErrandOutcome.COMPLETED
        assert report.known > 3.0
        assert report.distance > 0.0
        assert robot.rooms()
        refused = end_of(robot.explore())
        assert refused.outcome is ErrandOutcome.REFUSED
        assert "nothing to explore" in refused.message
        assert end_of(robot.clean()).outcome is ErrandOutcome.COMPLETED
    finally:
        live.end()


@pytest.mark.parametrize(
    "begin",
    [
        lambda robot: robot.clean(),
        lambda robot: robot.walk_to(*FAR),
        lambda robot: robot.undock(),
    ],
)
def test_the_end_of_the_robot_ends_what_it_was_at(
    tmp_path: Path, begin: Callable[[RobotClient], Ending[object]]
) -> None:
    live = live_client(str(tiny_home(tmp_path)), seed=1, speed=0.1, knows_map=True)
    live.start()
    robot: RobotClient = LiveRobotClient(live)
    errand = begin(robot)
    assert errand.report() is None
    live.end()
    report = errand.report()
    assert getattr(report, "outcome").value == "disconnected"  # noqa: B009 - of any errand
    assert "the robot has ended" in getattr(report, "message")  # noqa: B009
    for ask in (robot.state, robot.vacuum, robot.dock, robot.station):
        with pytest.raises(RobotUnavailableError, match="start it again"):
            ask()
