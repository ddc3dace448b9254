"""The emergency stop outlives ``./roomba play`` and ``./roomba run`` that are killed (-9)."""

from __future__ import annotations

import datetime as dt
import math
import os
import re
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fixtures.graph import RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until

from roomba.client.page_api import PageApi
from roomba.client.protocol import RobotUnavailableError
from roomba.household.folder import KeptValues
from roomba.plans.memory import Memory
from roomba.plans.plan import HouseholdPlans, Plan

START = 100.0
"""s of wall time until the page of a robot that starts answers."""
REASON = "child in the way"
HELD = "the emergency stop holds the drive"
ADDRESS = re.compile(r"(http://127\.0\.0\.1:\d+)/\S*token=([\w-]+)")


def page_of(program: Program) -> PageApi:
    """Return the page of a robot, once it is printed."""
    wait_until(lambda: ADDRESS.search(program.output), START, lambda: program.output)
    found = ADDRESS.search(program.output)
    assert found is not None
    return PageApi(found[1], found[2])


def state_of(page: PageApi) -> dict[str, Any]:
    """Return the state, once the robot answers."""
    told: list[dict[str, Any]] = []

    def answers() -> bool:
        try:
            told.append(page.get("api/v1/state"))
        except RobotUnavailableError:
            return False
        return True

    wait_until(answers, START, "the robot answers")
    return told[-1]


def waiting(page: PageApi) -> list[str]:
    """Return why plans that are due wait."""
    return [plan["reason"] for plan in state_of(page)["plans"]["waiting"]]


def let_a_plan_be_due(household: Path) -> None:
    """Let a clean of all floor be due since some minutes when the robot is started."""
    before = dt.datetime.now(dt.timezone.utc) - dt.timedelta(minutes=5)
    at = (before + dt.timedelta(minutes=3)).time().replace(second=0, microsecond=0)
    plans = HouseholdPlans(zone="UTC", plans=(Plan(name="all", at=(at,)),))
    agenda = Memory(seen=before, since={"all": before}, next_at={"all": before})
    KeptValues(household / "plans.json", print).write(plans)
    KeptValues(household / "agenda.json", print).write(agenda)


def require_held(start: Callable[[], Program], household: Path) -> None:
    """Engage the stop, kill the robot, start it anew: it is held, and its plan waits for that."""
    robot = start()
    page = page_of(robot)
    state_of(page)
    page.send("emergency_stop", {"reason": REASON})
    os.kill(robot.process.pid, signal.SIGKILL)
    robot.ends(20.0)
    let_a_plan_be_due(household)
    page = page_of(start())
    began = state_of(page)
    wait_until(lambda: waiting(page) == [HELD], 30.0, lambda: f"its plan waits: {waiting(page)}")
    assert state_of(page)["held"] == REASON
    wait_until(lambda: state_of(page)["time"] > began["time"] + 2.0, 30.0, "its time passes")
    now = state_of(page)
    assert now["held"] == REASON
    assert math.dist(now["pose"][:2], began["pose"][:2]) < 0.02
    page.send("release")
    wait_until(
        lambda: state_of(page)["plans"]["running"] == "all",
        60.0,
        lambda: f"the plan begins: {state_of(page)['plans']}",
    )
    assert state_of(page)["held"] == ""


def test_a_killed_play_is_held_when_it_is_started_anew(tmp_path: Path) -> None:
    household = tmp_path / "household"
    environment = {**os.environ, "ROOMBA_HOUSEHOLD": str(household)}
    program = (sys.executable, "-m", "roomba.commands.program", "play", "--home", "studio")
    command = (*program, "--port", "0", "--no-open")
    started: list[Program] = []

    def start() -> Program:
        started.append(Program(command, environment, tmp_path / f"{len(started)}.log"))
        return started[-1]

    try:
        require_held(start, household)
    finally:
        for each in started:
            each.clean_up()


def test_a_killed_run_is_held_when_it_is_started_anew(tmp_path: Path) -> None:
    household = tmp_path / "household"
    with RosGraph(tmp_path) as graph:
        graph.environment["ROOMBA_HOUSEHOLD"] = str(household)
        arguments = (f"home:={tiny_home(tmp_path)}", "page:=true", "page_port:=0")
        require_held(lambda: graph.start_run(*arguments), household)
