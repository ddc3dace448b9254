"""Stopping, driving by hand and by keys alone, the camera; without the token nothing changes."""

from __future__ import annotations

import math

from fixtures.waiting import wait_until
from web.conftest import Opened
from web.test_page import DEADLINE

HIDE = """(is_hidden) => {
    Object.defineProperty(document, "hidden", { configurable: true, value: is_hidden });
    const state = is_hidden ? "hidden" : "visible";
    Object.defineProperty(document, "visibilityState", { configurable: true, value: state });
    document.dispatchEvent(new Event("visibilitychange"));
}"""
REFUSES_TO_KEEP = """for (const name of ["sessionStorage", "localStorage"])
    Object.defineProperty(window, name, { get() { throw new Error("refused"); } });
"""


def test_the_emergency_stop_is_a_button_and_a_key(opened: Opened) -> None:
    page = opened.page
    page.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("cleaning")
    page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")
    assert "held" in page.inner_text("#explanation")
    page.get_by_role("button", name="Release").click()
    opened.wait_for_phase("paused")
    page.wait_for_function(
        "() => document.getElementById('explanation').innerText.includes('released')"
    )
    page.get_by_role("button", name="Go on").click()
    opened.wait_for_phase("cleaning")
    page.get_by_role("button", name="Stop now").click()
    opened.wait_for_phase("emergency stop")
    assert "stands until “Go on”" in page.inner_text("#explanation")
    page.get_by_role("button", name="Stop", exact=True).click()
    page.wait_for_function(
        "() => document.getElementById('last-text').innerText.includes('Stopped')"
    )
    assert opened.phase() == "emergency stop"
    # An exploration tells of no floor that is wanted either, and can be stopped.
    assert page.is_enabled("#stop")
    page.get_by_role("button", name="Release").click()
    opened.wait_for_phase("idle")
    # In a dialog the key closes that alone: a robot that is held would refuse to clean.
    page.keyboard.press("?")
    page.wait_for_selector("#keys[open]")
    page.keyboard.press("Escape")
    page.wait_for_selector("#keys:not([open])", state="attached")
    page.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("cleaning")
    page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")


def test_driving_by_hand_lasts_as_long_as_a_key_is_held_and_the_page_is_seen(
    opened: Opened,
) -> None:
    page = opened.page
    page.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("cleaning")
    page.get_by_role("button", name="Pause").click()
    opened.wait_for_phase("paused")
    opened.show("more")
    page.get_by_text("Drive by hand", exact=True).click()
    before = opened.robot.robot().pose
    page.keyboard.down("ArrowLeft")
    wait_until(
        lambda: abs(opened.robot.robot().pose[2] - before[2]) > 0.3, DEADLINE, "a turn to the left"
    )
    page.keyboard.up("ArrowLeft")
    wait_until(lambda: stands(opened), DEADLINE, "the robot to stand")
    page.keyboard.down("ArrowLeft")
    wait_until(lambda: turns(opened), DEADLINE, "a turn")
    page.evaluate(HIDE, True)
    wait_until(lambda: not turns(opened), DEADLINE, "standstill, with the key still down")
    assert stands(opened)
    page.keyboard.up("ArrowLeft")


def stands(opened: Opened) -> bool:
    """Whether the robot turned no more for five of its seconds."""
    one = opened.robot.robot()
    wait_until(lambda: opened.robot.robot().time > one.time + 5.0, DEADLINE, "time to pass")
    return math.isclose(opened.robot.robot().pose[2], one.pose[2], abs_tol=0.02)


def turns(opened: Opened) -> bool:
    """Whether the robot turns just now."""
    return opened.robot.ask(lambda robot: abs(robot.now.twist.angular) > 0.01)


