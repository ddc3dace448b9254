"""Every route of the whole application, taken from itself: what changes anything is guarded."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.routing import APIRoute, APIWebSocketRoute
from fastapi.testclient import TestClient
from fixtures.robots.able_robot import AbleRobot
from fixtures.routes import all_routes
from hypothesis import given
from hypothesis import strategies as st
from starlette.routing import Mount
from starlette.testclient import WebSocketDenialResponse
from starlette.websockets import WebSocket, WebSocketDisconnect
from unit.history.made import made_figures, made_recording

from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper
from roomba.history.run import RunSource
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard

TOKEN = "the-token"
ADDRESS = "http://127.0.0.1:8400"
RIGHT = {"Authorization": f"Bearer {TOKEN}", "Content-Type": "application/json"}
SAFE = {"GET", "HEAD", "OPTIONS"}


class Bridge:
    """Takes all that comes."""

    def __init__(self) -> None:
        self.limits: Mapping[str, int] = {"programs": 3}

    async def serve(self, socket: WebSocket, guard: Guard, *, may_change: bool) -> None:
        await socket.send_text(json.dumps(may_change))


@pytest.fixture
def robot() -> AbleRobot:
    return AbleRobot()


@pytest.fixture
def page(robot: AbleRobot, tmp_path: Path) -> Iterator[TestClient]:
    history = History(tmp_path)
    history.add(made_figures(), made_recording())
    keeper = HistoryKeeper(history, RunSource("play", "box"), lambda _: None)
    app = create_app(robot, Guard(TOKEN), keeper, Bridge())
    with TestClient(app, base_url=ADDRESS, follow_redirects=False) as client:
        yield client


def routes(app: FastAPI) -> list[tuple[str, str]]:
    """Return method and path of each route, with values in it."""
    return [
        (method, route.path_format.replace("{name}", "x").replace("{number}", "1"))
        for route in all_routes(app.routes)
        if isinstance(route, APIRoute)
        for method in route.methods or ()
    ]


def changing(page: TestClient) -> list[tuple[str, str]]:
    """Return those that may change something, and such on what is mounted or not there."""
    app: Any = page.app
    found = [(method, path) for method, path in routes(app) if method not in SAFE]
    mounted = [route.path for route in all_routes(app.routes) if isinstance(route, Mount)]
    assert sorted(mounted) == ["", "/replay"]
    again = page.get("/replay/1/openapi.json").json()["paths"]
    found += [
        (method.upper(), f"/replay/1{path.replace('{name}', 'x')}")
        for path, methods in again.items()
        for method in methods
        if method.upper() not in SAFE
    ]
    return [*found, ("POST", "/"), ("PUT", "/index.html"), ("PATCH", "/nowhere"), ("TRACE", "/")]


def test_there_are_many_and_with_the_token_they_are_reached(
    page: TestClient, robot: AbleRobot
) -> None:
    reached = [
        page.request(method, path, content="{}", headers=RIGHT).status_code
        for method, path in changing(page)
    ]
    assert len(reached) > 45
    assert not {401, 403, 413, 415, 421} & set(reached)
    assert len(robot.told) > 10


FORBIDDEN: dict[str, tuple[dict[str, str], int]] = {
    "no token": ({"Content-Type": "application/json"}, 401),
    "a wrong token": ({**RIGHT, "Authorization": f"Bearer {TOKEN}x"}, 401),
    "another host": ({**RIGHT, "Host": "evil.example:8400"}, 421),
    "another site": ({**RIGHT, "Origin": "http://evil.example"}, 403),
    "a plain text": ({**RIGHT, "Content-Type": "text/plain"}, 415),
    "a long body": ({**RIGHT, "Content-Length": "70000"}, 413),
}
ALSO_FORBIDDEN: tuple[tuple[dict[str, str], int], ...] = (
    ({**RIGHT, "Authorization": TOKEN}, 401),
    ({**RIGHT, "Authorization": "Bearer"}, 401),
    ({**RIGHT, "Authorization": f"Basic {TOKEN}"}, 401),
    ({"Content-Type": "application/json", "Cookie": f"token={TOKEN}"}, 401),
    ({**RIGHT, "Host": "evil.example"}, 421),
    ({**RIGHT, "Host": "[::1"}, 421),
    ({**RIGHT, "Host": ""}, 421),
    ({**RIGHT, "Origin": "http://127.0.0.1:8401"}, 403),
    ({**RIGHT, "Origin": "null"}, 403),
    ({**RIGHT, "Origin": "http://[::1"}, 403),
    ({**RIGHT, "Content-Type": "application/x-www-form-urlencoded"}, 415),
    ({**RIGHT, "Content-Type": "multipart/form-data; boundary=x"}, 415),
    ({**RIGHT, "Content-Length": "-1"}, 413),
    ({**RIGHT, "Content-Length": "٣"}, 413),
    ({**RIGHT, "Content-Length": "9" * 5000}, 413),
)


@pytest.mark.parametrize(("headers", "status"), FORBIDDEN.values(), ids=FORBIDDEN)
def test_no_route_changes_anything_without_being_allowed(
    page: TestClient, robot: AbleRobot, headers: dict[str, str], status: int
) -> None:
    for method, path in changing(page):
        answer = page.request(method, path, content="{}", headers=headers)
        assert answer.status_code == status, (method, path, answer.text)
    assert robot.told == []


@pytest.mark.parametrize(("headers", "status"), ALSO_FORBIDDEN, ids=range(len(ALSO_FORBIDDEN)))
def test_dock_refuses_malformed_headers(
    page: TestClient, robot: AbleRobot, headers: dict[str, str], status: int
) -> None:
    encoded = [(name.encode(), value.encode()) for name, value in headers.items()]
    answer = page.post("/api/v1/dock", content="{}", headers=encoded)
    assert answer.status_code == status
    assert robot.told == []


@pytest.mark.parametrize(
    ("method", "path"), [("POST", "/api/v1/dock"), ("DELETE", "/api/v1/zones/x")]
)
def test_a_request_without_a_length_has_no_body(
    page: TestClient, robot: AbleRobot, method: str, path: str
) -> None:
    request = page.build_request(method, path, headers={"Authorization": f"Bearer {TOKEN}"})
    request.headers.pop("content-length", None)
    assert page.send(request).status_code == 200
    assert len(robot.told) == 1


def test_a_body_without_a_length_is_refused(page: TestClient, robot: AbleRobot) -> None:
    answer = page.post("/api/v1/dock", content=iter([b"{}"]), headers=RIGHT)
    assert answer.status_code == 413
    assert robot.told == []


def test_a_token_in_the_address_is_none(page: TestClient, robot: AbleRobot) -> None:
    for method, path in changing(page):
        answer = page.request(method, f"{path}?token={TOKEN}", json={})
        assert answer.status_code == 401, (method, path)
    assert robot.told == []


def test_reading_changes_nothing(page: TestClient, robot: AbleRobot) -> None:
    app: Any = page.app
    reading = [path for method, path in routes(app) if method in SAFE]
    # The events are without end; they are read elsewhere.
    for path in sorted(set(reading) - {"/api/v1/events"}):
        assert page.get(path).status_code < 500, path
    assert len(reading) >= 6
    assert robot.told == []


def test_every_body_has_an_example_that_is_obeyed(page: TestClient, robot: AbleRobot) -> None:
    described = page.get("/openapi.json").json()["paths"]
    count = 0
    for path, methods in described.items():
        for method, operation in methods.items():
            if "requestBody" in operation:
                example = operation["requestBody"]["content"]["application/json"]["example"]
                answer = page.request(method, path, json=example, headers=RIGHT)
                assert answer.status_code == 200, (path, answer.text)
                count += 1
    assert count >= 13
    assert len(robot.told) >= 10
    for path in ("/api/v1/state", "/api/v1/home", "/api/v1/limits"):
        content = described[path]["get"]["responses"]["200"]["content"]
        assert set(content["application/json"]["example"]) <= set(page.get(path).json())
    assert page.get("/api/v1/limits").json()["rosbridge"] == {"programs": 3}
    stream = described["/api/v1/events"]["get"]["responses"]["200"]["content"]
    assert "event: trouble" in stream["text/event-stream"]["example"]


def sockets(page: TestClient) -> list[str]:
    app: Any = page.app
    found = [route.path for route in all_routes(app.routes) if isinstance(route, APIWebSocketRoute)]
    return [*found, "/replay/1/live"]


@pytest.mark.parametrize(
    "headers",
    [
        {"Host": "evil.example"},
        {"Host": ""},
        {"Host": "127.0.0.1:8400", "Origin": "http://evil.example"},
        {"Host": "127.0.0.1:8400", "Origin": "null"},
    ],
)
def test_web_sockets_of_other_sites_are_refused(page: TestClient, headers: dict[str, str]) -> None:
    assert sorted(sockets(page)) == ["/", "/live", "/replay/1/live", "/rosbridge"]
    for path in sockets(page):
        with (
            pytest.raises((WebSocketDisconnect, WebSocketDenialResponse)),
            page.websocket_connect(f"{path}?token={TOKEN}", headers=headers),
        ):
            pass


def test_a_bridge_is_told_whether_a_program_may_change(page: TestClient) -> None:
    host = {"Host": "127.0.0.1:8400"}
    for path in ("/", "/rosbridge"):
        for address, headers, expected in (
            (path, {}, "false"),
            (f"{path}?token={TOKEN}", {}, "true"),
            (path, {"Authorization": f"Bearer {TOKEN}"}, "true"),
        ):
            with page.websocket_connect(address, headers={**host, **headers}) as socket:
                assert socket.receive_text() == expected
        with (
            pytest.raises(WebSocketDisconnect),
            page.websocket_connect(f"{path}?token=wrong", headers=host),
        ):
            pass


def test_guesses_of_any_kind_do_not_keep_the_right_token_out(
    page: TestClient, robot: AbleRobot
) -> None:
    host = {"Host": "127.0.0.1:8400"}
    wrong = {**RIGHT, "Authorization": "Bearer wrong"}
    for _ in range(4):
        assert page.post("/api/v1/dock", json={}, headers=wrong).status_code == 401
        with (
            pytest.raises(WebSocketDisconnect),
            page.websocket_connect("/rosbridge?token=wrong", headers=host),
        ):
            pass
        with page.websocket_connect("/live", headers=host) as socket:
            socket.send_text(json.dumps({"type": "hello", "token": "wrong"}))
            while '"may_change":false' not in (socket.receive().get("text") or ""):
                pass
    assert robot.told == []
    assert page.post("/api/v1/emergency_stop", json={}, headers=RIGHT).status_code == 200


@given(host=st.text(max_size=30), origin=st.text(max_size=30), token=st.text(max_size=30))
def test_any_text_is_judged(host: str, origin: str, token: str) -> None:
    guard = Guard(TOKEN)
    assert guard.is_host(host) in (True, False)
    assert guard.is_origin(origin, host) in (True, False)
    assert not guard.is_token(f"{token}\ud800")
