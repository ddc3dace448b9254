"""What keys mean on the page: on the map, beside a card, behind a dialog, and held down."""

from __future__ import annotations

import pytest
from fixtures.waiting import wait_until
from playwright.sync_api import Page, Request
from web.conftest import SIZES, Opened
from web.test_page import DEADLINE

from roomba.clean_request import CleanRequest
from roomba.client.view import ZoneView

DESKTOP = pytest.mark.parametrize("size", [SIZES["desktop"]])
LOOK_AT = """async ([x, y]) => {
    const { view } = await import("/map/view.js"), { grid } = await import("/map/grids.js");
    Object.assign(view, { x, y, isFitted: true });
    return Boolean(grid("map"));
}"""
PAUSE_LATE = """async () => {
    const { get, set } = await import("/store.js"), state = get("state");
    const { pauseOrResume } = await import("/panels/actions.js");
    set("state", { ...state, vacuum: { ...state.vacuum, phase: "cleaning" } });
    await pauseOrResume();
    return document.getElementById("refusal").hidden;
}"""
"""Presses “Pause” before the page hears that the robot is paused."""
PRESS_TWICE = "button => { button.click(); button.click(); }"
FOCUSED = "() => document.activeElement.textContent || document.activeElement.id"


def wishes_of(page: Page) -> list[str]:
    """Return a list in which all that the page will ask the robot for appears."""
    asked: list[str] = []

    def note(request: Request) -> None:
        if request.method != "GET":
            asked.append(request.url.rsplit("/", 1)[1])

    page.on("request", note)
    return asked


def clean_all(opened: Opened) -> None:
    """Let it clean, and no longer stand on its station."""
    opened.robot.clean(CleanRequest())
    opened.wait_for_phase("cleaning")


@DESKTOP
def test_enter_on_the_map_asks_before_the_robot_goes(opened: Opened) -> None:
    page, asked = opened.page, wishes_of(opened.page)
    room = opened.robot.home().rooms[0]
    wait_until(lambda: page.evaluate(LOOK_AT, room.anchor), DEADLINE, "the map")
    page.locator("#floor").focus()
    page.keyboard.down("Enter")
    page.keyboard.down("Enter")
    page.keyboard.up("Enter")
    assert page.inner_text("#offer-title").lower() == room.name
    assert page.evaluate(FOCUSED) == "Go here"
    assert asked == []
    # While it stands the key that stops it closes the card first.
    page.keyboard.press("Escape")
    assert page.is_hidden("#offer")
    assert page.evaluate(FOCUSED) == "floor"
    page.keyboard.press("Enter")
    page.keyboard.press("Enter")
    wait_until(lambda: asked == ["go"], DEADLINE, lambda: f"one wish, not {asked}")
    page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")


def test_space_pauses_once_also_after_a_room_was_tapped(opened: Opened) -> None:
    page = opened.page
    clean_all(opened)
    opened.tap(*opened.robot.home().rooms[0].anchor)
    page.locator("#offer").wait_for()
    asked = wishes_of(page)
    page.keyboard.down(" ")
    opened.wait_for_phase("paused")
    page.keyboard.down(" ")
    page.keyboard.up(" ")
    page.keyboard.press("+")
    assert asked == ["pause"]


def test_a_double_click_on_pause_pauses_once(opened: Opened) -> None:
    page = opened.page
    clean_all(opened)
    asked = wishes_of(page)
    page.locator("#pause").dblclick()
    opened.wait_for_phase("paused")
    assert asked == ["pause"]
    assert page.is_hidden("#refusal")


@DESKTOP
def test_escape_lets_go_of_a_zone_before_it_stops_a_robot_that_stands(opened: Opened) -> None:
    page, asked = opened.page, wishes_of(opened.page)
    opened.robot.put_zone(ZoneView("Zone 1", "no-go", ((1, 1), (2, 1), (2, 2), (1, 2))))
    pick = page.get_by_role("button", name="Move Zone 1", exact=True)
    pick.click()
    page.keyboard.press("Escape")
    assert pick.get_attribute("aria-pressed") == "false"
    assert asked == []
    # What moves is stopped at once.
    pick.click()
    clean_all(opened)
    page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")
    assert pick.get_attribute("aria-pressed") == "false"


