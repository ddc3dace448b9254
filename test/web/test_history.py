"""The history on the page: a run of the robot appears, is reported, compared, and seen again."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from fixtures.pages.windows import Windows
from fixtures.waiting import wait_until
from playwright.sync_api import Route
from unit.history.made import made_figures, made_recording
from web.conftest import EACH_SIZE, SIZES, Opened, page_at, serving
from web.test_page import DEADLINE, check_it_can_be_read

from roomba.commands.play.living import live_client
from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper
from roomba.history.run import RunSource
from roomba.history.unfinished import INTERRUPTED, WHY
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token


@pytest.fixture
def history(tmp_path: Path) -> History:
    """Two runs of a box, of which one can be seen again."""
    history = History(tmp_path)
    history.add(made_figures())
    history.add(made_figures(), made_recording())
    return history


@pytest.fixture
def opened(windows: Windows, history: History, size: tuple[int, int]) -> Iterator[Opened]:
    """The page of a live robot, whose runs are kept."""
    robot = live_client("studio", seed=1, speed=10.0, knows_map=True)
    keeper = HistoryKeeper(history, RunSource("play", "studio", 1), lambda text: pytest.fail(text))
    guard = Guard(new_token())
    robot.start()
    with (
        serving(create_app(robot, guard, keeper)) as server,
        page_at(windows, f"{server.address}#token={guard.token}", size) as page,
    ):
        opened = Opened(page, robot, server, guard)
        opened.wait_for_phase("docked")
        yield opened
    robot.end()


def test_a_run_that_ended_is_looked_back_at(opened: Opened, history: History) -> None:
    page = opened.page
    page.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("cleaning")
    opened.show("more")
    page.locator("#charts summary").click()
    page.wait_for_function(
        """() => {
            const points = document.querySelector("#chart-speed .line")?.getAttribute("points");
            return (points ?? "").split(" ").length > 5;
        }"""
    )
    assert "m/s" in page.inner_text("#chart-speed-title")
    began, now = page.locator("#chart-speed text").all_text_contents()[-2:]
    assert (began[-5:], now) == ("s ago", "now")
    page.get_by_role("button", name="Stop", exact=True).click()
    wait_until(lambda: len(history.runs()) == 3, DEADLINE, "the run in the history")
    page.get_by_role("button", name="History").click()
    rows = page.locator("#history-runs tr")
    rows.nth(2).wait_for()
    kept = history.runs()[0]
    assert kept.figures.outcome == "stopped"
    assert rows.first.locator("td").nth(1).inner_text() == str(kept.number)
    assert rows.first.locator("td").nth(3).inner_text() == "studio"
    assert page.locator("#history-weeks tr").count() == 2
    page.get_by_role("link", name=f"Replay run {kept.number}").click()
    page.wait_for_selector("#timeline:not([hidden])")
    assert page.inner_text("#headline").startswith("Recorded: ")
    page.get_by_role("link", name="Back to the robot").click()
    page.wait_for_selector("body[data-replay=no][data-link=live]")


def test_a_run_that_was_interrupted_before_the_start_is_the_last_one(
    windows: Windows, history: History, size: tuple[int, int]
) -> None:
    robot = live_client("studio", seed=1, speed=10.0, knows_map=True)
    source = RunSource("play", "studio", 1)
    cut = replace(made_figures(), source=source, outcome=INTERRUPTED, message=WHY)
    history.add(cut)
    keeper = HistoryKeeper(history, source, lambda text: pytest.fail(text))
    robot.start()
    with (
        serving(create_app(robot, Guard(new_token()), keeper)) as server,
        page_at(windows, server.address, size) as page,
    ):
        page.wait_for_selector("#last:not([hidden])", state="attached")
        assert (page.text_content("#last-text") or "").startswith("Interrupted")
        told = page.inner_text("#explanation")
        assert told.startswith("Last run: interrupted")
        assert told.endswith("Clean again what is left.")
    robot.end()


@pytest.mark.parametrize("size", [SIZES["phone"]])
def test_the_way_back_closes_what_is_open_and_comes_back_to_it(opened: Opened) -> None:
    page = opened.page
    opened.show("more")
    page.get_by_role("button", name="History").click()
    page.get_by_role("link", name="Replay run 2").click()
    page.wait_for_selector("#timeline:not([hidden])")
    page.go_back()
    page.locator("#history").wait_for()
    page.go_back()
    page.locator("#history").wait_for(state="hidden")
    opened.wait_for_phase("docked")
    opened.show("more")
    page.get_by_role("button", name="Keys").click()
    page.go_back()
    page.wait_for_selector("#keys:not([open])", state="attached")
    assert page.locator("[data-tab=more]").get_attribute("aria-expanded") == "true"
    page.go_back()
    page.locator("[data-tab=more][aria-expanded=false]").wait_for()
    page.locator("[data-tab=more]").click()
    page.locator("[data-tab=more]").click()
    page.go_back()  # nothing is open: the page is left
    page.wait_for_url("about:blank")


@EACH_SIZE
def test_all_of_a_run_is_seen(opened: Opened) -> None:
    page = opened.page
    opened.show("more")
    page.get_by_role("button", name="History").click()
    page.get_by_role("link", name="Replay run 2").wait_for()
    beyond = "parts => parts.filter(part => part.scrollWidth > part.clientWidth).length"
    assert page.locator(".history .wide").evaluate_all(beyond) == 0


def test_reports_open_and_two_are_compared(opened: Opened) -> None:
    page = opened.page
    opened.show("more")
    page.get_by_role("button", name="History").click()
    with page.context.expect_page() as shown:
        page.get_by_role("link", name="Report of run 2").click()
    report = shown.value
    assert report.inner_text("h1").startswith("Run 2: box")
    background = "() => getComputedStyle(document.querySelector('section')).borderRadius"
    assert report.evaluate(background) == "8px"
    compare = page.get_by_role("button", name="Compare two")
    assert compare.is_disabled()
    page.get_by_role("checkbox", name="Compare run 1").check()
    page.get_by_role("checkbox", name="Compare run 2").check()
    page.locator("#history-home").select_option("box")  # another home of the chart
    assert page.locator("#history-runs input:checked").count() == 2
    with page.context.expect_page() as shown:
        compare.click()
    assert shown.value.inner_text("h1") == "Runs 1 and 2 compared"
    assert page.locator("#history-dirt .mark").count() == 2
    page.get_by_role("button", name="Back to the map").press("Enter")
    assert not page.locator("#history").is_visible()
    assert page.evaluate("() => document.activeElement.id") == "history-open"


def test_older_runs_are_shown_as_they_are_asked_for(opened: Opened) -> None:
    page = opened.page

    def one_at_a_time(route: Route) -> None:
        url = route.request.url
        route.continue_(url=f"{url}{'&' if '?' in url else '?'}limit=1")

    page.route(re.compile(r"/api/v1/history(\?|$)"), one_at_a_time)
    opened.show("more")
    page.get_by_role("button", name="History").click()
    page.get_by_role("checkbox", name="Compare run 2").check()
    page.get_by_role("button", name="Older runs").click()
    page.get_by_role("checkbox", name="Compare run 1").wait_for()
    assert page.evaluate("document.activeElement.ariaLabel") == "Compare run 1"
    assert page.get_by_role("checkbox", name="Compare run 2").is_checked()
    assert page.get_by_role("button", name="Older runs").is_hidden()
    assert page.locator("#history-dirt .mark").count() == 2


def test_keys_do_nothing_behind_it(opened: Opened) -> None:
    page = opened.page
    opened.show("more")
    page.get_by_text("Drive by hand", exact=True).click()
    page.get_by_role("button", name="History").click()
    page.locator("#history-runs tr").first.wait_for()
    assert page.locator("#history-runs").get_by_text("1 place", exact=True).count() == 2
    before = opened.robot.robot().pose
    page.locator("#history-close").focus()
    page.keyboard.press("1")
    page.keyboard.press("?")
    page.keyboard.down("ArrowUp")
    assert page.locator("#rooms [aria-pressed=true]").count() == 0
    assert page.is_hidden("#keys")
    time = opened.robot.robot().time
    wait_until(lambda: opened.robot.robot().time > time + 3.0, DEADLINE, "time to pass")
    page.keyboard.up("ArrowUp")
    assert opened.robot.robot().pose[:2] == pytest.approx(before[:2], abs=0.05)


def test_it_can_be_read_and_touched(opened: Opened) -> None:
    page = opened.page
    opened.show("more")
    page.get_by_role("button", name="History").click()
    page.locator("#history-runs tr").first.wait_for()
    check_it_can_be_read(page)
