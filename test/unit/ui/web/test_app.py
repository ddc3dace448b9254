"""The application over a robot that only writes down what it is told."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
from fastapi.routing import APIRoute
from fastapi.testclient import TestClient
from fixtures.households.written_robot import VIEW, WrittenRobot
from fixtures.routes import all_routes

from roomba.clean_request import CleanRequest
from roomba.ui.web.app import STATIC, create_app
from roomba.ui.web.guard import Guard
from roomba.vocabulary import MOST_ZONES, CleanMode, FanLevel

TOKEN = "the-token"
HOST = {"Host": "127.0.0.1:8400"}
AUTHORISED = {"Authorization": f"Bearer {TOKEN}"}


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def page(robot: WrittenRobot) -> Iterator[TestClient]:
    app = create_app(robot, Guard(TOKEN))
    with TestClient(app, base_url="http://127.0.0.1:8400") as client:
        yield client


def routes(page: TestClient) -> list[tuple[str, str]]:
    """Return method and path of every route that changes something."""
    paths = page.get("/openapi.json").json()["paths"]
    return [
        (method.upper(), path.replace("{name}", "x"))
        for path, methods in paths.items()
        for method in methods
        if method != "get"
    ]


def test_every_change_needs_the_token(page: TestClient, robot: WrittenRobot) -> None:
    changing = routes(page)
    assert len(changing) >= 15
    for method, path in changing:
        for headers in ({}, {"Authorization": "Bearer wrong"}, {"Authorization": TOKEN}):
            answer = page.request(method, path, json={}, headers=headers)
            assert answer.status_code == 401, (method, path)
            assert "token" in answer.json()["detail"]
    assert robot.told == []


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Host": "evil.example"}, 421),
        ({"Origin": "http://evil.example"}, 403),
        ({"Content-Type": "text/plain"}, 415),
    ],
)
def test_requests_of_other_sites_are_refused(
    page: TestClient, robot: WrittenRobot, headers: dict[str, str], status: int
) -> None:
    given = {**AUTHORISED, "Content-Type": "application/json", **headers}
    answer = page.post("/api/v1/dock", content="{}", headers=given)
    assert answer.status_code == status
    assert robot.told == []


def test_a_body_that_is_too_long_is_refused(page: TestClient, robot: WrittenRobot) -> None:
    answer = page.post("/api/v1/stop", content=b" " * 70_000, headers=AUTHORISED)
    assert answer.status_code == 413
    assert robot.told == []


def test_commands_reach_the_robot(page: TestClient, robot: WrittenRobot) -> None:
    body = {"mode": "rooms", "rooms": ["hall", "den"], "passes": 2, "fan": "quiet"}
    assert page.post("/api/v1/clean", json=body, headers=AUTHORISED).json() == {"ok": True}
    assert page.post("/api/v1/pause", json={}, headers=AUTHORISED).status_code == 200
    (name, (request,)), paused = robot.told
    assert name == "clean"
    assert request == CleanRequest(
        CleanMode.ROOMS, ("hall", "den"), passes=2, fan=FanLevel.QUIET, in_order=True
    )
    assert paused == ("pause", ())


@pytest.mark.parametrize(("phase", "status"), [("paused", 200), ("docked", 409)])
def test_a_robot_that_is_paused_already_is_paused(
    page: TestClient, robot: WrittenRobot, phase: str, status: int
) -> None:
    robot.refusal = f"cannot pause now: the robot is {phase}"
    robot.view = replace(robot.view, vacuum=replace(robot.view.vacuum, phase=phase))
    assert page.post("/api/v1/pause", json={}, headers=AUTHORISED).status_code == status


def test_a_clean_has_as_many_rooms_as_a_request_takes(
    page: TestClient, robot: WrittenRobot
) -> None:
    for count, status in ((MOST_ZONES, 200), (MOST_ZONES + 1, 422)):
        body = {"mode": "rooms", "rooms": count * ["hall"]}
        answer = page.post("/api/v1/clean", json=body, headers=AUTHORISED)
        assert answer.status_code == status
    assert len(robot.told) == 1


@pytest.mark.parametrize(
    "body",
    [
        {"mode": "everything"},
        {"passes": 0},
        {"passes": 6},
        {"rooms": ["x" * 81]},
        {"zones": [[0, 0, 1]]},
        {"spot": ["NaN", 0]},
        {"spot": [1e9, 0]},
        {"unknown": 1},
    ],
)
def test_bad_wishes_are_refused(
    page: TestClient, robot: WrittenRobot, body: dict[str, Any]
) -> None:
    answer = page.post("/api/v1/clean", json=body, headers=AUTHORISED)
    assert answer.status_code == 422
    assert robot.told == []


@pytest.mark.parametrize(
    ("path", "body", "said"),
    [
        ("go", b'{"x": NaN, "y": 0}', "x: expected a finite number, got nan"),
        ("go", b'{"x": 1e999, "y": 0}', "x: expected a finite number, got inf"),
        ("go", b'{"x": 1}', "y: expected a value, got nothing"),
        ("go", b"{", "expected JSON, got something else from character 1 on"),
        ("go", b"[]", "body: expected keys and values, got []"),
        ("go", b"", "body: expected a value, got nothing"),
        ("rooms/rename", b'{"name": "\\ud800", "new_name": "x"}', "got '\\ud800'"),
        ("go", b'{"x": 1, "y": 1, "\\ud800": 1}', "got '\\ud800'"),
        ("go", b'{"x": 1, "y": 1, "z": 1}', "z: expected no field of that name, got 1"),
        ("rooms/rename", b'{"name": "", "new_name": "x"}', "expected a name of 1 to 80 printable"),
        ("clean", b'{"passes": 9}', "passes: expected less than or equal to 5, got 9"),
        ("clean", b'{"passes": "x"}', "passes: expected a valid integer, got 'x'"),
        ("clean", b'{"fan": "x"}', "fan: expected 'quiet', 'standard' or 'strong', got 'x'"),
        ("rooms/join", b'{"names": ["x"]}', "names: expected at least 2 items, got ['x']"),
    ],
)
def test_what_does_not_fit_is_told_in_plain_words(
    page: TestClient, robot: WrittenRobot, path: str, body: bytes, said: str
) -> None:
    headers = {**AUTHORISED, "Content-Type": "application/json"}
    answer = page.post(f"/api/v1/{path}", content=body, headers=headers)
    assert answer.status_code == 422
    assert said in answer.json()["detail"]
    assert robot.told == []


def test_a_refusal_is_the_robots_sentence(page: TestClient, robot: WrittenRobot) -> None:
    robot.refusal = "expected a battery of 20% or more to begin, got 3%"
    answer = page.post("/api/v1/clean", json={}, headers=AUTHORISED)
    assert (answer.status_code, answer.json()["detail"]) == (409, robot.refusal)


def test_a_zone_of_any_name_can_be_removed(page: TestClient, robot: WrittenRobot) -> None:
    for name in ("stairs/hall", "a b", "x/", "50 %"):
        answer = page.delete(f"/api/v1/zones/{quote(name, safe='')}", headers=AUTHORISED)
        assert answer.status_code == 200
        assert robot.told.pop() == ("remove_zone", (name,))


def test_what_the_api_has_by_another_method_is_told(page: TestClient) -> None:
    for path in ("/api/v1/state", "/api/v1/home"):
        assert page.head(path).status_code == 405
    assert page.head("/").status_code == 200
    assert page.get("/api/v1/nowhere").status_code == 404


def test_a_robot_that_is_gone_is_said(page: TestClient, robot: WrittenRobot) -> None:
    robot.is_gone = True
    answer = page.get("/api/v1/state")
    assert answer.status_code == 503
    assert "ended" in answer.json()["detail"]


def test_what_is_not_known_is_null(page: TestClient) -> None:
    assert page.get("/api/v1/state").json()["vacuum"]["battery"] is None


def test_the_page_is_small_and_needs_nothing_from_outside(page: TestClient) -> None:
    files = [file for file in STATIC.rglob("*") if file.is_file()]
    assert sum(file.stat().st_size for file in files) <= 300_000
    for file in files:
        answer = page.get(f"/{file.relative_to(STATIC).as_posix()}")
        assert answer.status_code == 200
        text = file.read_text(encoding="utf-8").replace("http://www.w3.org/2000/svg", "")
        assert "http://" not in text
        assert "https://" not in text
    policy = page.get("/").headers["content-security-policy"]
    assert "default-src 'self'" in policy


@pytest.mark.parametrize(
    "path", ["/../app.py", "/%2e%2e/app.py", "/..%2fapp.py", "/static/../app.py"]
)
def test_no_file_beside_the_page_is_served(page: TestClient, path: str) -> None:
    assert page.get(path).status_code == 404


def test_a_viewer_gets_home_layers_and_state(page: TestClient) -> None:
    with page.websocket_connect("/live", headers=HOST) as socket:
        kinds: set[str] = set()
        for message in _messages(socket):
            kinds.add("layer" if message.get("bytes") else json.loads(message["text"])["type"])
            if kinds == {"home", "layer", "trail", "state"}:
                break


def test_a_viewer_hears_that_the_robot_is_gone(page: TestClient, robot: WrittenRobot) -> None:
    with page.websocket_connect("/live", headers=HOST) as socket:
        robot.is_gone = True
        assert "ended" in json.loads(_await(socket, '"link":"gone"'))["reason"]
        robot.is_gone = False
        _await(socket, '"link":"live"')


def test_only_with_the_token_a_viewer_drives(page: TestClient, robot: WrittenRobot) -> None:
    drive = json.dumps({"type": "drive", "linear": 0.1, "angular": 0.0})
    with page.websocket_connect("/live", headers=HOST) as socket:
        socket.send_text(drive)
        socket.send_text(json.dumps({"type": "hello", "token": "wrong"}))
        _await(socket, '"may_change":false')
        socket.send_text(drive)
        socket.send_text(json.dumps({"type": "hello", "token": TOKEN}))
        _await(socket, '"may_change":true')
        assert robot.told == []
        socket.send_text(drive)
        socket.send_text("garbage")
        _await(socket, "refused")
        assert robot.told == [("drive", (0.1, 0.0))]


@pytest.mark.parametrize("told", ["garbage", "[]", '{"type": 3}', '{"type": "drive"}', "9" * 500])
def test_garbage_ends_no_viewer(page: TestClient, robot: WrittenRobot, told: str) -> None:
    with page.websocket_connect("/live", headers=HOST) as socket:
        socket.send_text(json.dumps({"type": "hello", "token": TOKEN}))
        _await(socket, "welcome")
        for _ in range(20):
            socket.send_text(told)
        robot.view = replace(VIEW, time=99.0)
        _await(socket, '"time":99.0')
    assert robot.told == []


def _messages(socket: Any) -> Iterator[Any]:
    """What comes; fails when it is not left long after all should have come."""
    end = time.monotonic() + 30.0
    while time.monotonic() < end:
        yield socket.receive()
    raise AssertionError("not within 30 s")


def _await(socket: Any, text: str) -> str:
    """Return the first message with a text in it."""
    told = (message.get("text") or "" for message in _messages(socket))
    return next(each for each in told if text in each)


def test_routes_are_described(page: TestClient) -> None:
    app: Any = page.app
    described = [route for route in all_routes(app.routes) if isinstance(route, APIRoute)]
    assert len(described) > 20
    for route in described:
        assert route.summary, route.path
    assert (Path(STATIC) / "index.html").is_file()


def test_zones_that_the_robot_offers_are_ignored_by_place(
    page: TestClient, robot: WrittenRobot
) -> None:
    for body, status in (({"x": 1.0, "y": 2.0}, 200), ({"x": 1.0}, 422), ({"x": "a", "y": 2}, 422)):
        answer = page.post("/api/v1/low_things/ignore", json=body, headers=AUTHORISED)
        assert answer.status_code == status
    assert robot.told == [("ignore_low_thing", (1.0, 2.0))]
