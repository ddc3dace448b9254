"""The end of an exploration on the page: what was mapped, and where the map stays open."""

from __future__ import annotations

import pytest
from fixtures.waiting import wait_until
from playwright.sync_api import Page
from web.conftest import Opened, in_each_scheme
from web.looks.test_accessible import check_with_axe
from web.test_page import DEADLINE

from roomba.grid import OccupancyMap
from roomba.mission.exploring.exploration import Exploration
from roomba.vocabulary import EdgeReason, OpenEdge

EDGES = (
    OpenEdge(2.0, 2.0, 1.0, EdgeReason.NO_ECHO),
    OpenEdge(1.5, 4.0, 2.0, EdgeReason.NOT_LOOKED_AT),
)
COLOURS = """async ([x, y]) => {
    const { toScreen } = await import("/map/view.js");
    const canvas = document.getElementById("floor"), ratio = canvas.width / canvas.clientWidth;
    const [px, py] = toScreen(x, y), context = canvas.getContext("2d");
    return [...context.getImageData(ratio * (px - 8), ratio * py, 1, 1).data];
}"""
"""Of the map, beside the middle of a place."""
MIDDLE = """async ([x, y]) => {
    const { toScreen, view } = await import("/map/view.js"), [px, py] = toScreen(x, y);
    return Math.hypot(px - view.width / 2, py - view.height / 2) < 2;
}"""
DOUBTED = """async (edges) => (await import("/words.js")).lastRun({
    outcome: "completed", wanted: 20, covered: 20, open_edges: edges,
    message: "the map is open for 2.0 m; its place was known only roughly",
})"""
"""How a clean that explored is told, whose place was not known well either."""
WARNS = {"light": [168, 67, 0, 255], "dark": [255, 176, 102, 255]}


@pytest.fixture
def edges(monkeypatch: pytest.MonkeyPatch) -> tuple[OpenEdge, ...]:
    """Where the map of the home that is explored is said to stay open."""

    def told(_: Exploration, known: OccupancyMap) -> tuple[OpenEdge, ...]:
        return EDGES

    monkeypatch.setattr(Exploration, "open_edges", told)
    return EDGES


def explore(opened: Opened) -> None:
    """Let the robot explore to the end."""
    opened.page.get_by_role("button", name="Explore").click()
    opened.wait_for_phase("exploring")
    opened.wait_for_phase("docked")


def wait_for_mark(page: Page, edge: OpenEdge, scheme: str, *, is_there: bool = True) -> None:
    """Wait until the mark of an edge is on the map, or is not."""
    place, wanted = [edge.x, edge.y], WARNS[scheme]
    wait_until(lambda: (page.evaluate(COLOURS, place) == wanted) == is_there, DEADLINE, str(edge))


@pytest.mark.parametrize("home", ["studio"])
@pytest.mark.parametrize("speed", [20.0])
@pytest.mark.parametrize("knows_map", [False])
def test_where_the_map_stays_open_is_said_listed_and_shown_on_the_map(
    edges: tuple[OpenEdge, ...], opened: Opened
) -> None:
    page = opened.page
    explore(opened)
    page.locator("#explanation").get_by_text("The map stays open for 3.5 m in 2 places").wait_for()
    opened.show("more")
    last = page.locator("#last")
    last.get_by_text("m² mapped").wait_for()
    text = page.inner_text("#last-text")
    assert text.startswith("Completed · ")
    assert "the map is open" not in text.lower()  # the list beside it says that
    doubted = page.evaluate(DOUBTED, [{"length": 2.0}])
    assert doubted == "Completed · 20.0 of 20.0 m². Its place was known only roughly."
    picks = last.locator("#last-edges button")
    assert picks.all_inner_texts() == [
        f"{name}\n{edge.length:.1f} m: {edge.reason.value}"
        for name, edge in zip("AB", edges, strict=True)
    ]
    check_with_axe(opened)
    picks.nth(1).click()
    assert picks.nth(1).get_attribute("aria-pressed") == "true"
    # On a phone the sheet gives way to the map.
    assert page.locator("#last").is_hidden() == page.locator("[data-tab=more]").is_visible()
    second = [edges[1].x, edges[1].y]
    assert page.evaluate(MIDDLE, second)
    for scheme in in_each_scheme(page):
        for edge in edges:
            wait_for_mark(page, edge, scheme)
    opened.show("more")
    picks.nth(1).click()
    assert picks.nth(1).get_attribute("aria-pressed") == "false"
    opened.show_map()
    page.locator(".layers summary").click()
    page.get_by_role("checkbox", name="Where the map is open").uncheck()
    wait_for_mark(page, edges[1], "dark", is_there=False)


@pytest.mark.parametrize("home", ["hall"])
@pytest.mark.parametrize("speed", [50.0])
@pytest.mark.parametrize("knows_map", [False])
def test_a_hall_that_is_longer_than_its_lidar_sees_stays_open(opened: Opened) -> None:
    page = opened.page
    explore(opened)
    page.locator("#explanation").get_by_text("The map stays open for").wait_for()
    assert page.inner_text("#explanation").endswith(
        "in one place: it looked there and the lidar met nothing: too far away, black, or of glass."
    )
    opened.show("more")
    assert page.locator("#last-edges button").count() == 1


@pytest.mark.parametrize("home", ["studio"])
@pytest.mark.parametrize("speed", [20.0])
@pytest.mark.parametrize("knows_map", [False])
def test_where_a_map_is_whole_nothing_is_said_to_be_open(opened: Opened) -> None:
    page = opened.page
    explore(opened)
    opened.show("more")
    page.locator("#last-text").get_by_text("m² mapped").wait_for()
    assert page.inner_text("#explanation") == ""
    assert page.is_hidden("#last-open")
    opened.show_map()
    page.locator(".layers summary").click()
    assert page.get_by_role("checkbox", name="Where the map is open").is_hidden()
