"""Events: what changed between two looks, once, by number, for any listener."""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
import urllib.request
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from fastapi.testclient import TestClient
from fixtures.households.written_robot import VIEW, WrittenRobot
from starlette.requests import ClientDisconnect
from starlette.types import Message, Scope

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.client.view import RobotView
from roomba.ui.web.app import create_app
from roomba.ui.web.bounded.limits import MOST_LISTENERS
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer, listen
from roomba.ui.web.streams.events import MOST_KEPT, Events, first_of
from roomba.vocabulary import Hindrance

REPORT = CleanReport(ErrandOutcome.COMPLETED, "", 4.0, 4.0, 1.0, 9.0, 60.0, float("nan"))
_REQUEST = b"GET /api/v1/events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
_SCOPE: Scope = {
    "type": "http",
    "asgi": {"version": "3.0", "spec_version": "2.4"},
    "http_version": "1.1",
    "method": "GET",
    "scheme": "http",
    "path": "/api/v1/events",
    "query_string": b"",
    "headers": [(b"host", b"127.0.0.1")],
}


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


def hindered(message: str, hindrance: Hindrance) -> RobotView:
    vacuum = replace(VIEW.vacuum, message=message, hindrance=hindrance)
    return replace(VIEW, vacuum=vacuum)


def test_a_hindrance_that_goes_on_is_told_once_though_its_words_change() -> None:
    events = Events()
    for seconds in range(1, 5):
        events.note(hindered(f"got none for {seconds} s", Hindrance.SENSOR_SILENT))
    events.note(hindered("the line is gone", Hindrance.UNREACHABLE))
    events.note(VIEW)
    assert [event.get("message") for event in told(events, 1, 3)] == [
        *("got none for 1 s", "the line is gone", ""),
    ]


def test_a_run_that_charges_in_its_middle_is_begun_once() -> None:
    events = Events()
    for state, phase in (
        *(("docked", "docked"), ("cleaning", "undocking"), ("returning", "docking")),
        *(("docked", "emptying"), ("docked", "charging"), ("cleaning", "undocking")),
        *(("docked", "docked"), ("docked", "emptying"), ("docked", "docked")),
    ):
        events.note(seen(state, phase))
    assert [event["type"] for event in told(events, 0, 10)].count("begun") == 1


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


@pytest.mark.parametrize("before", [9, 2**50])
def test_a_listener_of_a_server_from_before_hears_that_it_missed_some_and_then_all(
    before: int,
) -> None:
    first = first_of(1_790_000_000.0)
    events = Events(first)
    assert events.newest == first - 1
    events.note(seen("docked"))
    events.note(seen("cleaning"))
    missed, *heard = told(events, before, 4)
    assert (missed["type"], missed["count"], missed["id"]) == ("missed", None, first - 1)
    assert [event["id"] for event in heard] == [first, first + 1, first + 2]
    assert [event["id"] for event in told(events, 0, 3)] == [event["id"] for event in heard]


def _asking(server: PageServer) -> socket.socket:
    host, port = server.address.removeprefix("http://").strip("/").split(":")
    return socket.create_connection((host, int(port)), timeout=30.0)


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
    # A server that was started before had smaller numbers.
    again = lines("9")
    missed, first = (
        json.loads(line.removeprefix("data: "))
        for line in [next(line for line in again if line.startswith("data: ")) for _ in range(2)]
    )
    assert (missed["type"], missed["count"], first["type"]) == ("missed", None, "state")


def test_of_many_that_come_at_once_no_more_listen_than_are_allowed(server: PageServer) -> None:
    with contextlib.ExitStack() as ends:
        sockets = [ends.enter_context(_asking(server)) for _ in range(4 * MOST_LISTENERS)]
        for each in sockets:
            each.sendall(_REQUEST)
        answers = Counter(each.recv(12).decode() for each in sockets)
    assert answers == {"HTTP/1.1 200": MOST_LISTENERS, "HTTP/1.1 503": 3 * MOST_LISTENERS}


def test_listeners_that_are_gone_before_it_begins_take_no_place(robot: WrittenRobot) -> None:
    app = create_app(robot, Guard("t"))
    begun: list[int] = []

    async def receive() -> Message:
        return {"type": "http.request", "body": b"", "more_body": False}

    async def lose(message: Message) -> None:
        begun.append(message["status"])
        raise OSError("the program has gone")

    async def come_and_go() -> None:
        for _ in range(MOST_LISTENERS + 1):
            with pytest.raises(ClientDisconnect):
                await app({**_SCOPE}, receive, lose)

    asyncio.run(come_and_go())
    assert begun == [200] * (MOST_LISTENERS + 1)


def test_wrong_numbers_are_refused(robot: WrittenRobot) -> None:
    with TestClient(create_app(robot, Guard("t")), base_url="http://127.0.0.1") as page:
        assert page.get("/api/v1/events", headers={"Last-Event-ID": "x"}).status_code == 422
        assert page.get("/api/v1/events?after=-1").status_code == 422