def test_a_page_that_is_closed_while_a_key_is_held_lets_the_robot_stand(opened: Opened) -> None:
    page = opened.page
    opened.show("more")
    page.get_by_text("Drive by hand", exact=True).click()
    before = opened.robot.robot().pose
    page.keyboard.down("ArrowDown")
    wait_until(lambda: math.dist(opened.robot.robot().pose[:2], before[:2]) > 0.2, DEADLINE, "it")
    page.close()

    def stands() -> bool:
        one = opened.robot.robot()
        wait_until(lambda: opened.robot.robot().time > one.time + 2.0, DEADLINE, "time to pass")
        return math.dist(opened.robot.robot().pose[:2], one.pose[:2]) < 0.01

    wait_until(stands, DEADLINE, "the robot to stand")


def test_without_the_token_nothing_is_changed(opened: Opened) -> None:
    other = opened.page.context.new_page()
    other.goto(opened.server.address)
    other.wait_for_selector("body[data-link='live']")
    other.get_by_text("This page may only look").wait_for()
    for name in ("Clean all", "Dock", "Stop now", "No-go zone", "New plan …"):
        assert all(each.is_disabled() for each in other.get_by_role("button", name=name).all())
    Opened(other, opened.robot, opened.server, opened.guard).tap(
        *opened.robot.home().rooms[0].anchor
    )
    assert other.is_hidden("#offer")
    other.keyboard.press("Escape")
    other.wait_for_selector("#refusal:not([hidden])")
    assert "token" in other.inner_text("#refusal")
    assert opened.phase() == "docked"


def test_the_printed_address_gives_an_open_tab_the_token(opened: Opened) -> None:
    other = opened.page.context.new_page()
    other.goto("about:blank")
    other.goto(opened.server.address)
    other.get_by_text("This page may only look").wait_for()
    other.goto(f"{opened.server.address}#token={opened.guard.token}")
    other.locator("#only-looks").wait_for(state="hidden")
    assert other.url == opened.server.address
    other.locator("#clean:enabled").wait_for()
    other.reload()
    other.locator("#clean:enabled").wait_for()


def test_a_browser_that_keeps_nothing_shows_the_page_and_may_command(opened: Opened) -> None:
    other = opened.page.context.new_page()
    other.add_init_script(REFUSES_TO_KEEP)
    other.goto(f"{opened.server.address}#token={opened.guard.token}")
    other.wait_for_selector("body[data-link='live']")
    other.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("cleaning")


def test_a_page_whose_wish_is_obeyed_says_no_more_that_it_may_only_look(opened: Opened) -> None:
    page = opened.page
    page.evaluate("async () => (await import('/store.js')).set('mayChange', false)")
    page.locator("#only-looks").wait_for()
    assert page.locator("#clean").is_disabled()
    page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")
    page.locator("#only-looks").wait_for(state="hidden")
    page.get_by_role("button", name="Release").click()
    page.wait_for_selector("body[data-held=no]")


def test_keys_alone_do(opened: Opened) -> None:
    page = opened.page
    page.keyboard.press("1")
    page.keyboard.press("3")
    assert page.locator("#rooms [aria-pressed=true]").count() == 2
    page.keyboard.press("?")
    assert page.locator("dialog#keys").is_visible()
    page.get_by_role("button", name="Close").press("Enter")
    page.locator("#clean").press("Enter")
    opened.wait_for_phase("cleaning")
    page.locator("#floor").focus()
    page.keyboard.press(" ")
    opened.wait_for_phase("paused")


def test_the_camera_shows_what_it_sees_at_an_angle(opened: Opened) -> None:
    page = opened.page
    opened.show("more")
    page.locator("#camera summary").click()
    looks = """(side) => {
        const image = document.getElementById("camera-picture");
        return image.naturalWidth > 100 && image.alt.includes(side);
    }"""
    page.wait_for_function(looks, arg="ahead", timeout=60_000)
    page.select_option("#camera-angle", "30")
    page.wait_for_function(looks, arg="30° to the left", timeout=60_000)
    page.locator("#camera-latest a").nth(1).wait_for()
    refused = opened.page.context.request.post(
        f"{opened.server.address}api/v1/camera", data={"angle": 0.0}
    )
    assert refused.status == 401
