"""Pictures of each state of the page, in each width, light and dark, to be looked at.

They are saved as ``.cache/screenshots/STATE-WIDTH-SCHEME.png``. For each the test asserts:
nothing lies beyond the window's sides, and the button that stops the robot is within it.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from fixtures.pages.windows import Windows
from fixtures.waiting import wait_until
from playwright.sync_api import Page
from unit.history.made import made_figures, made_recording
from web.conftest import SIZES, Opened, in_each_scheme, serving
from web.test_explored import EDGES, explore
from web.test_replay import replaying

from roomba.clean_request import CleanRequest
from roomba.client.household import TotalsView
from roomba.client.view import ZoneView
from roomba.commands.play.living import live_client
from roomba.configuration.household import HouseholdConfig, UpkeepConfig
from roomba.headless.live.client import LiveClient
from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper
from roomba.history.run import RunFigures, RunRecording, RunSource
from roomba.household.household import LiveHousehold
from roomba.mission.exploring.exploration import Exploration
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.ui.web.server import PageServer
from roomba.vocabulary import CleanMode

pytestmark = pytest.mark.thorough
FOLDER = Path(__file__).resolve().parents[3] / ".cache" / "screenshots"
DEADLINE = 60.0
SETTLED = 400
"""ms until what appears has done so."""
BEYOND = """() => [...document.querySelectorAll("body *")].filter((part) => {
    const box = part.getBoundingClientRect();
    return box.width > 1 && box.height > 1 && (box.left < -1 || box.right > innerWidth + 1)
        && getComputedStyle(part).clipPath === "none" && !part.closest(".wide, .unseen");
}).map((part) => part.outerHTML.slice(0, 80))"""
"""What lies beyond the left or the right side of the window."""
OPEN = """(selector) => {
    const part = document.querySelector(selector);
    part.open = true;
    part.scrollIntoView();
}"""
"""Unfolds a part of the commands."""
PRESS = "(id) => document.getElementById(id).click()"
"""A button that may lie in a closed sheet."""
REFUSED = """async () => {
    const { wish } = await import("/link.js");
    wish("clean", { mode: "rooms", rooms: ["cellar"] });
}"""

Step = Callable[[Opened], object]


def nothing(_: Opened) -> None:
    """Do nothing."""


@dataclass(frozen=True)
class State:
    """How a state of the page is reached."""

    begin: Step = nothing
    """Once, in a desktop's window."""
    again: Step = nothing
    """In each window and scheme, before the picture."""
    part: str | None = None
    """Of the commands, which is open in the sheet of a phone."""
    home: str = "flat"
    speed: float = 10.0
    knows_map: bool = True


def press_button(identity: str) -> Step:
    return lambda opened: opened.page.evaluate(PRESS, identity)


def press(key: str) -> Step:
    return lambda opened: opened.page.keyboard.press(key)


def clean(opened: Opened) -> None:
    """Let it clean two rooms until some of the floor is green."""
    opened.robot.clean(
        CleanRequest(mode=CleanMode.ROOMS, rooms=("kitchen", "bathroom"), in_order=True)
    )
    wait_until(lambda: opened.robot.robot().vacuum.covered > 3.0, DEADLINE, "clean floor")


def pause(opened: Opened) -> None:
    clean(opened)
    opened.page.click("#pause")
    opened.wait_for_phase("paused")


def stop(opened: Opened) -> None:
    clean(opened)
    opened.page.keyboard.press("Escape")
    opened.wait_for_phase("emergency stop")


def shut_in(opened: Opened) -> None:
    """Let it wait in a room whose door was shut behind it."""
    opened.robot.clean(CleanRequest(mode=CleanMode.ROOMS, rooms=("bathroom",)))
    wait_until(lambda: opened.robot.robot().vacuum.covered > 1.5, DEADLINE, "clean floor")
    opened.robot.set_door("bathroom door", is_shut=True)
    opened.page.click("#dock")
    opened.page.locator("#explanation").get_by_text("It looks again within").wait_for(
        timeout=60_000
    )


def fall_silent(opened: Opened) -> None:
    """Let the robot tell nothing until the page is closed."""
    goes_on = threading.Event()
    opened.page.on("close", lambda _: goes_on.set())
    held = threading.Thread(target=lambda: opened.robot.ask(lambda _: goes_on.wait(30.0), 40.0))
    held.start()
    opened.page.wait_for_selector("body[data-link='stale']")


def go(opened: Opened) -> None:
    opened.robot.end()
    opened.page.wait_for_selector("body[data-link='gone']")


def cut(opened: Opened) -> None:
    opened.server.stop()
    opened.page.wait_for_selector("body[data-link='reconnecting']")


def choose(opened: Opened) -> None:
    for room in ("kitchen", "bathroom", "bedroom"):
        opened.page.locator(f"#rooms [data-room='{room}']").click()


def tap(opened: Opened) -> None:
    opened.page.locator("#headline").click()  # the card closes
    opened.page.evaluate("async () => (await import('/store.js')).set('chosen', [])")
    opened.tap(*opened.robot.home().rooms[0].anchor)
    opened.page.locator("#offer").wait_for()


def put_zones(opened: Opened) -> None:
    """One of each kind."""
    for kind, low in (("no-go", 0.0), ("carpet", 1.5)):
        corners = ((1.5, low), (2.5, low), (2.5, low + 1.0), (1.5, low + 1.0))
        opened.robot.put_zone(ZoneView(f"a {kind}", kind, corners))
    opened.robot.put_zone(ZoneView("a wall", "wall", ((1.0, 3.0), (2.5, 3.0))))
    opened.page.locator("#zones .pick").nth(2).wait_for()


