"""A robot without a lidar, seen and commanded as a page does it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import pytest
from fixtures.bumping import BumpingHome
from fixtures.waiting import wait_until
from unit.headless.live.living import living, stop_while_busy

from roomba.clean_request import CleanRequest
from roomba.client.plain import state_of
from roomba.client.protocol import ErrandOutcome, RequestRefusedError
from roomba.client.view import LayerName
from roomba.geometry import Pose
from roomba.headless.live.bumping.client import BumpingClient
from roomba.headless.live.bumping.robot import BumpingRobot
from roomba.headless.live.bumping.view import view_of
from roomba.ui.web.streams.told import Told
from roomba.vocabulary import CleanMode


@pytest.fixture
def client() -> Iterator[BumpingClient]:
    home = BumpingHome("studio", 1)
    client = BumpingClient("studio", BumpingRobot(home.body, home.brain), speed=50.0)
    client.start()
    yield client
    client.end()


def phase(client: BumpingClient) -> str:
    return client.robot().vacuum.phase


def test_its_state_is_told_as_json(client: BumpingClient) -> None:
    told = json.loads(Told(state_of(client.robot())).text)
    assert (told["dirt"], told["vacuum"]["phase"]) == (None, "docked")


def test_it_sweeps_is_paused_goes_on_and_comes_home(client: BumpingClient) -> None:
    wait_until(lambda: phase(client) == "docked", 20.0, lambda: phase(client))
    assert client.robot().vacuum.battery == 1.0
    assert not client.robot().charges
    client.clean(CleanRequest())
    wait_until(lambda: client.robot().vacuum.covered > 1.0, 60.0, lambda: phase(client))
    assert phase(client) == "cleaning"
    coverage, floor = client.layer(LayerName.COVERAGE), client.layer(LayerName.MAP)
    assert coverage is not None
    assert floor is not None
    assert coverage.cells.sum() * coverage.resolution**2 > 1.0
    assert coverage.cells.size < 200 * 200
    assert client.layer(LayerName.DIRT) is None
    client.pause()
    assert phase(client) == "paused"
    client.resume()
    client.dock()
    wait_until(lambda: phase(client) == "docked", 120.0, lambda: phase(client))
    assert client.robot().charges
    last = client.robot().last
    assert last is not None
    assert last.outcome is ErrandOutcome.COMPLETED
    assert last.covered > 1.0
    assert last.distance > 5.0


def test_it_is_shown_where_walls_and_its_station_say_that_it_is() -> None:
    home = BumpingHome("studio", 1)
    home.brain.compass.stand_at(Pose(1.0, 2.0, 0.5))
    robot = BumpingRobot(home.body, home.brain)
    assert view_of(robot, None, 0.3).pose == (1.0, 2.0, 0.5)


def test_told_to_stop_it_stays_and_its_clean_is_told_as_stopped(client: BumpingClient) -> None:
    client.clean(CleanRequest())
    wait_until(lambda: phase(client) == "cleaning", 20.0, lambda: phase(client))
    client.stop()
    assert phase(client) == "idle"
    last = client.robot().last
    assert last is not None
    assert last.outcome is ErrandOutcome.STOPPED
    client.emergency_stop("test")
    assert client.robot().held
    with pytest.raises(RequestRefusedError):
        client.drive(0.2, 0.0)
    client.release()
    before = client.robot().pose
    client.drive(0.2, 0.0)
    wait_until(lambda: math.dist(client.robot().pose[:2], before[:2]) > 0.02, 10.0, "it drives")


def test_an_emergency_stop_that_a_busy_robot_did_not_answer_holds_it(
    client: BumpingClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    stop_while_busy(client, client._obey, monkeypatch)
    wait_until(lambda: client.robot().held == "the cat", 20.0, "it holds")


def lives(stops: Path) -> AbstractContextManager[BumpingClient]:
    home = BumpingHome("studio", 1)
    robot = BumpingRobot(home.body, home.brain)
    return living(BumpingClient("studio", robot, speed=50.0), stops)


def test_the_emergency_stop_holds_the_robot_that_is_started_anew(tmp_path: Path) -> None:
    with lives(tmp_path) as client:
        assert client.robot().held == ""
        client.emergency_stop("child in the way")
        assert client.robot().held == "child in the way"
    with lives(tmp_path) as client:
        assert client.robot().held == "child in the way"
        assert phase(client) == "emergency stop"
        before = client.robot()
        for drives_off in (client.dock, lambda: client.clean(CleanRequest())):
            with pytest.raises(RequestRefusedError, match=r"child in the way.*release it first"):
                drives_off()
        wait_until(lambda: client.robot().time > before.time + 3.0, 20.0, "its time passes")
        assert client.robot().held == "child in the way"
        assert math.dist(client.robot().pose[:2], before.pose[:2]) < 0.01
        client.release()
        assert client.robot().held == ""
        released = client.robot().time
        wait_until(lambda: client.robot().time > released + 3.0, 20.0, "its time passes")
        assert phase(client) == "docked"
    with lives(tmp_path) as client:
        assert client.robot().held == ""
        client.emergency_stop("")
    with lives(tmp_path) as client:
        assert client.robot().held == "no reason was given"


def test_what_wants_a_map_is_refused_with_the_reason(client: BumpingClient) -> None:
    rooms = CleanRequest(mode=CleanMode.ROOMS, rooms=("bath",))
    asked: tuple[Callable[[], None], ...] = (
        lambda: client.clean(rooms),
        client.explore,
        lambda: client.go_to(1.0, 1.0),
        lambda: client.remove_zone("a"),
    )
    for ask in asked:
        with pytest.raises(RequestRefusedError, match="lidar"):
            ask()
    limits = client.limits()
    assert (limits.modes, limits.most_zones) == (("whole",), 0)
    assert (limits.explores, limits.drives) == (False, True)
    assert client.home().rooms == ()
    assert "wheels" in client.robot().doubt
