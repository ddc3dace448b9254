"""The household over HTTP, in the robot's state, and live."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from fixtures.households.written_robot import VIEW, WrittenRobot
from fixtures.waiting import wait_until

from roomba.client.household import TotalsView
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.commands.play.living import live_client
from roomba.configuration.household import HouseholdConfig
from roomba.household.household import LiveHousehold
from roomba.household.local_zone import LocalZone
from roomba.plans.plan import Plan, PlannedOrder, Preset, QuietHours
from roomba.ui.state_words import lines_of
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.vocabulary import CleanMode

DEADLINE = 30.0
"""s of wall time."""
AUTHORISED = {"Authorization": "Bearer token"}
NOW = [dt.datetime(2026, 3, 2, 6, 0, tzinfo=dt.timezone.utc)]
"""The time of the household; a test may set it."""
TOTALS = TotalsView(3, 30.5, 3600.0, 900.0, 12.0, 20.0)


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def household(robot: WrittenRobot, tmp_path: Path) -> LiveHousehold:
    config = HouseholdConfig()
    return LiveHousehold(
        robot,
        tmp_path,
        config,
        100.0,
        lambda text: pytest.fail(text),
        lambda: TOTALS,
        now=lambda: NOW[0],
        period=0.02,
    )


def kept(robot: WrittenRobot, folder: Path, told: list[str], **others: Any) -> LiveHousehold:
    """Return the household in a folder, as a program begins it that writes down what is told."""
    return LiveHousehold(robot, folder, HouseholdConfig(), 100.0, told.append, **others)


@pytest.fixture
def page(robot: WrittenRobot, household: LiveHousehold) -> Iterator[TestClient]:
    app = create_app(robot, Guard("token"), household=household)
    with TestClient(app, base_url="http://127.0.0.1") as client:
        yield client


def work(robot: WrittenRobot, household: LiveHousehold, seconds: float) -> None:
    """Let the robot clean for some time of its clock."""
    for _ in range(round(seconds / 600.0)):
        household.look()
        robot.view = replace(robot.view, time=robot.view.time + 600.0)
    household.look()


def test_hours_left_and_totals_are_told(
    page: TestClient, robot: WrittenRobot, household: LiveHousehold
) -> None:
    work(robot, household, 36_000.0)
    told = page.get("/api/v1/upkeep").json()
    assert told["parts"][2] == {
        "name": "filter",
        "life": 150.0,
        "left": 140.0,
        "share": 0.9333,
        "is_due": False,
        "advice": "",
    }
    assert told["totals"] == {name: getattr(TOTALS, name) for name in TOTALS.__slots__}
    assert told["reminders"] == ["empty the bin, then reset it"]
    state = page.get("/api/v1/state").json()
    assert state["upkeep"] == told
    assert ("upkeep", "empty the bin, then reset it") in lines_of(state)


def test_a_reset_needs_the_token_and_a_part_that_there_is(
    page: TestClient, robot: WrittenRobot, household: LiveHousehold
) -> None:
    work(robot, household, 6000.0)
    path = "/api/v1/upkeep/reset"
    assert page.post(path, json={"part": "filter"}).status_code == 401
    assert page.post(path, json={"part": "lid"}, headers=AUTHORISED).status_code == 422
    assert page.post(path, json={"part": "filter"}, headers=AUTHORISED).json() == {"ok": True}
    left = {each["name"]: each["left"] for each in page.get("/api/v1/upkeep").json()["parts"]}
    assert (left["filter"], left["brush"]) == (150.0, pytest.approx(298.33))


def test_a_bin_that_the_robot_does_not_let_be_emptied_is_not_reset(
    page: TestClient, robot: WrittenRobot
) -> None:
    robot.refusal = "the bin is missing"
    answer = page.post("/api/v1/upkeep/reset", json={"part": "bin"}, headers=AUTHORISED)
    assert (answer.status_code, answer.json()["detail"]) == (409, "the bin is missing")


def test_a_full_disk_is_told_and_a_reset_is_refused(robot: WrittenRobot, tmp_path: Path) -> None:
    told: list[str] = []
    (tmp_path / "file").touch()
    household = kept(robot, tmp_path / "file", told)
    app = create_app(robot, Guard("token"), household=household)
    answer = TestClient(app, base_url="http://127.0.0.1").post(
        "/api/v1/upkeep/reset", json={"part": "filter"}, headers=AUTHORISED
    )
    assert answer.status_code == 409
    assert "not kept" in answer.json()["detail"]
    work(robot, household, 1200.0)
    assert len([text for text in told if "was not kept" in text]) == 1


def test_a_fault_in_a_look_is_told_with_its_place_and_plans_begin_all_the_same(
    robot: WrittenRobot, tmp_path: Path
) -> None:
    told: list[str] = []

    def faulty() -> TotalsView:
        raise ZeroDivisionError("a fault")

    robot.view = replace(VIEW, vacuum=replace(VIEW.vacuum, state="docked", phase="docked"))
    now = [NOW[0]]
    household = kept(robot, tmp_path, told, totals=faulty, now=lambda: now[0])
    household.put_plan(Plan(name="daily", at=(dt.time(9),)))
    household.start()
    try:
        now[0] = NOW[0].replace(hour=9)
        wait_until(lambda: "clean" in [name for name, _ in robot.told], DEADLINE, "the plan begun")
    finally:
        household.stop()
    (fault,) = told
    assert "ZeroDivisionError: a fault" in fault
    assert "in faulty" in fault


def test_a_clock_that_is_not_set_is_told(robot: WrittenRobot, tmp_path: Path) -> None:
    told, now = list[str](), [dt.datetime(1970, 1, 1, tzinfo=dt.timezone.utc)]
    household = kept(robot, tmp_path, told, now=lambda: now[0])
    household.look()
    household.look()
    now[0] = NOW[0]
    household.look()
    assert len(told) == 1
    assert "got 1970-01-01: plans wait" in told[0]


def test_a_zone_that_is_a_guess_is_told_until_another_one_is_set(
    robot: WrittenRobot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "roomba.household.household.local_zone", lambda: LocalZone("UTC", "expected a zone")
    )
    told: list[str] = []
    kept(robot, tmp_path, told).set_zone("Europe/Berlin")
    kept(robot, tmp_path, told)
    assert told == ["expected a zone: plans go by the hours of UTC; set the zone on the page"]


def test_it_looks_by_itself_and_a_robot_that_is_gone_ends_nothing(
    robot: WrittenRobot, household: LiveHousehold
) -> None:
    robot.is_gone = True
    household.look()
    robot.is_gone = False
    household.start()
    robot.view = VIEW
    wait_until(lambda: _advanced(robot, household), 10.0, "hours that passed")
    household.stop()


def _advanced(robot: WrittenRobot, household: LiveHousehold) -> bool:
    robot.view = replace(robot.view, time=robot.view.time + 1.0)
    return household.upkeep().parts[0].share < 1.0


def test_a_full_bin_sounds_once_and_not_in_quiet_hours(
    robot: WrittenRobot, household: LiveHousehold
) -> None:
    household.set_zone("UTC")
    household.set_quiet([QuietHours(begins=dt.time(5, 0), ends=dt.time(7, 0))])
    work(robot, household, 1200.0)
    robot.view = replace(robot.view, dirt=100.0)
    household.look()
    assert household.upkeep().parts[4].is_due
    assert robot.told == []
    household.set_quiet([])
    household.look()
    household.look()
    assert robot.told == [("locate", ())]
    robot.view = replace(robot.view, dirt=0.0)
    household.look()
    robot.view = replace(robot.view, dirt=100.0)
    household.look()
    assert robot.told == [("locate", ())] * 2


class Life:
    """A robot in the studio whose household goes by its clock, a hundred times as fast as ours."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.begin = folder, dt.datetime(2026, 3, 2, 8, 59, tzinfo=dt.timezone.utc)
        self.robot = live_client("studio", seed=1, speed=100.0, knows_map=True)
        self.robot.start()
        wait_until(lambda: self.phase() == "docked", DEADLINE, "the robot on its station")
        self.live()

    def live(self) -> None:
        """Begin the program of the household, anew if it ran before."""
        self.household = LiveHousehold(
            self.robot,
            self.folder,
            HouseholdConfig(),
            100.0,
            lambda text: pytest.fail(text),
            now=self.now,
            period=0.02,
        )
        self.household.start()

    def now(self) -> dt.datetime:
        return self.begin + dt.timedelta(seconds=self.robot.robot().time)

    def phase(self) -> str:
        try:
            return self.robot.robot().vacuum.phase
        except RobotUnavailableError:
            return ""

    def texts(self) -> list[str]:
        return [note.text for note in self.household.plans().notes]

    def wait_for(self, text: str, count: int = 1) -> None:
        """Wait until it is noted so often that begins so."""
        wait_until(lambda: self.noted(text) >= count, DEADLINE, f"{text} in {self.texts()}")

    def noted(self, text: str) -> int:
        return len([each for each in self.texts() if each.startswith(text)])


