"""Pictures of the web page while a robot cleans, and of a report, made in a real browser."""

from __future__ import annotations

import shutil
import time
from typing import Any, Final

import cv2
import numpy as np

from roomba.commands.play.living import live_client
from roomba.commands.sim.kept_run import StateSamples, figures_of, recording_of
from roomba.commands.trials.runs import run_trial
from roomba.commands.trials.trial import Trial
from roomba.errors import RoombaError
from roomba.history.database import KeptRun
from roomba.history.replay import RecordedRobot
from roomba.history.report.document import report_of
from roomba.history.run import RunFigures, RunRecording, RunSource
from roomba.plots.canvas import Picture
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.ui.web.server import PageServer, listen
from roomba.world.home.home import Home

_SPEED: Final = 20.0
"""The robot's seconds per second."""
_CLEANED: Final = 4.0
"""m2 that are clean in the picture."""
_DEADLINE: Final = 90.0
"""s of wall time until so much is clean."""
_IS_COVERED: Final = """async () => {
    const { grid } = await import("/map/grids.js");
    return grid("coverage")?.cells.some((value) => value > 0);
}"""
_BROWSERS: Final = ("chromium", "chromium-browser", "google-chrome")


def picture_of_page(home: Home) -> Picture:
    """Return a desktop's window: two rooms are cleaned in order, with a zone to be left out."""
    return _picture(home, {"width": 1280, "height": 800}, "light")


def picture_of_phone(home: Home) -> Picture:
    """Return the same on a phone, in the dark."""
    return _picture(home, {"width": 390, "height": 844}, "dark")


def _recorded_clean(home: Home) -> tuple[RunFigures, RunRecording]:
    """Return a clean with three things that the map does not show."""
    samples = StateSamples()
    run = run_trial(Trial(home=home.name, seed=1, things=3), (samples,))
    source = RunSource("sim", home.name, 1, f"./roomba sim --home {home.name} --seed 1 --things 3")
    return figures_of(run.figures, source), recording_of(run, samples)


def picture_of_replay(home: Home) -> Picture:
    """Return that clean again on the page, half way through."""
    robot = RecordedRobot(*_recorded_clean(home))
    robot.seek(0.5 * robot.timeline().duration)
    guard = Guard(new_token())
    server = PageServer(create_app(robot, guard), listen("127.0.0.1", 0, is_fixed=True))
    server.start()
    try:
        with _playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=_browser(), args=["--no-sandbox"])
            page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
            page.goto(server.address)
            page.wait_for_selector("#timeline:not([hidden])")
            page.wait_for_function(_IS_COVERED, timeout=1000.0 * _DEADLINE)
            page.wait_for_timeout(500)
            picture = _decoded(page.screenshot())
            browser.close()
    finally:
        server.stop()
    return picture


def picture_of_report(home: Home) -> Picture:
    """Return the report of that clean."""
    figures, recording = _recorded_clean(home)
    document = report_of(KeptRun(1, figures, True), recording)
    with _playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=_browser(), args=["--no-sandbox"])
        page = browser.new_context(viewport={"width": 1100, "height": 1250}).new_page()
        page.set_content(document)
        picture = _decoded(page.screenshot())
        browser.close()
    return picture


def _picture(home: Home, size: dict[str, int], scheme: str) -> Picture:
    robot = live_client(home.name, seed=1, speed=_SPEED, knows_map=True)
    guard = Guard(new_token())
    server = PageServer(create_app(robot, guard), listen("127.0.0.1", 0, is_fixed=True))
    robot.start()
    server.start()
    try:
        return _looked_at(f"{server.address}#token={guard.token}", size, scheme)
    finally:
        server.stop()
        robot.end()


def _looked_at(address: str, size: dict[str, int], scheme: str) -> Picture:
    """Open the page, let the robot clean for a while, and return what is seen."""
    with _playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=_browser(), args=["--no-sandbox"])
        page = browser.new_context(viewport=size, color_scheme=scheme).new_page()
        page.goto(address)
        page.wait_for_selector("body[data-phase='docked']")
        for room in ("living room", "kitchen"):
            page.get_by_role("button", name=room).click()
        page.click("#clean")
        ends = time.monotonic() + _DEADLINE
        while _covered(page.inner_text("#covered")) < _CLEANED:
            if time.monotonic() > ends:
                raise RoombaError(f"expected {_CLEANED} m2 clean within {_DEADLINE:g} s")
            page.wait_for_timeout(200)
        picture = _decoded(page.screenshot())
        browser.close()
    return picture


def _decoded(screenshot: bytes) -> Picture:
    decoded: Any = cv2.imdecode(np.frombuffer(screenshot, np.uint8), cv2.IMREAD_COLOR)
    picture: Picture = decoded[:, :, ::-1].copy()
    return picture


def _covered(shown: str) -> float:
    """Return the area of "1.5 of 14.6 m²"; 0 for what is not known."""
    first = shown.split(" ")[0]
    return float(first) if first.replace(".", "").isdigit() else 0.0


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
