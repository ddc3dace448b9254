"""Pictures and a film of the web page while a robot cleans, and of a report, made in a browser."""

from __future__ import annotations

import contextlib
import functools
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import cv2
import numpy as np

from roomba.commands.play.living import live_client
from roomba.commands.sim.kept_run import figures_of, recording_of
from roomba.commands.sim.state_samples import StateSamples
from roomba.commands.trials.runs import run_trial
from roomba.commands.trials.trial import Trial
from roomba.errors import RoombaError
from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper
from roomba.history.replay import RecordedRobot
from roomba.history.report.document import report_of
from roomba.history.run import RunFigures, RunRecording, RunSource
from roomba.history.run_rows import KeptRun
from roomba.plots.canvas import Picture
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.ui.web.server import PageServer, listen
from roomba.world.home.home import Home

_SPEED: Final = 60.0
"""The robot's seconds per second."""
_CLEANED: Final = 4.0
"""m2 that are clean in the picture."""
_DEADLINE: Final = 90.0
"""s of wall time until so much is clean."""
_IS_COVERED: Final = """async () => {
    const { grid } = await import("/map/grids.js");
    return grid("coverage")?.cells.some((value) => value > 0);
}"""
_PHONE: Final = {"width": 390, "height": 844}
"""px."""
_GAP: Final = 24
"""px between two windows."""
_FILM_SIZE: Final = {"width": 960, "height": 640}
"""px."""
_FILM_SPEED: Final = 30.0
"""The robot's seconds per second of a film."""
_FILM_ROOMS: Final = ("kitchen", "bathroom")
_SETTLED: Final = 300
"""ms of wall time until what appears has done so."""
_FRAMES: Final = 70
"""Of a film, while the robot cleans."""
_HAS_ROOMS: Final = """async () => {
    const { get } = await import("/store.js"), { grid } = await import("/map/grids.js");
    return Boolean(get("home")?.rooms.length > 0 && get("limits") && grid("map"));
}"""
_TAP: Final = """async (name) => {
    const { get } = await import("/store.js"), { tapped } = await import("/panels/offer.js");
    const { toScreen } = await import("/map/view.js"), rooms = get("home").rooms;
    const [x, y] = rooms.find((room) => room.name === name).anchor;
    tapped(x, y, ...toScreen(x, y));
}"""
_IS_CLEANED: Final = """async (least) =>
    ((await import("/store.js")).get("state")?.vacuum.covered ?? 0) >= least"""
_BROWSERS: Final = ("chromium", "chromium-browser", "google-chrome")


def picture_of_phone(home: Home) -> Picture:
    """Return a phone's window in the dark: two rooms are cleaned in order."""
    with _opened(home, _SPEED, _PHONE, color_scheme="dark") as page:
        for name in _FILM_ROOMS:
            page.evaluate(_TAP, name)
        page.click("#clean")
        _wait_for_covered(page)
        return decoded(page.screenshot())


@functools.cache
def _recorded_clean(home: str) -> tuple[RunFigures, RunRecording]:
    """Return a clean with three things that the map does not show."""
    samples = StateSamples()
    run = run_trial(Trial(home=home, seed=1, things=3), (samples,))
    source = RunSource("sim", home, 1, f"./roomba sim --home {home} --seed 1 --things 3")
    return figures_of(run.figures, source), recording_of(run, samples)


def picture_of_replay(home: Home) -> Picture:
    """Return that clean again on the page, half way through."""
    robot = RecordedRobot(*_recorded_clean(home.name))
    robot.seek(0.5 * robot.timeline().duration)
    guard = Guard(new_token())
    server = PageServer(create_app(robot, guard), listen("127.0.0.1", 0, is_fixed=True))
    server.start()
    try:
        with browser_page({"width": 1280, "height": 800}) as page:
            page.goto(server.address)
            page.wait_for_selector("#timeline:not([hidden])")
            wait_until(page, _IS_COVERED)
            page.wait_for_timeout(_SETTLED)
            return decoded(page.screenshot())
    finally:
        server.stop()


def picture_of_report(home: Home) -> Picture:
    """Return the report of that clean."""
    figures, recording = _recorded_clean(home.name)
    with browser_page({"width": 1100, "height": 1250}) as page:
        page.set_content(report_of(KeptRun(1, figures, True), recording))
        return decoded(page.screenshot())


@contextlib.contextmanager
def served(
    home: Home, speed: float, keeper: HistoryKeeper | None = None
) -> Iterator[tuple[PageServer, Guard]]:
    """Serve the page of a robot that lives in a home."""
    robot = live_client(home.name, seed=1, speed=speed, knows_map=True)
    guard = Guard(new_token())
    bound = listen("127.0.0.1", 0, is_fixed=True)
    server = PageServer(create_app(robot, guard, keeper), bound)
    robot.start()
    server.start()
    try:
        yield server, guard
    finally:
        server.stop()
        robot.end()


