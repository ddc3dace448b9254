"""The page shows states of the robot and of the link as they are."""

from __future__ import annotations

import threading

import pytest
from fixtures.households.written_robot import WrittenRobot
from fixtures.pages.windows import Windows
from fixtures.waiting import wait_until
from web.conftest import SIZES, Opened, page_at, serving
from web.test_page import DEADLINE

from roomba.client.protocol import RobotUnavailableError
from roomba.client.view import PageLimits
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token

WATCH = """async () => {
    const { grid } = await import("/map/grids.js");
    window.known = new Set();
    setInterval(() => {
        const cells = grid("map")?.cells;
        if (cells) window.known.add(cells.reduce((sum, value) => sum + (value > 0), 0));
    }, 50);
}"""
"""Collects how many cells of the map were known, all the time."""


@pytest.mark.parametrize("home", ["studio"])
@pytest.mark.parametrize("speed", [20.0])
@pytest.mark.parametrize("knows_map", [False])
def test_without_a_map_it_explores_and_the_map_is_seen_growing(opened: Opened) -> None:
    page = opened.page
    page.wait_for_selector("#no-map:not([hidden])")
    page.evaluate(WATCH)
    page.get_by_role("button", name="Explore").click()
    opened.wait_for_phase("exploring")
    opened.wait_for_phase("docked")
    assert page.is_hidden("#no-map")
    known = page.evaluate("[...window.known]")
    assert len(known) > 3
    assert known[-1] > 1.5 * min(count for count in known if count > 0)
    wait_until(lambda: opened.robot.home().rooms != (), DEADLINE, "rooms")
    opened.show("rooms")
    page.locator("#rooms .name").first.wait_for()


@pytest.mark.parametrize("home", ["studio"])
@pytest.mark.parametrize("bin_grams", [1.0])
@pytest.mark.parametrize("speed", [30.0])
def test_a_full_bin_is_said_with_what_to_do(opened: Opened) -> None:
    page = opened.page
    page.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("bin full")
    assert page.inner_text("#headline") == "Its dust bin is full"
    assert "Empty the dust bin" in page.inner_text("#explanation")
    page.get_by_role("button", name="Bin emptied").click()
    page.wait_for_selector("body:not([data-phase='bin full'])")


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_a_robot_that_tells_nothing_is_stale_comes_back_and_is_gone(opened: Opened) -> None:
    page, goes_on = opened.page, threading.Event()
    held = threading.Thread(target=lambda: opened.robot.ask(lambda _: goes_on.wait(20.0)))
    held.start()
    try:
        page.wait_for_selector("body[data-link='stale']")
        # Screen readers tell it once, and not each second.
        assert page.inner_text("#explanation") == "No news: what is shown is old."
        page.locator("#old").get_by_text("It was heard 3 s ago.").wait_for()
        assert page.inner_text("#explanation") == "No news: what is shown is old."
        assert page.locator("[role=status] #old, [aria-live] #old").count() == 0
        for name in ("Clean all", "Dock"):
            assert page.get_by_role("button", name=name).is_disabled()
        assert page.get_by_role("button", name="Stop now").first.is_enabled()
    finally:
        goes_on.set()
        held.join()
    page.wait_for_selector("body[data-link='live']")
    opened.robot.end()
    page.wait_for_selector("body[data-link='gone']")
    assert page.inner_text("#headline") == "The robot does not answer"
    assert "Last seen at" in page.inner_text("#explanation")
    assert page.get_by_role("button", name="Clean all").is_disabled()


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_the_drive_is_not_released_by_an_old_look(opened: Opened) -> None:
    page, goes_on = opened.page, threading.Event()
    page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")
    release = page.get_by_role("button", name="Release")
    assert release.is_enabled()
    held = threading.Thread(target=lambda: opened.robot.ask(lambda _: goes_on.wait(20.0)))
    held.start()
    try:
        page.wait_for_selector("body[data-link='stale']")
        # Another page may have released it meanwhile: what is offered is to stop.
        assert not release.is_visible()
        assert page.get_by_role("button", name="Stop now").is_enabled()
    finally:
        goes_on.set()
        held.join()
    release.click()
    page.wait_for_selector("body[data-held=no]")


class LateRobot(WrittenRobot):
    """Tells not even its limits while it is gone."""

    def limits(self) -> PageLimits:
        if self.is_gone:
            raise RobotUnavailableError("it begins to live")
        return super().limits()


def test_what_a_robot_that_comes_late_offers_is_known_then(windows: Windows) -> None:
    robot, guard = LateRobot(), Guard(new_token())
    robot.is_gone = True
    with (
        serving(create_app(robot, guard)) as server,
        page_at(windows, f"{server.address}#token={guard.token}", SIZES["desktop"]) as page,
    ):
        page.wait_for_selector("body[data-link='gone']")
        robot.is_gone = False
        page.wait_for_selector("body[data-link='live']")
        page.locator(".how").wait_for()
        page.locator("#charts").evaluate("charts => { charts.open = true; }")
        page.locator("#chart-battery-title", has_text="Battery: not known").wait_for()
