"""The history behind the page: runs as JSON, reports as documents, each run again."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest import mock

import httpx
import numpy as np
import pytest
from fastapi.testclient import TestClient
from fixtures.households.written_robot import WrittenRobot
from fixtures.waiting import wait_until
from numpy.typing import NDArray
from starlette.testclient import WebSocketTestSession
from unit.history.made import made_figures, made_recording
from websockets.sync.client import ClientConnection, connect

from roomba.files.lock import locked
from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper
from roomba.history.replay import RecordedRobot
from roomba.history.run import RunSource
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer, listen

HOST = {"Host": "127.0.0.1"}
TOKEN = {"Authorization": "Bearer token"}
_MOST_MESSAGES = 300
"""Ten times a second there is one at least."""


@pytest.fixture
def history(tmp_path: Path) -> History:
    history = History(tmp_path)
    history.add(made_figures(), made_recording())
    history.add(made_figures())
    return history


@pytest.fixture
def client(history: History) -> Iterator[TestClient]:
    robot = RecordedRobot(made_figures(), made_recording())
    keeper = HistoryKeeper(history, RunSource("play", "box"), lambda _: None)
    app = create_app(robot, Guard("token"), keeper)
    with TestClient(app, base_url="http://127.0.0.1") as client:
        yield client


def test_the_runs_are_told(client: TestClient) -> None:
    told = client.get("/api/v1/history").json()
    assert [run["number"] for run in told["runs"]] == [2, 1]
    assert [run["is_recorded"] for run in told["runs"]] == [False, True]
    assert told["runs"][0]["energy"] is None
    assert told["runs"][0]["fraction"] == pytest.approx(11.0 / 12.0)
    assert told["weeks"][0]["runs"] == 2
    newest, oldest = (
        client.get(f"/api/v1/history?{query}").json() for query in ("limit=1", "limit=1&before=2")
    )
    assert [run["number"] for run in newest["runs"]] == [2]
    assert (newest["has_older"], oldest["has_older"]) == (True, False)


def test_a_campaign_does_not_hide_the_runs_of_the_household(
    client: TestClient, history: History
) -> None:
    def told(query: str) -> tuple[list[int], list[int]]:
        values = client.get(f"/api/v1/history?{query}").json()
        return [run["number"] for run in values["runs"]], [week["runs"] for week in values["weeks"]]

    figures = made_figures()
    source = replace(figures.source, program="campaign", home="random-1")
    history.add_all([replace(figures, source=source, began=figures.began + 1.0)] * 3)
    assert told("") == ([2, 1], [2])
    assert told("program=campaign") == ([5, 4, 3], [3])
    assert told("home=random-1") == ([], [])
    assert told(f"home={figures.source.home}&program={figures.source.program}") == ([2, 1], [2])
    assert told("limit=1") == ([2], [2]), "weeks are of all"
    assert told("limit=1&before=2") == ([1], [2])
    assert told("before=1") == ([], [2])


def test_what_is_asked_for_is_noted_and_forgotten_when_it_is_refused(history: History) -> None:
    noted: list[Any] = []
    keeper = HistoryKeeper(history, RunSource("play", "box"), lambda _: None)
    robot = WrittenRobot()
    with (
        mock.patch.object(keeper, "note", noted.append),
        TestClient(
            create_app(robot, Guard("token"), keeper), base_url="http://127.0.0.1", headers=TOKEN
        ) as client,
    ):
        body = {"mode": "rooms", "rooms": ["hall"], "passes": 2}
        assert client.post("/api/v1/clean", json=body).status_code == 200
        robot.refusal = "no"
        assert client.post("/api/v1/clean", json=body).status_code == 409
    assert [note and {name: note[name] for name in body} for note in noted] == [body, body, None]


def test_a_report_has_a_policy_of_its_own(client: TestClient) -> None:
    answer = client.get("/api/v1/history/1/report.html")
    assert "11.00 m² of 12.00 m²" in answer.text
    policies = answer.headers.get_list("content-security-policy")
    assert len(policies) == 1
    assert "default-src 'none'" in policies[0]
    assert "style-src 'unsafe-inline'" in policies[0]
    other = client.get("/api/v1/history/compare.html?one=1&other=2")
    assert "Runs 1 and 2 compared" in other.text
    assert "unsafe-inline" not in client.get("/").headers["content-security-policy"]


def test_what_there_is_not_is_said(client: TestClient, history: History) -> None:
    assert client.get("/api/v1/history/9/report.html").status_code == 404
    assert "the newest is 2, got 9" in client.get("/api/v1/history/9/report.html").text
    assert client.get("/replay/9/").status_code == 404
    assert "found none" in client.get("/replay/2/").json()["detail"]
    for path in ("none", "999999999999/", "9" * 5000, "1abc", "1abc/"):
        assert client.get(f"/replay/{path}").status_code == 404
    for path in ("/api/v1/history/9/report.html", "/replay/9/", "/replay/2/"):
        told = client.get(path).json()["detail"]
        assert told.startswith("expected ")
        assert str(history.path.parent) not in told


def test_an_empty_history_does_not_tell_its_folder(tmp_path: Path) -> None:
    keeper = HistoryKeeper(History(tmp_path), RunSource("play", "box"), lambda _: None)
    app = create_app(WrittenRobot(), Guard("token"), keeper)
    with TestClient(app, base_url="http://127.0.0.1") as client:
        answer = client.get("/replay/1/")
    assert answer.status_code == 404
    assert "there are no runs yet" in answer.json()["detail"]
    assert str(tmp_path) not in answer.text


def test_a_run_is_played_under_an_address_of_its_own(client: TestClient) -> None:
    assert client.get("/replay/1", follow_redirects=False).headers["location"] == "/replay/1/"
    assert "<title>" in client.get("/replay/1/").text
    state = client.get("/replay/1/api/v1/state").json()
    assert state["pose"][:2] == [0.5, 1.5]
    moved = client.post("/replay/1/api/v1/replay", json={"at": 20.0}, headers=TOKEN)
    assert moved.json()["at"] == 20.0
    assert client.get("/replay/1/api/v1/state").json()["pose"][0] == pytest.approx(1.5)
    refused = client.post("/replay/1/api/v1/clean", json={}, headers=TOKEN)
    assert refused.status_code == 409
    assert "nothing is driven" in refused.json()["detail"]
    assert client.post("/replay/1/api/v1/replay", json={"at": 1.0}).status_code == 401
    with client.websocket_connect("/replay/1/live", headers=HOST) as socket:
        kinds = {socket.receive_json()["type"]}
        assert kinds <= {"home", "state", "trail"}


def test_many_runs_can_be_opened_one_after_the_other(client: TestClient, history: History) -> None:
    numbers = [history.add(made_figures(), made_recording()) for _ in range(6)]
    for number in (*numbers, numbers[0]):
        assert client.get(f"/replay/{number}/api/v1/state").status_code == 200


@pytest.fixture
def server(history: History) -> Iterator[PageServer]:
    keeper = HistoryKeeper(history, RunSource("play", "box"), lambda _: None)
    app = create_app(WrittenRobot(), Guard("token"), keeper)
    server = PageServer(app, listen("127.0.0.1", 0, is_fixed=True))
    server.start()
    yield server
    server.stop()


def test_a_history_that_lets_wait_holds_up_nothing_else(
    server: PageServer, history: History
) -> None:
    def open_run() -> int:
        return httpx.get(f"{server.address}replay/1/", timeout=60.0).status_code

    with (
        mock.patch.object(history, "recording", wraps=history.recording) as recording,
        ThreadPoolExecutor() as threads,
    ):
        with locked(history.path.with_suffix(".lock"), 1.0):
            opened = [threads.submit(open_run) for _ in range(2)]
            wait_until(lambda: server.connections == 2, 10.0, "both viewers came")
            stop = f"{server.address}api/v1/emergency_stop"
            assert httpx.post(stop, json={}, headers=TOKEN, timeout=5.0).status_code == 200
            assert not any(each.done() for each in opened)
        assert [each.result() for each in opened] == [200, 200]
    assert recording.call_count == 1


def test_a_run_that_is_watched_goes_on_however_many_others_are_opened(
    server: PageServer, history: History
) -> None:
    others = [history.add(made_figures(), made_recording()) for _ in range(6)]
    with _watching(server, 1) as viewer:
        for number in others:
            assert httpx.get(f"{server.address}replay/{number}/").status_code == 200
        moved = f"{server.address}replay/1/api/v1/replay"
        assert httpx.post(moved, json={"at": 20.0}, headers=TOKEN).status_code == 200
        wait_until(lambda: _time_shown(viewer) == 20.0, 10.0, "the viewer sees what was chosen")


def test_when_all_runs_are_watched_another_one_is_refused(
    server: PageServer, history: History
) -> None:
    *others, one_more = [history.add(made_figures(), made_recording()) for _ in range(4)]
    address = f"{server.address}replay/{one_more}/"
    with contextlib.ExitStack() as viewers:
        for number in others:
            viewers.enter_context(_watching(server, number))
        with _watching(server, 1):
            refused = httpx.get(address)
            assert refused.status_code == 503
            assert "expected at most 4 recorded runs" in refused.json()["detail"]
        wait_until(lambda: httpx.get(address).status_code == 200, 10.0, "there is room again")


def test_the_feed_starts_the_trail_anew_when_another_time_is_chosen() -> None:
    robot = RecordedRobot(made_figures(), made_recording())
    app = create_app(robot, Guard("token"))
    with (
        TestClient(app, base_url="http://127.0.0.1") as client,
        client.websocket_connect("/live", headers=HOST) as socket,
    ):
        robot.seek(40.0)
        assert _next_whole(socket)[-1, 0] == pytest.approx(2.5)
        robot.seek(10.0)
        assert _next_whole(socket)[-1, 0] == pytest.approx(1.0)


@contextlib.contextmanager
def _watching(server: PageServer, number: int) -> Iterator[ClientConnection]:
    address = server.address.replace("http:", "ws:")
    with connect(f"{address}replay/{number}/live", proxy=None) as viewer:
        yield viewer


def _time_shown(viewer: ClientConnection) -> float | None:
    """Return the time of the recording that the next message shows, s, if it shows one."""
    message = viewer.recv(10.0)
    told = json.loads(message) if isinstance(message, str) else {}
    return told["replay"]["at"] if told.get("type") == "state" and "replay" in told else None


def _next_whole(socket: WebSocketTestSession) -> NDArray[np.float64]:
    """Return the next trail of many places that takes the place of all before, m."""
    for _ in range(_MOST_MESSAGES):
        text = socket.receive().get("text")
        told = {} if text is None else json.loads(text)
        if told.get("type") == "trail" and told["whole"] and len(told["points"]) > 5:
            return np.array(told["points"])
    raise AssertionError(f"expected a whole trail within {_MOST_MESSAGES} messages")
