"""A real browser on the real page, over a headless robot."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from roomba.commands.play.living import live_client
from roomba.headless.live.client import LiveClient
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.ui.web.server import PageServer, listen

SIZES = {"desktop": (1440, 900), "phone": (390, 844)}
PIXELS = """async ([x, y]) => {
    const { toScreen } = await import("/map/view.js");
    const box = document.getElementById("floor").getBoundingClientRect();
    const [px, py] = toScreen(x, y);
    return [px + box.left, py + box.top];
}"""


@dataclass
class Opened:
    """A page that is open in a browser, the robot under it, and its server."""

    page: Page
    robot: LiveClient
    server: PageServer
    guard: Guard

    def phase(self) -> str:
        return self.robot.robot().vacuum.phase

    def show(self, part: str) -> None:
        """Open a part of the commands: on a phone they lie in a sheet."""
        tab = self.page.locator(f"[data-tab={part}]")
        if tab.is_visible() and tab.get_attribute("aria-expanded") == "false":
            tab.click()

    def show_map(self) -> None:
        """Close the sheet again, if there is one."""
        for tab in self.page.locator("[data-tab][aria-expanded=true]").all():
            if tab.is_visible():
                tab.click()

    def pixels(self, x: float, y: float) -> tuple[float, float]:
        """Return where a place of the floor is on the window."""
        left, top = self.page.evaluate(PIXELS, [x, y])
        return left, top

    def tap(self, x: float, y: float) -> None:
        """Tap a place of the floor, m."""
        self.page.mouse.click(*self.pixels(x, y))

    def drag(self, *places: tuple[float, float]) -> None:
        """Drag with the mouse over places of the floor, m."""
        mouse, (first, *others) = self.page.mouse, places
        mouse.move(*self.pixels(*first))
        mouse.down()
        for place in others:
            mouse.move(*self.pixels(*place), steps=3)
        mouse.up()

    def wait_for_phase(self, phase: str) -> None:
        """Wait until the page says that the robot is in a phase."""
        self.page.wait_for_selector(f"body[data-phase='{phase}']", timeout=30_000)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """The distribution's Chromium."""
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    assert program, "expected chromium, found none; have it installed: ./roomba test sets it up"
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        yield launched
        launched.close()


@pytest.fixture
def home() -> str:
    """The home of a test; a test may ask for another one."""
    return "flat"


@pytest.fixture
def speed() -> float:
    """How fast the robot's time passes."""
    return 10.0


@pytest.fixture
def served(home: str, speed: float) -> Iterator[tuple[LiveClient, PageServer, Guard]]:
    """A robot, and its page on a free port."""
    robot = live_client(home, seed=1, speed=speed, knows_map=True)
    guard = Guard(new_token())
    server = PageServer(create_app(robot, guard), listen("127.0.0.1", 0, is_fixed=True))
    robot.start()
    server.start()
    yield robot, server, guard
    server.stop()
    robot.end()


@pytest.fixture(params=list(SIZES))
def size(request: pytest.FixtureRequest) -> tuple[int, int]:
    """Width and height of the window, px."""
    return SIZES[request.param]


@pytest.fixture
def opened(
    browser: Browser,
    served: tuple[LiveClient, PageServer, Guard],
    size: tuple[int, int],
) -> Iterator[Opened]:
    """The page by the printed address, live; no script failed when the test ends."""
    robot, server, guard = served
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]}, has_touch=size[0] < 900
    )
    page = context.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(f"{server.address}#token={guard.token}")
    opened = Opened(page, robot, server, guard)
    opened.wait_for_phase("docked")
    yield opened
    context.close()
    assert errors == []
