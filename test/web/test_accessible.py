"""The page can be used: axe-core finds no serious fault, it is light and calm when asked to be."""

from __future__ import annotations

import re
from typing import Any

import pytest
from axe_playwright_python.sync_playwright import Axe
from fixtures.pages.windows import Motion, Windows
from fixtures.waiting import wait_until
from playwright.sync_api import Page, Route
from web.conftest import SIZES, Opened, page_at

from roomba.headless.live.client import LiveClient
from roomba.ui.web.app import STATIC
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer

MOST_BYTES = 300_000
GRAVE = ("serious", "critical")
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


def faults(opened: Opened) -> list[tuple[str, str, Any]]:
    """Return what axe-core calls serious or critical: how grave, rule, elements."""
    found = Axe().run(opened.page).response["violations"]
    return [
        (fault["impact"], fault["id"], [node["target"] for node in fault["nodes"]])
        for fault in found
        if fault["impact"] in GRAVE
    ]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_serious_fault(opened: Opened, scheme: str) -> None:
    page = opened.page
    # What is still fading in has no contrast yet.
    page.emulate_media(
        color_scheme="dark" if scheme == "dark" else "light", reduced_motion="reduce"
    )
    assert faults(opened) == []
    page.evaluate(OPEN_ALL)
    opened.tap(*opened.robot.home().rooms[0].anchor)
    for part in ("rooms", "zones", "more"):
        opened.show(part)
        assert faults(opened) == [], part
    opened.show_map()
    page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")
    page.keyboard.press("?")
    assert faults(opened) == []


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


def test_nothing_comes_from_outside(opened: Opened) -> None:
    asked: list[str] = []

    def note(route: Route) -> None:
        asked.append(route.request.url)
        route.continue_()

    # What the page's policy keeps a browser from asking for is told on its console alone.
    kept_back: list[str] = []
    opened.page.on(
        "console", lambda said: kept_back.append(said.text) if "Policy" in said.text else None
    )
    opened.page.route("**/*", note)
    opened.page.reload()
    opened.wait_for_phase("docked")
    assert kept_back == []
    assert len(asked) > 20
    assert [url for url in asked if not url.startswith(opened.server.address)] == []


def glides(page: Page) -> bool:
    """Whether a state is drawn more than twice: once when it comes, once with the way so far."""
    for _ in range(10):
        drawn, states = page.evaluate(DRAWN)
        if states > 0:
            return bool(drawn > 2 * states + 1)
    pytest.fail("expected states of the robot, got none")


@pytest.mark.parametrize("speed", [1.0])
@pytest.mark.parametrize("motion", ["reduce", "no-preference"])
def test_the_robot_glides_unless_less_motion_is_preferred(
    windows: Windows,
    served: tuple[LiveClient, PageServer, Guard],
    motion: Motion,
) -> None:
    robot, server, guard = served
    address = f"{server.address}#token={guard.token}"
    with page_at(windows, address, SIZES["phone"], motion=motion) as page:
        opened = Opened(page, robot, server, guard)
        opened.wait_for_phase("docked")
        page.click("#clean")
        opened.wait_for_phase("cleaning")
        if motion == "reduce":
            assert not any(glides(page) for _ in range(3))
        else:
            wait_until(lambda: glides(page), 20.0, "it glides")
