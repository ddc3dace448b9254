"""The household on the page: what is worn is told and reset, plans are made and changed there."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.pages.windows import Windows
from fixtures.waiting import wait_until
from web.conftest import Opened, page_at, served_instead, serving
from web.test_page import DEADLINE, check_it_can_be_read

from roomba.client.household import TotalsView
from roomba.commands.play.living import live_client
from roomba.configuration.household import HouseholdConfig, UpkeepConfig
from roomba.household.household import LiveHousehold
from roomba.plans.plan import Plan
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token

WORN = UpkeepConfig(sensors=0.001)
"""Sensors that are due after 3.6 s of work."""


@pytest.fixture
def household(tmp_path: Path) -> Iterator[LiveHousehold]:
    """That of a robot that is not started yet."""
    robot = live_client("studio", seed=1, speed=10.0, knows_map=True)
    config = HouseholdConfig(upkeep=WORN)
    household = LiveHousehold(
        robot,
        tmp_path,
        config,
        100.0,
        lambda text: pytest.fail(text),
        lambda: TotalsView(12, 340.0, 9000.0, 2500.0, 40.0, 60.0),
    )
    robot.start()
    yield household
    robot.end()


@pytest.fixture
def opened(windows: Windows, household: LiveHousehold, size: tuple[int, int]) -> Iterator[Opened]:
    """The page of a live robot in its household."""
    guard = Guard(new_token())
    household.start()
    with (
        serving(create_app(household.robot, guard, household=household)) as server,
        page_at(windows, f"{server.address}#token={guard.token}", size) as page,
    ):
        opened = Opened(page, household.robot, server, guard)  # type: ignore[arg-type]
        opened.wait_for_phase("docked")
        yield opened
    household.stop()


def test_what_is_worn_is_told_and_reset(opened: Opened, household: LiveHousehold) -> None:
    page = opened.page
    page.get_by_role("button", name="Clean all").click()
    opened.show("more")
    page.wait_for_selector("#upkeep-due:not([hidden])", timeout=30_000)
    assert "Wipe the sensors" in page.inner_text("#upkeep-reminders")
    page.get_by_role("button", name="Stop", exact=True).click()
    page.locator("#upkeep summary").click()
    assert page.inner_text("#upkeep summary") == "Upkeep: 1 due"
    assert page.locator("#upkeep-parts li").count() == 5
    assert "12 runs, 340 m², 2 h 30 min, 2.50 km, 40 g" in page.inner_text("#upkeep-totals")
    check_it_can_be_read(page)
    page.get_by_role("button", name="Reset the sensors").click()
    page.locator("#ask").get_by_role("button", name="OK").click()
    page.wait_for_selector("#upkeep-due", state="hidden")
    wait_until(lambda: household.upkeep().parts[3].share > 0.0, DEADLINE, "sensors as new")
    assert household.upkeep().parts[0].share < 1.0


def test_a_plan_is_made_changed_and_removed(opened: Opened, household: LiveHousehold) -> None:
    page, form = opened.page, opened.page.locator("#plan-form")
    opened.show("more")
    page.locator("#plans summary").click()
    page.get_by_role("button", name="New plan …").click()
    form.get_by_label("Name").fill("Mornings")
    for day in ("Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"):
        form.get_by_label(day).uncheck()
    form.get_by_role("button", name="Save").click()
    assert form.get_by_role("alert").inner_text() == "Choose at least one day."
    form.get_by_label("Name").fill(" ")
    form.get_by_role("button", name="Save").click()
    assert form.get_by_role("alert").inner_text() == "Give it a name."
    form.get_by_label("Name").fill("Mornings")
    form.get_by_label("Or days by a rule").fill("FREQ=MONTHLY;BYDAY=1SA")
    for day in ("Mon", "Thu"):
        form.get_by_label(day).check()
    assert form.get_by_label("Or days by a rule").input_value() == ""
    form.get_by_label("Times").fill("9:30, 18:00")
    form.get_by_label("What").select_option("rooms")
    room = household.robot.home().rooms[0].name
    form.get_by_label(room, exact=True).check()
    form.get_by_label("Passes").select_option("2")
    form.get_by_label("Only rooms that are due").check()
    form.get_by_role("button", name="Save").click()
    page.locator("#plan-list li").wait_for()
    need = f"{room}: each time; how fast it becomes dirty is not known yet."
    page.locator("#need-list").get_by_text(need).wait_for()
    (plan,) = household.plans().household.plans
    assert plan.rule == "FREQ=WEEKLY;BYDAY=MO,TH"
    assert [time.isoformat("minutes") for time in plan.at] == ["09:30", "18:00"]
    assert (plan.order.rooms, plan.order.passes, plan.order.only_due) == ((room,), 2, True)
    about = f"Mon, Thu at 09:30, 18:00 · {room}, only rooms that are due, 2 ×, standard"
    assert page.inner_text("#plan-list .about") == about
    page.get_by_text("Next: Mornings").wait_for()
    page.get_by_role("button", name="Edit Mornings").click()
    assert form.get_by_label("Thu").is_checked()
    assert not form.get_by_label("Fri").is_checked()
    form.get_by_label("Times").fill("nine")
    form.get_by_role("button", name="Save").click()
    form.get_by_role("alert").wait_for()
    assert "time" in form.get_by_role("alert").inner_text()
    assert len(household.plans().household.plans[0].at) == 2
    assert form.get_by_label("Times").input_value() == "nine"
    form.get_by_role("button", name="Cancel").click()
    page.get_by_role("button", name="Mornings: on").click()
    wait_until(lambda: household.plans().next == "", DEADLINE, "a plan that is off")
    page.get_by_label("Begins on").select_option("rest")
    page.locator("#quiet-add").click()
    page.get_by_text("Sat, Sun").wait_for()
    page.get_by_label("A person is at home now").check()
    wait_until(lambda: household.plans().household.is_person_home, DEADLINE, "a person")
    assert len(household.plans().household.quiet) == 1
    page.get_by_role("button", name="Time zone …").click()
    page.locator("#ask-text").fill("Nowhere")
    page.locator("#ask").get_by_role("button", name="OK").click()
    page.locator("#ask-fault").get_by_text("zone").wait_for()
    page.locator("#ask-text").fill("Asia/Tokyo")
    page.locator("#ask").get_by_role("button", name="OK").click()
    page.get_by_text("Times are those of Asia/Tokyo").wait_for()
    check_it_can_be_read(page)
    page.get_by_role("button", name="Remove Mornings").click()
    page.locator("#ask").get_by_role("button", name="OK").click()
    wait_until(lambda: not household.plans().household.plans, DEADLINE, "a plan that is gone")


def test_a_preset_is_made_and_begun(opened: Opened, household: LiveHousehold) -> None:
    page, form = opened.page, opened.page.locator("#plan-form")
    opened.show("more")
    page.locator("#plans summary").click()
    page.get_by_role("button", name="New preset …").click()
    form.get_by_label("Name").fill("Edges")
    form.get_by_label("What").select_option("edges")
    assert not form.get_by_label("Times").is_visible()
    assert not form.get_by_label("Only rooms that are due").is_visible()
    form.get_by_role("button", name="Save").click()
    page.get_by_role("button", name="Begin Edges").click()
    opened.wait_for_phase("cleaning")
    (preset,) = household.plans().household.presets
    assert preset.order.mode.value == "edges"


def test_plans_of_a_server_that_was_started_anew_are_shown(
    opened: Opened, household: LiveHousehold, tmp_path: Path
) -> None:
    page = opened.page
    household.put_plan(Plan(name="Before", rule="FREQ=DAILY"))
    opened.show("more")
    page.locator("#plans summary").click()
    page.locator("#plan-list").get_by_text("Before").wait_for()
    anew = LiveHousehold(household.robot, tmp_path / "anew", HouseholdConfig(), 100.0, pytest.fail)
    anew.start()
    anew.put_plan(Plan(name="After", rule="FREQ=DAILY"))
    wait_until(lambda: anew.plans().version == household.plans().version, DEADLINE, "one number")
    with served_instead(opened, create_app(household.robot, opened.guard, household=anew)):
        page.locator("#plan-list").get_by_text("After").wait_for()
        assert page.locator("#plan-list li").count() == 1
    anew.stop()


def test_a_new_plan_replaces_none_and_an_edited_one_keeps_its_rule_and_the_focus(
    opened: Opened, household: LiveHousehold
) -> None:
    page, form = opened.page, opened.page.locator("#plan-form")
    rule = "FREQ=WEEKLY;BYDAY=MO;INTERVAL=12"
    household.put_plan(Plan(name="Windows", rule=rule))
    opened.show("more")
    page.locator("#plans summary").click()
    page.get_by_role("button", name="New plan …").click()
    form.get_by_label("Name").fill("Windows")
    form.get_by_role("button", name="Save").click()
    form.get_by_role("alert").get_by_text("that none of the plans has").wait_for()
    assert household.plans().household.plans[0].rule == rule
    form.get_by_role("button", name="Cancel").click()
    page.get_by_role("button", name="Edit Windows").click()
    form.get_by_label("Times").fill("10:00")
    form.get_by_role("button", name="Save").click()
    page.locator("#plan-list").get_by_text("10:00").wait_for()
    assert household.plans().household.plans[0].rule == rule
    page.get_by_role("button", name="Windows: on").focus()
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Windows: off").wait_for()
    assert page.evaluate("() => document.activeElement.ariaLabel") == "Windows: off"
