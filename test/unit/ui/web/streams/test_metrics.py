"""Metrics, as Prometheus's own parser reads them."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from fixtures.households.written_robot import VIEW, WrittenRobot
from fixtures.waiting import wait_until
from prometheus_client.parser import text_string_to_metric_families

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.commands.play.living import live_client
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard

PAGE = Path(__file__).parents[5] / "docs" / "smart_home.md"
REPORT = CleanReport(ErrandOutcome.COMPLETED, "", 4.5, 4.5, 1.5, 9.0, 60.0, float("nan"))
Samples = dict[tuple[str, str], float]


def samples(page: TestClient) -> Samples:
    """Return values by name and label."""
    answer = page.get("/metrics")
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"].startswith("text/plain")
    return {
        (sample.name, "".join(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(answer.text)
        for sample in family.samples
    }


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def page(robot: WrittenRobot) -> Iterator[TestClient]:
    app = create_app(robot, Guard("token"))
    with TestClient(app, base_url="http://127.0.0.1:8400") as client:
        wait_until(lambda: samples(client)["roomba_up", ""], 10.0)
        yield client


def show(robot: WrittenRobot, state: str, **changes: Any) -> None:
    robot.view = replace(robot.view, vacuum=replace(VIEW.vacuum, state=state, **changes))


def test_the_state_as_gauges(page: TestClient, robot: WrittenRobot) -> None:
    seen = samples(page)
    assert seen["roomba_area_square_metres", ""] == 1.0
    assert seen["roomba_wanted_square_metres", ""] == 4.0
    assert seen["roomba_bin_grams", ""] == 3.0
    assert (seen["roomba_state", "cleaning"], seen["roomba_state", "docked"]) == (1.0, 0.0)
    assert ("roomba_battery_ratio", "") not in seen, "it is not known"
    show(robot, "docked", battery=0.5)
    wait_until(lambda: samples(page)["roomba_state", "docked"], 10.0)
    assert samples(page)["roomba_battery_ratio", ""] == 0.5


def test_runs_and_troubles_are_counted(page: TestClient, robot: WrittenRobot) -> None:
    robot.view = replace(robot.view, last=REPORT)
    wait_until(lambda: samples(page).get(("roomba_runs_total", "completed")) == 1, 10.0)
    robot.view = replace(robot.view, last=replace(REPORT, duration=120.0))
    wait_until(lambda: samples(page)["roomba_runs_total", "completed"] == 2, 10.0)
    show(robot, "error", message="a wheel hangs in the air")
    wait_until(lambda: samples(page)["roomba_troubles_total", ""] == 1, 10.0)
    show(robot, "cleaning")
    wait_until(lambda: samples(page)["roomba_state", "cleaning"], 10.0)
    found = samples(page)
    assert found["roomba_troubles_total", ""] == 1
    assert found["roomba_cleaned_square_metres_total", ""] == 9.0
    assert found["roomba_dirt_grams_total", ""] == 3.0
    assert found["roomba_driven_metres_total", ""] == 18.0
    assert found["roomba_run_seconds_total", ""] == 180.0


def test_a_robot_that_is_gone_has_no_state(page: TestClient, robot: WrittenRobot) -> None:
    robot.is_gone = True
    wait_until(lambda: samples(page)["roomba_up", ""] == 0.0, 10.0)
    assert ("roomba_bin_grams", "") not in samples(page)


def test_ticks_of_the_headless_robot_and_names_of_the_page() -> None:
    live = live_client("studio", 0, 1.0, knows_map=True)
    app = create_app(live, Guard("token"))
    live.start()
    with TestClient(app, base_url="http://127.0.0.1:8400") as page:
        wait_until(lambda: samples(page)["roomba_up", ""], 10.0)
        wait_until(lambda: samples(page)["roomba_tick_seconds_count", ""] > 10, 10.0)
        found = samples(page)
    live.end()
    assert found["roomba_tick_seconds_bucket", "+Inf"] == found["roomba_tick_seconds_count", ""]
    assert 0.0 < found["roomba_tick_seconds_sum", ""] < found["roomba_clock_seconds", ""] + 60.0
    told = set(re.findall(r"`(roomba_\w+)`", PAGE.read_text(encoding="utf-8")))
    names = {re.sub(r"_(bucket|count|sum|created)$", "", name) for name, _ in found}
    assert names | {"roomba_runs_total"} == told


def test_without_the_library_it_says_what_is_missing(
    robot: WrittenRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "prometheus_client", None)
    with TestClient(create_app(robot, Guard("t")), base_url="http://127.0.0.1:8400") as page:
        answer = page.get("/metrics")
    assert answer.status_code == 501
    assert "prometheus_client" in answer.json()["detail"]
