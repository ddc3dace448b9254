"""A real browser on the real page, over a headless robot."""

from __future__ import annotations

import shutil
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import pytest
from fastapi import FastAPI
from fixtures.pages.windows import Motion, Windows
from fixtures.thoroughness import core_first
from playwright.sync_api import Page, sync_playwright

from roomba.commands.play.living import live_client
from roomba.commands.sim.kept_run import figures_of, recording_of
from roomba.commands.sim.state_samples import StateSamples
from roomba.commands.trials.runs import run_trial
from roomba.commands.trials.trial import Trial
from roomba.headless.live.client import LiveClient
from roomba.history.run import RunFigures, RunRecording, RunSource
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.ui.web.server import PageServer, listen

PARTS = ("rooms", "zones", "more")
"""Of the commands; on a phone one is seen at a time."""
SIZES = {"desktop": (1440, 900), "tablet": (820, 1180), "phone": (390, 844)}
"""Of windows, px."""
EACH_SIZE = pytest.mark.parametrize("size", SIZES.values(), ids=SIZES)
"""Where the layout matters."""
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

    def parts(self) -> tuple[str, ...]:
        """Return the parts of which each is to be shown, so that all were seen."""
        return PARTS if self.page.locator("[data-tab]").first.is_visible() else PARTS[:1]

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
def windows() -> Iterator[Windows]:
    """Those of the distribution's Chromium."""
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    assert program, "expected chromium, found none; have it installed: ./roomba test sets it up"
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        yield Windows(launched)
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
def knows_map() -> bool:
    """Whether the robot has a map to begin with."""
    return True


@pytest.fixture
def bin_grams() -> float | None:
    """What goes into the dust bin, g; None: as much as usual."""
    return None


@pytest.fixture
def is_own() -> bool:
    """Whether a test needs a window that nothing else has used or uses later."""
    return False


@pytest.fixture(scope="session")
def recorded() -> tuple[RunFigures, RunRecording]:
    """A real clean of the studio."""
    samples = StateSamples()
    run = run_trial(Trial(home="studio", seed=1), (samples,))
    source = RunSource("sim", run.home.name, 1)
    return figures_of(run.figures, source), recording_of(run, samples)


@contextmanager
def serving(app: FastAPI) -> Iterator[PageServer]:
    """Serve a page on a free port."""
    server = PageServer(app, listen("127.0.0.1", 0, is_fixed=True))
    server.start()
    try:
        yield server
    finally:
        server.stop()


@contextmanager
def page_at(
    windows: Windows,
    address: str,
    size: tuple[int, int],
    *,
    has_touch: bool = False,
    motion: Motion = "reduce",
    is_own: bool = False,
) -> Iterator[Page]:
    """Open an address in a window, px; no script failed when that closes.

    For a viewer who prefers less motion the robot does not glide from place to place: sixty
    pictures a second, drawn without a graphics card, would take most of a test's time.
    """
    errors: list[str] = []
    with windows.lent(size, has_touch=has_touch, motion=motion, is_own=is_own) as page:
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(address)
        yield page
    assert errors == []


@contextmanager
def served_instead(opened: Opened, app: FastAPI) -> Iterator[PageServer]:
    """End the page's server, and serve another application at its address."""
    port = int(opened.server.address.rsplit(":", 1)[1].strip("/"))
    opened.server.stop()
    again = PageServer(app, listen("127.0.0.1", port, is_fixed=True))
    again.start()
    try:
        yield again
    finally:
        again.stop()


def in_each_scheme(page: Page) -> Iterator[str]:
    """Let the viewer prefer light, then dark."""
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
        yield scheme


@pytest.fixture
def served(
    home: str, speed: float, knows_map: bool, bin_grams: float | None
) -> Iterator[tuple[LiveClient, PageServer, Guard]]:
    """A robot, and its page on a free port."""
    robot = live_client(home, seed=1, speed=speed, knows_map=knows_map, bin_grams=bin_grams)
    guard = Guard(new_token())
    robot.start()
    with serving(create_app(robot, guard)) as server:
        yield robot, server, guard
    robot.end()


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Let a test run in each window: by turns in one of them, ``thorough`` in the others."""
    given = [mark.args[0] for mark in metafunc.definition.iter_markers("parametrize")]
    if "size" not in metafunc.fixturenames or "size" in given:
        return
    turn = zlib.crc32(metafunc.function.__name__.encode()) % len(SIZES)
    core = [list(SIZES)[turn]]
    metafunc.parametrize("size", core_first(SIZES, core), indirect=True)


@pytest.fixture
def size(request: pytest.FixtureRequest) -> tuple[int, int]:
    """Width and height of the window, px."""
    return SIZES[request.param]


@pytest.fixture
def opened(
    windows: Windows,
    served: tuple[LiveClient, PageServer, Guard],
    size: tuple[int, int],
    is_own: bool,
) -> Iterator[Opened]:
    """The page by the printed address, live; no script failed when the test ends."""
    robot, server, guard = served
    address = f"{server.address}#token={guard.token}"
    with page_at(windows, address, size, has_touch=size[0] < 900, is_own=is_own) as page:
        opened = Opened(page, robot, server, guard)
        opened.wait_for_phase("docked")
        yield opened
