"""Events: what changed between two looks, once, by number, for any listener."""

from __future__ import annotations

import asyncio
import json
import urllib.request
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from fastapi.testclient import TestClient
from fixtures.households.written_robot import VIEW, WrittenRobot

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.client.view import RobotView
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer, listen
from roomba.ui.web.streams.events import MOST_KEPT, Events

REPORT = CleanReport(ErrandOutcome.COMPLETED, "", 4.0, 4.0, 1.0, 9.0, 60.0, float("nan"))


def seen(state: str, phase: str = "", **changes: Any) -> RobotView:
    vacuum = replace(VIEW.vacuum, state=state, phase=phase or state)
    return replace(VIEW, vacuum=vacuum, **changes)


def told(events: Events, after: int, count: int) -> list[dict[str, Any]]:
    """Return the first events after a number; each line names its number and kind."""

    async def take() -> list[str]:
        stream = events.after(after)
        return [await anext(stream) for _ in range(count)]

    found = []
    for text in asyncio.run(take()):
        lines = dict(line.split(": ", 1) for line in text.strip().splitlines())
        data = json.loads(lines["data"])
        assert data["type"] == lines["event"]
        found.append({**data, "id": int(lines["id"])})
    return found


def test_a_run_begins_meets_trouble_and_ends() -> None:
    events = Events()
    events.note(seen("docked"))
    events.note(seen("docked"))
    events.note(seen("cleaning", "undocking"))
    events.note(seen("cleaning"))
    events.note(seen("cleaning", held="the button"))
    events.note(seen("error"))
    events.note(seen("cleaning"))
    events.note(seen("docked", last=REPORT))
    events.note(seen("docked", last=replace(REPORT)))
    events.note_gone("its program has ended")
    events.note_gone("its program has ended")
    found = told(events, 0, 11)
    assert [event["type"] for event in found] == [
        *("state", "state", "begun", "state", "trouble", "state", "trouble"),
        *("state", "state", "ended", "trouble"),
    ]
    assert [event["id"] for event in found] == list(range(1, 12))
    assert [event["message"] for event in found if event["type"] == "trouble"] == [
        *("the button", "", "its program has ended"),
    ]
    (end,) = (event for event in found if event["type"] == "ended")
    assert (end["outcome"], end["covered"], end["energy"]) == ("completed", 4.0, None)


def test_a_run_that_ended_before_is_no_news() -> None:
    events = Events()
    events.note(seen("docked", last=REPORT))
    assert [event["type"] for event in told(events, 0, 1)] == ["state"]
    assert events.newest == 1


def test_a_listener_that_comes_late_hears_how_many_it_missed() -> None:
    events = Events()
    for number in range(MOST_KEPT + 50):
        events.note(seen("docked", f"phase {number}"))
    missed, first = told(events, 10, 2)
    assert (missed["type"], missed["count"]) == ("missed", 40)
    assert first["id"] == missed["id"] + 1 == 51


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def server(robot: WrittenRobot) -> Iterator[PageServer]:
    server = PageServer(create_app(robot, Guard("t")), listen("127.0.0.1", 0, is_fixed=True))
    server.start()
    yield server
    server.stop()


def test_programs_listen_over_http(server: PageServer, robot: WrittenRobot) -> None:

    def lines(after: str) -> Iterator[str]:
        request = urllib.request.Request(
            f"{server.address}api/v1/events", headers={"Last-Event-ID": after}
        )
        with urllib.request.urlopen(request, timeout=10.0) as answer:
            assert answer.headers["content-type"].startswith("text/event-stream")
            for line in answer:
                yield line.decode().strip()

    stream = lines("0")
    while not next(stream).startswith("data: "):
        pass
    robot.view = seen("docked")
    data = next(line for line in stream if '"docked"' in line)
    assert json.loads(data.removeprefix("data: "))["type"] == "state"
    # A number of a server from before is none of this one: it begins at the beginning.
    assert "id: 1" in [next(again) for again in [lines("999")] for _ in range(5)]


def test_wrong_numbers_are_refused(robot: WrittenRobot) -> None:
    with TestClient(create_app(robot, Guard("t")), base_url="http://127.0.0.1") as page:
        assert page.get("/api/v1/events", headers={"Last-Event-ID": "x"}).status_code == 422
        assert page.get("/api/v1/events?after=-1").status_code == 422
