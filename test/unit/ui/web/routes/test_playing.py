"""Playing by the API, over a robot that only writes down what it is told."""

from __future__ import annotations

from typing import Any

import pytest
from fastapi.testclient import TestClient
from fixtures.households.written_robot import WrittenRobot

from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard

AUTHORISED = {"Authorization": "Bearer the-token"}


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def page(robot: WrittenRobot) -> TestClient:
    return TestClient(create_app(robot, Guard("the-token")), base_url="http://127.0.0.1:8400")


@pytest.mark.parametrize(
    ("path", "body", "told"),
    [
        ("spill", {"x": 1.0, "y": 2.0}, ("spill_dirt", (1.0, 2.0))),
        ("chair", {"x": 1.0, "y": 2.0}, ("place_chair", (1.0, 2.0))),
        ("put", {"x": 1.0, "y": 2.0, "theta": 0.5}, ("put_down", (1.0, 2.0, 0.5))),
        ("door", {"name": "gate", "is_shut": True}, ("set_door", ("gate", True))),
        ("lift", {}, ("lift", ())),
        ("block", {}, ("block_station", ())),
        ("clear", {}, ("clear_away", ())),
    ],
)
def test_the_robot_is_told(
    page: TestClient, robot: WrittenRobot, path: str, body: dict[str, Any], told: tuple[Any, ...]
) -> None:
    answer = page.post(f"/api/v1/play/{path}", json=body, headers=AUTHORISED)
    assert answer.json() == {"ok": True}
    assert robot.told == [told]


def test_what_makes_no_sense_is_refused(page: TestClient, robot: WrittenRobot) -> None:
    for path, body in (
        ("spill", {"x": 1.0}),
        ("put", {"x": 0.0, "y": 0.0, "theta": 100.0}),
        ("door", {"name": "", "is_shut": True}),
        ("door", {"name": "gate"}),
    ):
        answer = page.post(f"/api/v1/play/{path}", json=body, headers=AUTHORISED)
        assert answer.status_code == 422, (path, body)
    assert robot.told == []


def test_the_robots_refusal_is_passed_on(page: TestClient, robot: WrittenRobot) -> None:
    robot.refusal = "it does not fit there"
    answer = page.post("/api/v1/play/put", json={"x": 0.0, "y": 0.0}, headers=AUTHORISED)
    assert (answer.status_code, answer.json()["detail"]) == (409, "it does not fit there")
