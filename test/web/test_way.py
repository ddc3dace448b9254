"""A person's way over the page: by mouse, by touch, by keys alone, and with the network cut."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
from fixtures.waiting import wait_until
from PIL import Image
from playwright.sync_api import CDPSession, Page, WebSocketRoute
from web.conftest import SIZES, Opened, served_instead
from web.test_page import DEADLINE

from roomba.client.view import ZoneView
from roomba.commands.play.living import live_client
from roomba.ui.web.app import create_app
from roomba.ui.web.server import PageServer, listen

MOST_DIFFERENT = 0.005
"""Share of pixels in which two pictures of the same floor may differ."""
HOME = """async () => (await import("/store.js")).get("home")?.name"""
ASKED_IN_VAIN = """async () => {
    const { ask, picture, wish } = await import("/link.js");
    const real = AbortSignal.timeout;
    AbortSignal.timeout = () => AbortSignal.abort();
    const answers = [await ask("state"), await picture(0), await wish("speed", { speed: 0.2 })];
    AbortSignal.timeout = real;
    return answers;
}"""
"""Ask for all as if it had been waited for too long."""
DRAWING = "async () => Boolean((await import('/store.js')).get('drawing'))"


@pytest.fixture
def home() -> str:
    return "flat"


@pytest.fixture
def speed() -> float:
    return 20.0


class Finger:
    """A finger on the map."""

    def __init__(self, opened: Opened) -> None:
        self._opened = opened
        self._touch: CDPSession = opened.page.context.new_cdp_session(opened.page)

    def tap(self, x: float, y: float) -> None:
        self._opened.page.touchscreen.tap(*self._opened.pixels(x, y))

    def press_and_drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Hold a place until something begins there, and drag from it, m."""
        self._send("touchStart", start)
        wait_until(lambda: self._opened.page.evaluate(DRAWING), DEADLINE, "a draft")
        for share in (0.3, 0.6, 1.0):
            x, y = (one + share * (other - one) for one, other in zip(start, end, strict=True))
            self._send("touchMove", (x, y))
        self._send("touchEnd")

    def _send(self, kind: str, *places: tuple[float, float]) -> None:
        points = [dict(zip("xy", self._opened.pixels(*place), strict=True)) for place in places]
        self._touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


def look_back(opened: Opened, how: str) -> None:
    """Read how the run ended."""
    opened.show("more")
    opened.page.wait_for_selector("#last:not([hidden])")
    assert how in opened.page.inner_text("#last-text").lower()


def wait_for_zone(opened: Opened, kind: str) -> ZoneView:
    wait_until(
        lambda: len(opened.robot.home().zones) == 1,
        DEADLINE,
        lambda: f"a zone; refused: {opened.page.locator('#refusal').text_content()!r}",
    )
    (zone,) = opened.robot.home().zones
    assert zone.kind == kind
    return zone


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_by_mouse(opened: Opened) -> None:
    page, rooms = opened.page, {room.name: room for room in opened.robot.home().rooms}
    opened.tap(*rooms["kitchen"].anchor)
    opened.tap(*rooms["hallway"].anchor)
    page.get_by_role("button", name="Clean 2 rooms").click()
    opened.wait_for_phase("cleaning")
    page.get_by_role("button", name="Pause").click()
    opened.wait_for_phase("paused")
    page.get_by_role("button", name="No-go zone").click()
    x, y = rooms["hallway"].anchor
    opened.drag((x - 0.4, y - 0.4), (x + 0.4, y + 0.4))
    wait_for_zone(opened, "no-go")
    page.get_by_role("button", name="Go on").click()
    opened.wait_for_phase("cleaning")
    page.get_by_role("button", name="Dock").click()
    opened.wait_for_phase("docked")
    look_back(opened, "stopped")


