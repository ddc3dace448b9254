"""The page can be used: axe-core finds no serious fault, it is light and calm when asked to be."""

from __future__ import annotations

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from fixtures.pages.windows import Windows
from fixtures.waiting import wait_until
from playwright.sync_api import Page, Route
from web.conftest import EACH_SIZE, SIZES, Opened, in_each_scheme

from roomba.headless.live.client import LiveClient
from roomba.ui.web.app import STATIC
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer

MOST_BYTES = 300_000
GRAVE = ("serious", "critical")
RUN_AXE = "async () => (await axe.run({ resultTypes: ['violations'] })).violations"
OPEN_ALL = """() => {
    for (const part of document.querySelectorAll("details")) part.open = true;
}"""

DRAWN = """async () => {
    const { get } = await import("/store.js");
    const paper = document.getElementById("floor").getContext("2d"), clear = paper.clearRect;
    const states = new Set();
    let drawn = 0;
    paper.clearRect = (...box) => {
        drawn += 1;
        states.add(get("state").at);
        clear.apply(paper, box);
    };
    await new Promise((done) => setTimeout(done, 1000));
    delete paper.clearRect;
    return [drawn, states.size];
}"""
"""How often the map was drawn in a second, and how many states of the robot it showed."""


def check_with_axe(opened: Opened) -> None:
    """Axe-core finds nothing serious or critical: how grave, rule, elements."""
    if not opened.page.evaluate("() => 'axe' in window"):
        opened.page.evaluate(Axe().axe_script)
    for scheme in in_each_scheme(opened.page):
        found = opened.page.evaluate(RUN_AXE)
        grave = [
            (fault["impact"], fault["id"], [node["target"] for node in fault["nodes"]])
            for fault in found
            if fault["impact"] in GRAVE
        ]
        assert grave == [], scheme


@EACH_SIZE
def test_axe_finds_no_serious_fault(opened: Opened) -> None:
    page = opened.page
    check_with_axe(opened)
    page.evaluate(OPEN_ALL)
    opened.tap(*opened.robot.home().rooms[0].anchor)
    for part in opened.parts():
        opened.show(part)
        check_with_axe(opened)
    opened.show_map()
    page.locator(".state").click()  # the card closes, which the key would do first
    page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")
    page.keyboard.press("?")
    check_with_axe(opened)


def test_the_page_is_light() -> None:
    sizes = {file: file.stat().st_size for file in STATIC.rglob("*") if file.is_file()}
    assert 50_000 < sum(sizes.values()) <= MOST_BYTES


def test_all_modules_are_asked_for_at_once() -> None:
    """And not one after the other, as each names the next."""
    asked = re.findall(r'rel="modulepreload" href="([^"]+)"', (STATIC / "index.html").read_text())
    modules = {file.relative_to(STATIC).as_posix() for file in STATIC.rglob("*.js")}
    assert sorted(asked) == sorted(modules - {"app.js"})


@pytest.mark.parametrize("size", [SIZES["phone"]])
@pytest.mark.parametrize("is_own", [True])
def test_it_is_painted_within_a_second(opened: Opened) -> None:
    """Of opening it on loopback, when nothing of it is kept yet."""
    first = opened.page.evaluate("() => performance.getEntriesByName('first-paint')[0].startTime")
    assert 0.0 < first <= 1000.0


def test_nothing_comes_from_outside(
    windows: Windows, served: tuple[LiveClient, PageServer, Guard], size: tuple[int, int]
) -> None:
    robot, server, guard = served
    asked: list[str] = []

    def note(route: Route) -> None:
        asked.append(route.request.url)
        route.continue_()

    # What the page's policy keeps a browser from asking for is told on its console alone.
    kept_back: list[str] = []
    with windows.lent(size) as page:
        page.on(
            "console", lambda said: kept_back.append(said.text) if "Policy" in said.text else None
        )
        page.route("**/*", note)
        page.goto(f"{server.address}#token={guard.token}")
        Opened(page, robot, server, guard).wait_for_phase("docked")
    assert kept_back == []
    assert len(asked) > 20
    assert [url for url in asked if not url.startswith(server.address)] == []


def glides(page: Page) -> bool:
    """Whether a state is drawn more than twice: once when it comes, once with the way so far."""
    for _ in range(10):
        drawn, states = page.evaluate(DRAWN)
        if states > 0:
            return bool(drawn > 2 * states + 1)
    pytest.fail("expected states of the robot, got none")


@pytest.mark.parametrize("speed", [1.0])
@pytest.mark.parametrize("size", [SIZES["phone"]])
def test_the_robot_glides_unless_less_motion_is_preferred(opened: Opened) -> None:
    page = opened.page
    page.click("#clean")
    opened.wait_for_phase("cleaning")
    before = opened.robot.robot().pose
    assert not any(glides(page) for _ in range(3))
    assert opened.robot.robot().pose != before
    page.emulate_media(reduced_motion="no-preference")
    wait_until(lambda: glides(page), 20.0, "it glides")