def test_plans_over_the_headless_robot(tmp_path: Path) -> None:
    life = Life(tmp_path)
    try:
        life.household.set_zone("UTC")
        edges = PlannedOrder(mode=CleanMode.EDGES)
        life.household.set_quiet([QuietHours(begins=dt.time(8, 0), ends=dt.time(9, 5))])
        life.household.put_plan(Plan(name="edges", at=(dt.time(9, 0),), order=edges))
        # It is due, the hours are quiet, and once they are over it begins.
        life.wait_for("waits: quiet hours until 09:05")
        assert life.phase() == "docked"
        life.wait_for("began")
        assert life.now().time() >= dt.time(9, 5)
        life.wait_for("done: ")
        assert life.household.upkeep().parts[0].share < 1.0
        # What was missed while the program did not run is made up for when it runs again.
        wait_until(lambda: life.phase() == "docked", DEADLINE, "the robot on its station")
        life.household.stop()
        life.begin += dt.timedelta(days=1, hours=6)
        life.live()
        life.wait_for("missed: ")
        life.wait_for("began", 2)
        wait_until(lambda: life.phase() == "cleaning", DEADLINE, "the robot cleans again")
        assert life.household.plans().running == "edges"
        life.robot.stop()
        life.wait_for("stopped by hand")
    finally:
        life.household.stop()
        life.robot.end()