def begin_to_explore(opened: Opened) -> None:
    opened.page.click("#explore")
    opened.wait_for_phase("exploring")


def explore_openly(opened: Opened) -> None:
    explore(opened)
    opened.page.locator("#explanation").get_by_text("The map stays open").wait_for()
    opened.page.wait_for_selector("#last-edges li", state="attached")


def show_layers(opened: Opened) -> None:
    opened.page.locator(".layers summary").click()
    for name in ("Lidar", "Dirt found", "The truth"):
        box = opened.page.get_by_role("checkbox", name=name)
        if box.is_visible():
            box.check()


def name_room(opened: Opened) -> None:
    opened.page.keyboard.press("1")
    opened.page.evaluate(PRESS, "rename")
    opened.page.locator("#ask[open]").wait_for()


def make_plan(opened: Opened) -> None:
    opened.page.evaluate(PRESS, "plan-new")
    opened.page.locator("#plan-form[open]").wait_for()


def open_part(identity: str) -> Step:
    return lambda opened: opened.page.evaluate(OPEN, f"#{identity}")


STATES = {
    "docked": State(),
    "no-map": State(lambda opened: opened.page.wait_for_selector("#no-map"), knows_map=False),
    "rooms-chosen": State(choose),
    "rooms-chosen-list": State(choose, part="rooms"),
    "floor-tapped": State(again=tap),
    "zones": State(put_zones, part="zones"),
    "layers": State(show_layers),
    "more": State(part="more"),
    **{
        f"more-{name}": State(again=open_part(name), part="more")
        for name in ("camera", "charts", "plans", "play", "upkeep")
    },
    "cleaning": State(clean),
    "cleaning-list": State(clean, part="rooms"),
    "paused": State(pause),
    "emergency-stop": State(stop),
    "shut-door": State(shut_in, speed=20.0),
    "stale": State(fall_silent),
    "gone": State(go),
    "reconnecting": State(cut),
    "refused": State(again=lambda opened: opened.page.evaluate(REFUSED)),
    "exploring": State(
        begin_to_explore,
        knows_map=False,
    ),
    "open-edges": State(explore_openly, home="studio", speed=20.0, knows_map=False),
    "open-edges-list": State(
        explore_openly, part="more", home="studio", speed=20.0, knows_map=False
    ),
    "history": State(
        lambda opened: opened.page.evaluate("() => document.getElementById('history-open').click()")
    ),
    "dialog-keys": State(press("?")),
    "dialog-name": State(name_room),
    "dialog-plan": State(make_plan),
}


@pytest.fixture
def home(name: str) -> str:
    return STATES[name].home


@pytest.fixture
def speed(name: str) -> float:
    return STATES[name].speed


@pytest.fixture
def knows_map(name: str) -> bool:
    return STATES[name].knows_map


@pytest.fixture
def served(
    home: str, speed: float, knows_map: bool, tmp_path: Path
) -> Iterator[tuple[LiveClient, PageServer, Guard]]:
    """A robot with a history and a household, and its page."""
    history = History(tmp_path)
    history.add(made_figures())
    history.add(made_figures(), made_recording())
    robot = live_client(home, seed=1, speed=speed, knows_map=knows_map)
    keeper = HistoryKeeper(history, RunSource("play", home, 1), print)
    household = LiveHousehold(
        robot,
        tmp_path,
        HouseholdConfig(upkeep=UpkeepConfig(sensors=0.05)),
        100.0,
        print,
        lambda: TotalsView(12, 340.0, 9000.0, 2500.0, 40.0, 60.0),
    )
    guard = Guard(new_token())
    robot.start()
    household.start()
    with serving(create_app(robot, guard, keeper, household=household)) as server:
        yield robot, server, guard
    household.stop()
    robot.end()


def take(page: Page, name: str, again: Callable[[], object]) -> None:
    """Take the picture in each window, light and dark."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for width, height in SIZES.values():
        page.set_viewport_size({"width": width, "height": height})
        for scheme in in_each_scheme(page):
            again()
            page.wait_for_timeout(SETTLED)
            page.screenshot(path=FOLDER / f"{name}-{width}-{scheme}.png")
            assert page.evaluate(BEYOND) == [], (name, width)
            for button in page.locator(".emergency:visible").all():
                box = button.bounding_box()
                assert box is not None
                assert box["y"] >= 0.0
                assert box["y"] + box["height"] <= height


@pytest.mark.parametrize("size", [SIZES["desktop"]])
@pytest.mark.parametrize("name", STATES)
def test_a_state(monkeypatch: pytest.MonkeyPatch, name: str, opened: Opened) -> None:
    monkeypatch.setattr(Exploration, "open_edges", lambda *_: EDGES)
    state = STATES[name]
    state.begin(opened)

    def again() -> None:
        if state.part is not None:
            opened.show(state.part)
        state.again(opened)

    take(opened.page, name, again)


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_a_replay(
    windows: Windows, recorded: tuple[RunFigures, RunRecording], size: tuple[int, int]
) -> None:
    with replaying(windows, recorded, size) as replayed:
        replayed.drag_to(0.5 * replayed.recording.duration)
        take(replayed.page, "replay", lambda: None)