@pytest.mark.parametrize("size", [SIZES["phone"], SIZES["tablet"]])
def test_by_touch(opened: Opened) -> None:
    page, rooms = opened.page, {room.name: room for room in opened.robot.home().rooms}
    finger = Finger(opened)
    finger.tap(*rooms["kitchen"].anchor)
    finger.tap(*rooms["bedroom"].anchor)
    page.get_by_role("button", name="Clean 2 rooms").tap()
    opened.wait_for_phase("cleaning")
    page.get_by_role("button", name="Pause").tap()
    opened.wait_for_phase("paused")
    x, y = rooms["living room"].anchor
    finger.press_and_drag((x - 0.5, y + 0.5), (x + 0.5, y + 1.5))
    choice = page.locator("#offer").get_by_role("button", name="No-go zone")

    def is_taken() -> bool:
        # Right after a drag Chromium takes a touch for the second one of a double tap.
        if choice.is_visible():
            choice.tap()
        return not choice.is_visible()

    wait_until(is_taken, DEADLINE, "the card to take a tap", pause=0.2)
    zone = wait_for_zone(opened, "no-go")
    assert zone.points[0] == pytest.approx((x - 0.5, y + 0.5), abs=0.05)
    page.get_by_role("button", name="Go on").tap()
    opened.wait_for_phase("cleaning")
    page.get_by_role("button", name="Dock").tap()
    opened.wait_for_phase("docked")
    look_back(opened, "stopped")


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_by_keys_alone(opened: Opened) -> None:
    page, keys = opened.page, opened.page.keyboard

    def walk_to(name: str) -> None:
        """Press Tab until a button has the focus."""
        for _ in range(60):
            focused = page.evaluate("() => document.activeElement.textContent")
            if focused == name:
                return
            keys.press("Tab")
        pytest.fail(f"expected to come to {name!r} by Tab")

    keys.press("2")
    keys.press("3")
    walk_to("Clean 2 rooms")
    keys.press("Enter")
    opened.wait_for_phase("cleaning")
    walk_to("Pause")
    keys.press(" ")
    opened.wait_for_phase("paused")
    walk_to("No-go zone")
    keys.press("Enter")
    assert page.evaluate("() => document.activeElement.id") == "floor"
    keys.press("Enter")
    for key in ("ArrowRight", "ArrowRight", "Shift+ArrowUp"):
        keys.press(key)
    keys.press("Enter")
    zone = wait_for_zone(opened, "no-go")
    (left, low), (right, high) = zone.points[0], zone.points[2]
    assert (right - left, high - low) == pytest.approx((1.0, 1.1))
    keys.press(" ")
    opened.wait_for_phase("cleaning")
    keys.press("Escape")
    opened.wait_for_phase("emergency stop")
    page.locator("#emergency").focus()
    keys.press("Enter")
    opened.wait_for_phase("paused")
    walk_to("Dock")
    keys.press("Enter")
    opened.wait_for_phase("docked")
    look_back(opened, "told to dock")


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_the_network_is_cut_and_back_while_it_cleans(opened: Opened) -> None:
    page = opened.page
    page.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("cleaning")
    page.keyboard.press("1")
    port = int(opened.server.address.rsplit(":", 1)[1].strip("/"))
    opened.server.stop()
    page.wait_for_selector("body[data-link='reconnecting']")
    assert "Connecting again" in page.inner_text("#headline")
    assert "Last seen at" in page.inner_text("#explanation")
    for name in ("Clean all", "Pause", "Rename", "No-go zone", "New plan …"):
        assert all(each.is_disabled() for each in page.get_by_role("button", name=name).all())
    assert page.locator("#passes").is_disabled()
    opened.tap(*opened.robot.home().rooms[0].anchor)
    assert page.is_hidden("#offer")
    # What can be read can be opened still, and stopping is tried at any time.
    page.locator("#charts summary").click()
    assert page.locator("#chart-battery").is_visible()
    assert page.get_by_role("button", name="Stop now").first.is_enabled()
    covered = opened.robot.robot().vacuum.covered
    wait_until(lambda: opened.robot.robot().vacuum.covered > covered, DEADLINE, "it to go on")
    again = PageServer(
        create_app(opened.robot, opened.guard), listen("127.0.0.1", port, is_fixed=True)
    )
    again.start()
    try:
        page.wait_for_selector("body[data-link='live']")
        page.keyboard.press("1")
        page.get_by_role("button", name="Pause").click()
        opened.wait_for_phase("paused")
        page.get_by_role("button", name="Stop", exact=True).click()
        opened.wait_for_phase("idle")
        page.get_by_role("button", name="Clean all").click()
        opened.wait_for_phase("cleaning")
    finally:
        again.stop()


def difference(one: Page, other: Page) -> float:
    """Return the share of pixels in which two maps differ; 1 for maps of another size."""
    first, second = (
        np.asarray(Image.open(io.BytesIO(page.locator("#floor").screenshot())).convert("RGB"))
        for page in (one, other)
    )
    return float((first != second).any(axis=2).mean()) if first.shape == second.shape else 1.0


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_of_a_server_that_was_started_anew_the_other_home_is_drawn(opened: Opened) -> None:
    page, other = opened.page, live_client("studio", seed=1, speed=1.0, knows_map=True)
    page.keyboard.press("1")
    page.get_by_role("button", name="Zoom in").click()
    other.start()
    with served_instead(opened, create_app(other, opened.guard)) as server:
        wait_until(lambda: page.evaluate(HOME) == "studio", DEADLINE, "the other home")
        page.wait_for_selector("body[data-link='live']")
        assert page.inner_text("#clean") == "Clean all"
        fresh = page.context.new_page()
        fresh.set_viewport_size({"width": SIZES["desktop"][0], "height": SIZES["desktop"][1]})
        fresh.emulate_media(reduced_motion="reduce")
        fresh.goto(f"{server.address}#token={opened.guard.token}")
        fresh.wait_for_selector("body[data-phase='docked']")
        found = list[float]()

        def is_same() -> bool:
            found.append(difference(page, fresh))
            return found[-1] < MOST_DIFFERENT

        wait_until(is_same, DEADLINE, lambda: f"the map of a new page, not {found[-1]:.3f} of it")
    other.end()


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_the_page_tells_what_has_come_and_gives_up_a_path_that_dies(opened: Opened) -> None:
    page, paths, dead = opened.page, list[WebSocketRoute](), list[WebSocketRoute]()
    said = list[str | bytes]()

    def lead(path: WebSocketRoute) -> None:
        paths.append(path)
        server = path.connect_to_server()
        server.on_message(lambda told: None if path in dead else path.send(told))

        def pass_on(words: str | bytes) -> None:
            said.append(words)
            server.send(words)

        path.on_message(pass_on)

    page.route_web_socket("**/live", lead)
    page.reload()
    opened.wait_for_phase("docked")
    seen = [json.loads(words) for words in said if "hello" not in str(words)]
    assert {each["type"] for each in seen} == {"seen"}
    assert seen[0]["looked"] == 0.0 < seen[-1]["looked"]
    dead.extend(paths)
    page.wait_for_selector("body[data-link='stale']")
    page.wait_for_selector("body[data-link='live']")
    assert len(paths) == 2


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_no_answer_is_waited_for_without_end(opened: Opened) -> None:
    assert opened.page.evaluate(ASKED_IN_VAIN) == [None, None, False]