@contextlib.contextmanager
def browser_page(size: dict[str, int], **wishes: object) -> Iterator[Any]:
    """Open a window of a browser, px; raises RoombaError where there is none."""
    with _playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=_browser(), args=["--no-sandbox"])
        try:
            yield browser.new_context(viewport=size, **wishes).new_page()
        finally:
            browser.close()


@contextlib.contextmanager
def _opened(
    home: Home,
    speed: float,
    size: dict[str, int],
    keeper: HistoryKeeper | None = None,
    **wishes: object,
) -> Iterator[Any]:
    """Open the page of a robot that stands ready in a home."""
    with served(home, speed, keeper) as (server, guard), browser_page(size, **wishes) as page:
        page.goto(f"{server.address}#token={guard.token}")
        page.wait_for_selector("body[data-phase='docked']")
        wait_until(page, _HAS_ROOMS)
        page.wait_for_timeout(_SETTLED)
        yield page


def frames_of_page(home: Home) -> list[Picture]:
    """Return a short film of the page: two rooms are tapped, and the robot cleans them."""
    with _opened(home, _FILM_SPEED, _FILM_SIZE, color_scheme="light") as page:
        frames = [decoded(page.screenshot())] * 4
        for name in _FILM_ROOMS:
            page.evaluate(_TAP, name)
            page.wait_for_timeout(_SETTLED)
            frames += [decoded(page.screenshot())] * 4
        page.click("#clean")
        return frames + [decoded(page.screenshot()) for _ in range(_FRAMES)]


def picture_of_way(home: Home) -> Picture:
    """Return six windows of a phone: a new user's way, from the first look to the report."""
    with tempfile.TemporaryDirectory() as folder:
        source = RunSource("play", home.name, 1, f"./roomba play --home {home.name} --seed 1")
        keeper = HistoryKeeper(History(Path(folder)), source, print)
        with _opened(home, _SPEED, _PHONE, keeper, color_scheme="light", has_touch=True) as page:
            seen = _seen_on_the_way(page)
    rows = [_side_by_side(seen[:3]), _side_by_side(seen[3:])]
    gap = np.full((_GAP, rows[0].shape[1], 3), 255, np.uint8)
    return np.vstack([rows[0], gap, rows[1]])


def _seen_on_the_way(page: Any) -> list[Picture]:
    seen = [decoded(page.screenshot())]
    for name in _FILM_ROOMS:
        page.evaluate(_TAP, name)
    page.wait_for_timeout(_SETTLED)
    seen.append(decoded(page.screenshot()))
    page.click("#clean")
    _wait_for_covered(page)
    seen.append(decoded(page.screenshot()))
    page.get_by_role("button", name="Pause").click()
    page.wait_for_selector("body[data-phase='paused']")
    page.wait_for_timeout(_SETTLED)
    seen.append(decoded(page.screenshot()))
    page.click("#stop")
    page.click("[data-tab=more]")
    page.wait_for_selector("#last:not([hidden])")
    page.click("#history-open")
    report = page.get_by_role("link", name="Report").first
    report.wait_for()
    page.wait_for_timeout(_SETTLED)
    seen.append(decoded(page.screenshot()))
    page.goto(report.evaluate("link => link.href"))
    seen.append(decoded(page.screenshot()))
    return seen


def _side_by_side(pictures: list[Picture]) -> Picture:
    gap = np.full((pictures[0].shape[0], _GAP, 3), 255, np.uint8)
    return np.hstack([part for picture in pictures for part in (picture, gap)][:-1])


def decoded(screenshot: bytes) -> Picture:
    """Return a screenshot as a picture."""
    decoded: Any = cv2.imdecode(np.frombuffer(screenshot, np.uint8), cv2.IMREAD_COLOR)
    picture: Picture = decoded[:, :, ::-1].copy()
    return picture


def _wait_for_covered(page: Any) -> None:
    wait_until(page, _IS_CLEANED, _CLEANED)


def wait_until(page: Any, expression: str, wanted: float | None = None) -> None:
    """Wait until the page answers a question by yes; RoombaError when it does not in time."""
    ends = time.monotonic() + _DEADLINE
    while not page.evaluate(expression, wanted):
        if time.monotonic() > ends:
            raise RoombaError(f"expected within {_DEADLINE:g} s: {expression}")
        page.wait_for_timeout(100)


def _playwright() -> Any:
    try:
        from playwright.sync_api import sync_playwright
    except ImportError as error:
        raise RoombaError(
            "a picture of the page needs playwright: `pip install playwright`"
        ) from error
    return sync_playwright()


def _browser() -> str:
    for name in _BROWSERS:
        found = shutil.which(name)
        if found:
            return found
    raise RoombaError(f"a picture of the page needs one of {', '.join(_BROWSERS)}; install one")
