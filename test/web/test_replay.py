"""A recorded run on the page: its time is dragged, and nothing is driven."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import pytest
from fixtures.pages.windows import Windows
from fixtures.waiting import wait_until
from playwright.sync_api import Page
from web.conftest import page_at, serving
from web.test_page import DEADLINE, check_it_can_be_read

from roomba.history.replay import RecordedRobot
from roomba.history.run import RunFigures, RunRecording
from roomba.history.unfinished import INTERRUPTED, WHY
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token

SWEPT = """async () => {
    const { grid } = await import("/map/grids.js");
    return grid("coverage")?.cells.reduce((sum, value) => sum + (value > 0), 0) ?? 0;
}"""
DRAG = """(at) => {
    const slider = document.getElementById("replay-at");
    slider.value = at;
    slider.dispatchEvent(new Event("input"));
}"""


@dataclass
class Replayed:
    """A page over a recording."""

    page: Page
    robot: RecordedRobot
    recording: RunRecording

    def drag_to(self, at: float) -> None:
        self.page.evaluate(DRAG, at)
        wait_until(lambda: abs(self.robot.timeline().at - at) < 0.5, DEADLINE, f"the time {at:g} s")

    def wait_for_swept(self, least: int, most: int) -> None:
        wait_until(
            lambda: least <= self.swept() <= most, DEADLINE, f"{least} to {most} swept cells"
        )

    def swept(self) -> int:
        return int(self.page.evaluate(SWEPT))


@contextmanager
def replaying(
    windows: Windows, run: tuple[RunFigures, RunRecording], size: tuple[int, int]
) -> Iterator[Replayed]:
    """Open the page over a recording."""
    robot, guard = RecordedRobot(*run), Guard(new_token())
    with (
        serving(create_app(robot, guard)) as server,
        page_at(windows, f"{server.address}#token={guard.token}", size) as page,
    ):
        page.wait_for_selector("#timeline:not([hidden])")
        yield Replayed(page, robot, run[1])


@pytest.fixture
def replayed(
    windows: Windows, recorded: tuple[RunFigures, RunRecording], size: tuple[int, int]
) -> Iterator[Replayed]:
    with replaying(windows, recorded, size) as replayed:
        yield replayed


def test_dragging_shows_another_time(replayed: Replayed) -> None:
    page, duration = replayed.page, replayed.recording.duration
    assert page.inner_text("#headline").startswith("Recorded: ")
    assert page.is_hidden("#rate")
    replayed.wait_for_swept(0, 40)
    replayed.drag_to(duration)
    tab = page.locator("[data-tab=more]")
    if tab.is_visible():
        tab.click()
    page.wait_for_selector("#last:not([hidden])")
    assert "Completed" in page.inner_text("#last-text")
    assert "m² a minute" in page.inner_text("#last-text")
    page.locator("#last-times summary").click()
    assert "times the least time for that floor" in page.inner_text("#last-least")
    assert "Turning on the spot: " in page.inner_text("#last-parts")
    wait_until(lambda: replayed.swept() > 5000, DEADLINE, "swept floor")
    whole = replayed.swept()
    replayed.drag_to(0.5 * duration)
    replayed.wait_for_swept(whole // 4, 3 * whole // 4)
    page.wait_for_selector("#last[hidden]", state="attached")
    trail = page.evaluate("async () => (await import('/store.js')).get('trail').length")
    assert 0 < trail <= len(replayed.recording.trace) // 2 + 2
    replayed.drag_to(0.0)
    replayed.wait_for_swept(0, 40)


@pytest.fixture
def interrupted(recorded: tuple[RunFigures, RunRecording]) -> tuple[RunFigures, RunRecording]:
    """The clean, as it is kept when its program ended in the middle of it."""
    figures, recording = recorded
    return replace(figures, outcome=INTERRUPTED, message=WHY), recording


def test_a_run_that_was_interrupted_is_called_so_and_no_fault(
    windows: Windows, interrupted: tuple[RunFigures, RunRecording], size: tuple[int, int]
) -> None:
    with replaying(windows, interrupted, size) as replayed:
        page = replayed.page
        replayed.drag_to(replayed.recording.duration)
        tab = page.locator("[data-tab=more]")
        if tab.is_visible():
            tab.click()
        page.wait_for_selector("#last:not([hidden])")
        assert page.inner_text("#last-text").startswith("Interrupted · ")
        assert "fault" not in page.inner_text("body").lower()


def test_the_time_line_is_whole_on_the_smallest_phone(replayed: Replayed) -> None:
    page = replayed.page
    page.set_viewport_size({"width": 320, "height": 640})
    bottom = page.evaluate("() => document.querySelector('.map').getBoundingClientRect().bottom")
    for part in ("#replay-play", "#replay-at", "#replay-speed"):
        box = page.locator(part).bounding_box()
        assert box is not None
        assert box["x"] + box["width"] <= 320
        assert box["y"] + box["height"] <= bottom
    # It is no part of the page of a robot.
    assert page.is_hidden("#replay-back")


def test_the_keyboard_plays_and_drags(replayed: Replayed) -> None:
    page = replayed.page
    page.locator("#floor").focus()
    page.keyboard.press(" ")
    wait_until(lambda: replayed.robot.timeline().is_playing, DEADLINE, "the recording to go on")
    page.wait_for_function("() => document.getElementById('replay-play').textContent === 'Pause'")
    wait_until(lambda: replayed.robot.timeline().at > 3.0, DEADLINE, "time to pass")
    page.keyboard.press(" ")
    wait_until(lambda: not replayed.robot.timeline().is_playing, DEADLINE, "the recording to stand")
    before = replayed.robot.timeline().at
    page.locator("#replay-at").focus()
    page.keyboard.press("PageUp")
    wait_until(lambda: replayed.robot.timeline().at > before + 10.0, DEADLINE, "a later time")
    page.select_option("#replay-speed", "100")
    wait_until(lambda: replayed.robot.timeline().speed == 100.0, DEADLINE, "another speed")


def test_it_can_be_read_and_touched_and_commands_are_refused(replayed: Replayed) -> None:
    page = replayed.page
    check_it_can_be_read(page, least_controls=8)
    for name in ("#clean", "#emergency", "#draw-no-go", "details.drive"):
        assert not page.locator(name).is_visible()
    told = page.evaluate(
        """async () => {
            const { wish } = await import("/link.js");
            await wish("clean", {});
            return document.getElementById("refusal").textContent;
        }"""
    )
    assert "recorded run" in told
    page.mouse.click(*(0.5 * side for side in page.evaluate("() => [innerWidth, innerHeight / 2]")))
    assert not page.locator("#offer").is_visible()