@DESKTOP
def test_a_robot_that_is_paused_already_is_as_it_was_wished(opened: Opened) -> None:
    clean_all(opened)
    opened.robot.pause()
    opened.wait_for_phase("paused")
    assert opened.page.evaluate(PAUSE_LATE)
    assert opened.phase() == "paused"


@DESKTOP
def test_a_room_is_split_by_keys_and_the_hint_tells_how(opened: Opened) -> None:
    page = opened.page
    page.keyboard.press("1")
    page.locator("#split").press("Enter")
    assert page.evaluate(FOCUSED) == "floor"
    assert "With keys: Enter begins" in page.inner_text("#hint")
    page.keyboard.press("Delete")
    assert page.is_hidden("#hint")
    page.get_by_role("button", name="No-go zone").press("Enter")
    assert "With keys: Enter begins" in page.inner_text("#hint")


def test_in_a_dialog_it_can_be_stopped(opened: Opened) -> None:
    page = opened.page
    page.keyboard.press("?")
    page.locator("#keys").get_by_role("button", name="Stop now").click()
    opened.wait_for_phase("emergency stop")
    page.locator("#keys").get_by_role("button", name="Release").click()
    page.wait_for_selector("body[data-held=no]")
    page.get_by_role("button", name="Close").click()
    page.keyboard.press("1")
    opened.show("rooms")
    page.get_by_role("button", name="Rename").click()
    assert page.evaluate(FOCUSED) == "ask-text"
    assert page.locator("#ask").get_by_role("button", name="Stop now").is_visible()
    # A name that is none is told, and not taken for a no.
    page.locator("#ask-text").fill(" ")
    page.locator("#ask").get_by_role("button", name="OK").click()
    assert page.locator("#ask").is_visible()
    page.locator("#ask").get_by_role("button", name="Cancel").click()
    assert page.locator("#ask").is_hidden()


def test_no_action_is_asked_for_twice(opened: Opened) -> None:
    page, asked = opened.page, wishes_of(opened.page)
    page.locator("#clean").dblclick()
    opened.wait_for_phase("cleaning")
    # Nor by keys or programs, which know no double click.
    page.locator("#pause").evaluate(PRESS_TWICE)
    opened.wait_for_phase("paused")
    page.locator("#stop").evaluate(PRESS_TWICE)
    opened.wait_for_phase("idle")
    assert asked == ["clean", "pause", "stop"]
    assert page.is_hidden("#ask")
    # An emergency stop is never held back.
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    wait_until(lambda: asked[3:] == ["emergency_stop"] * 2, DEADLINE, lambda: f"two, not {asked}")


def test_a_double_click_on_the_emergency_stop_releases_nothing(opened: Opened) -> None:
    page, asked = opened.page, wishes_of(opened.page)
    page.locator("#clean").click()
    opened.wait_for_phase("cleaning")
    stop = page.get_by_role("button", name="Stop now")
    stop.click()
    opened.wait_for_phase("emergency stop")
    # The second click of two comes when the button reads "Release" already.
    page.get_by_role("button", name="Release").evaluate(
        "button => button.dispatchEvent(new MouseEvent('click', { bubbles: true, detail: 2 }))"
    )
    wait_until(lambda: len(asked) == 3, DEADLINE, lambda: f"three wishes, not {asked}")
    assert asked == ["clean", "emergency_stop", "emergency_stop"]


def test_the_next_wish_takes_an_old_refusal_away(opened: Opened) -> None:
    page = opened.page
    page.evaluate("async () => (await import('/link.js')).wish('resume')")
    page.locator("#refusal").wait_for()
    page.locator("#clean").click()
    assert page.is_hidden("#refusal")
    opened.wait_for_phase("cleaning")
