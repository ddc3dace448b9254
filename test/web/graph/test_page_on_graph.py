"""The page over the whole running graph, in a real browser."""

from __future__ import annotations

import json
import re
import shutil
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager

from fixtures.graph import WITH_PAGE, RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from playwright.sync_api import Page, sync_playwright
from std_msgs.msg import Bool

from roomba.history.database import History
from roomba.history.folder import history_folder
from roomba.history.run_rows import KeptRun

WORKS_WITHIN = 60_000
"""ms of wall time for what the robot does by its own clock."""
HEADING = "async () => (await import('/store.js')).get('state').pose[2]"
THINGS = "async () => (await import('/store.js')).get('state').truth.things.length"
TRUE_DIRT = """async () => {
    const { grid } = await import("/map/grids.js");
    return grid("true dirt")?.cells.reduce((sum, value) => sum + value, 0) ?? 0;
}"""
TAP = """async ([x, y]) => {
    const { tapped } = await import("/panels/offer.js");
    const { toScreen } = await import("/map/view.js");
    tapped(x, y, ...toScreen(x, y));
}"""


def address(graph: RosGraph) -> str:
    found = re.search(r"The page: (\S+)", graph.programs[-1].output)
    assert found
    return found[1]


@contextmanager
def open_page(graph: RosGraph) -> Iterator[Page]:
    """Open the page by the printed address, in a browser that belongs to this process."""
    program = shutil.which("chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        page = browser.new_page()
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(address(graph))
        page.wait_for_selector("body[data-link='live']", timeout=WORKS_WITHIN)
        yield page
        browser.close()
        assert errors == []


def wait_for_phase(page: Page, phase: str) -> None:
    page.wait_for_selector(f"body[data-phase='{phase}']", timeout=WORKS_WITHIN)


def kept_runs() -> list[KeptRun]:
    """Return the runs of the graph in the history."""
    runs = History(history_folder()).runs()
    return [run for run in runs if run.figures.source.program == "ros"]


def tell_of_a_person(graph: RosGraph) -> None:
    """Tell on the graph that a person is at home: the plans know it then."""
    api = address(graph).split("#")[0] + "api/v1/plans"

    def is_told() -> bool:
        with urllib.request.urlopen(api, timeout=5.0) as answer:
            return bool(json.load(answer)["is_person_home"])

    assert not is_told()
    Probe(graph).send("/person_at_home", Bool(True))
    wait_until(is_told, 10.0, "a person at home")


def test_it_is_served_on_loopback_alone_and_the_log_has_no_token(
    robot_with_page: RosGraph,
) -> None:
    shown = address(robot_with_page)
    assert shown.startswith("http://127.0.0.1:")
    token = shown.split("token=")[1]
    logs = [file for file in (robot_with_page.folder / "log").rglob("*.log") if file.is_file()]
    assert {f"{name}.log" for name in WITH_PAGE} <= {file.name for file in logs}
    assert not any(token in file.read_text(errors="replace") for file in logs)


def test_a_person_cleans_pauses_edits_and_stops(robot_with_page: RosGraph) -> None:
    with open_page(robot_with_page) as page:
        wait_for_phase(page, "docked")
        page.locator("#rooms button").first.wait_for(timeout=WORKS_WITHIN)
        page.locator("#camera summary").click()
        page.wait_for_function(
            "() => document.getElementById('camera-picture').naturalWidth > 100",
            timeout=WORKS_WITHIN,
        )
        page.locator("#rooms button").first.click()
        page.get_by_role("button", name="Clean 1 room").click()
        wait_for_phase(page, "cleaning")
        page.get_by_role("button", name="Pause").click()
        wait_for_phase(page, "paused")
        page.get_by_text("Drive by hand", exact=True).click()
        before = page.evaluate(HEADING)
        page.keyboard.down("ArrowLeft")
        wait_until(lambda: abs(page.evaluate(HEADING) - before) > 0.3, 60.0, "a turn")
        page.keyboard.up("ArrowLeft")
        page.keyboard.press("Escape")
        wait_for_phase(page, "emergency stop")
        page.get_by_role("button", name="Release").click()
        wait_for_phase(page, "paused")
        page.get_by_role("button", name="Stop", exact=True).click()
        wait_for_phase(page, "idle")
        page.wait_for_function(
            "() => document.getElementById('last-text').innerText.includes('Stopped')",
            timeout=WORKS_WITHIN,
        )
        wait_until(lambda: kept_runs() != [], 10.0)
        (kept,) = kept_runs()
        source = kept.figures.source
        assert (source.home, source.seed) == ("flat", 0)
        assert source.repeat == "./roomba run home:=flat seed:=0"
        assert kept.figures.outcome == "stopped"
        assert kept.is_recorded
        page.locator("#rooms button").first.click()
        page.get_by_role("button", name="Rename").click()
        page.get_by_role("textbox", name="Name").fill("Den")
        page.get_by_role("button", name="OK").click()
        page.get_by_role("button", name="Den").wait_for(timeout=WORKS_WITHIN)
    tell_of_a_person(robot_with_page)
    # With no hand on it the page leaves the drive to others.
    wait_until(
        lambda: "/dashboard_node" not in robot_with_page.system_state()[0].get("/cmd_vel", []),
        10.0,
    )


def test_a_simulated_home_is_played_with_and_its_truth_shown(robot_with_page: RosGraph) -> None:
    place = [1.5, 1.5]
    with open_page(robot_with_page) as page:
        page.set_default_timeout(WORKS_WITHIN)

        def act(words: str) -> None:
            page.evaluate(TAP, place)
            page.locator("#offer").get_by_role("button", name=words).click()

        page.locator("#play summary").click()
        page.get_by_role("checkbox", name="Show the truth").check()
        page.get_by_text("Kitchen door: open").wait_for()
        page.get_by_role("button", name="Shut the kitchen door").click()
        page.get_by_text("Kitchen door: shut").wait_for()
        page.get_by_role("button", name="Open the kitchen door").click()
        page.get_by_text("Kitchen door: open").wait_for()
        things = page.evaluate(THINGS)
        act("Put a chair")
        wait_until(lambda: page.evaluate(THINGS) == things + 4, 20.0, "a chair's legs")
        page.get_by_role("button", name="Clear away").click()
        wait_until(lambda: page.evaluate(THINGS) == things, 20.0, "no chair")
        wait_until(lambda: page.evaluate(TRUE_DIRT) > 0, 20.0, "the dirt of the home")
        dirt = page.evaluate(TRUE_DIRT)
        act("Spill dirt")
        wait_until(lambda: page.evaluate(TRUE_DIRT) > dirt + 1000, 20.0, "more dirt")
        act("Put the robot here")
        page.wait_for_function(
            """async ([x, y]) => {
                const { pose } = (await import("/store.js")).get("state").truth;
                return Math.hypot(pose[0] - x, pose[1] - y) < 0.1;
            }""",
            arg=place,
        )