def test_plans_and_presets_follow_the_names_of_rooms(tmp_path: Path) -> None:
    life = Life(tmp_path)
    try:
        home, household = life.robot, life.household
        first = home.home().rooms[0]
        x, y = first.anchor
        home.split_room(first.name, (x - 20.0, y), (x + 20.0, y))
        one, other = (room.name for room in home.home().rooms[:2])
        order = PlannedOrder(mode=CleanMode.ROOMS, rooms=(one, other))
        household.put_plan(Plan(name="daily", at=(dt.time(9, 30),), order=order))
        household.put_preset(Preset(name="now", order=order))
        due = household.plans().next_at

        def wait_for_rooms(*names: str) -> None:
            planned = life.household.plans
            wait_until(
                lambda: planned().household.plans[0].order.rooms == names, DEADLINE, f"{names}"
            )
            assert planned().household.presets[0].order.rooms == names

        home.rename_room(one, "Den")
        wait_for_rooms("Den", other)
        # Of the same time as before.
        assert household.plans().next_at == due
        life.wait_for(f"goes on by other names of rooms: '{one}' is 'Den'")
        home.undo_rooms()
        wait_for_rooms(one, other)
        home.join_rooms((other, one))
        wait_for_rooms(other)
        home.undo_rooms()
        wait_for_rooms(one, other)
        life.wait_for("has its rooms again")
        # While no household lives, as after a kill.
        life.household.stop()
        home.rename_room(one, "Hall")
        life.live()
        household = life.household
        wait_for_rooms("Hall", other)
        household.begin_preset("now")
        wait_until(lambda: life.phase() == "cleaning", DEADLINE, "the robot cleans")
    finally:
        life.household.stop()
        life.robot.end()


def test_what_names_changed_places_meanwhile_is_followed_before_a_new_order(
    tmp_path: Path,
) -> None:
    life = Life(tmp_path)
    try:
        first = life.robot.home().rooms[0]
        x, y = first.anchor
        life.robot.split_room(first.name, (x - 20.0, y), (x + 20.0, y))
        one, other = (room.name for room in life.robot.home().rooms[:2])
        order = PlannedOrder(mode=CleanMode.ROOMS, rooms=(one,))
        life.household.put_preset(Preset(name="old", order=order))
        for name, new in ((one, "old"), (other, one)):
            life.robot.rename_room(name, new)
        life.household.put_preset(Preset(name="new", order=order))
        rooms = [preset.order.rooms for preset in life.household.plans().household.presets]
        assert rooms == [("old",), (one,)]
    finally:
        life.household.stop()
        life.robot.end()


def test_rooms_that_the_map_does_not_have_are_refused(tmp_path: Path) -> None:
    life = Life(tmp_path)
    try:
        order = PlannedOrder(mode=CleanMode.ROOMS, rooms=("attic",))
        with pytest.raises(RequestRefusedError, match=r"expected rooms of the map.*got 'attic'"):
            life.household.put_plan(Plan(name="daily", order=order))
        with pytest.raises(RequestRefusedError, match=r"expected rooms of the map.*got 'attic'"):
            life.household.put_preset(Preset(name="now", order=order))
        # A plan of another map can be switched off.
        life.household.put_plan(Plan(name="daily", order=order, is_on=False))
    finally:
        life.household.stop()
        life.robot.end()


def test_a_plan_whose_last_day_is_over_is_refused(
    page: TestClient, household: LiveHousehold
) -> None:
    once = {"name": "once", "rule": "FREQ=DAILY;COUNT=1", "begins": "2026-03-01", "at": ["09:30"]}
    answer = page.put("/api/v1/plans", json=once, headers=AUTHORISED)
    assert answer.status_code == 409
    assert "from 2026-03-01 on, whose last day is over; choose a later" in answer.json()["detail"]
    # It may be kept switched off, and today it has a time to come.
    off = page.put("/api/v1/plans", json={**once, "is_on": False}, headers=AUTHORISED)
    assert off.status_code == 200
    today = page.put("/api/v1/plans", json={**once, "begins": "2026-03-02"}, headers=AUTHORISED)
    assert today.status_code == 200
    assert household.plans().plans[0].name == "once"


def test_a_second_program_with_the_same_household_is_told(
    robot: WrittenRobot, tmp_path: Path
) -> None:
    told: list[str] = []
    first, second = kept(robot, tmp_path, told), kept(robot, tmp_path, told)
    first.start()
    try:
        assert not told
        second.start()
        second.stop()
        assert [text for text in told if "keeps this household as well" in text]
    finally:
        first.stop()
    told.clear()
    third = kept(robot, tmp_path, told)
    third.start()
    third.stop()
    assert not told
