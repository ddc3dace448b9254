"""Playing on the page with a simulated home: what is done there is really done."""

from __future__ import annotations

import math

import pytest
from fixtures.waiting import wait_until
from web.conftest import SIZES, Opened
from web.test_page import DEADLINE

from roomba.client.view import LayerName, TruthView

CARD = "#offer"
COLOUR_AT = """async (place) => {
    const { toScreen } = await import("/map/view.js"), [x, y] = toScreen(...place);
    const context = document.getElementById("floor").getContext("2d");
    return [...context.getImageData(x * devicePixelRatio, y * devicePixelRatio, 1, 1).data];
}"""


@pytest.fixture
def playing(opened: Opened) -> Opened:
    """The page with the part for playing open."""
    opened.show("more")
    opened.page.locator("#play summary").click()
    opened.show_map()
    return opened


def truth_of(opened: Opened) -> TruthView:
    truth = opened.robot.robot().truth
    assert truth is not None
    return truth


def act(opened: Opened, place: tuple[float, float], words: str) -> None:
    """Tap a place of the floor, and choose what shall happen there."""
    opened.tap(*place)
    opened.page.locator(CARD).get_by_role("button", name=words).click()


def test_dirt_chairs_doors_and_the_station(playing: Opened) -> None:
    page, room = playing.page, playing.robot.home().rooms[0]
    things = len(truth_of(playing).things)
    act(playing, room.anchor, "Put a chair")
    wait_until(lambda: len(truth_of(playing).things) == things + 4, DEADLINE, "a chair's legs")
    before = playing.robot.layer(LayerName.TRUE_DIRT)
    assert before is not None
    act(playing, room.anchor, "Spill dirt")

    def is_spilled() -> bool:
        now = playing.robot.layer(LayerName.TRUE_DIRT)
        return now is not None and now.cells.sum(dtype=int) > before.cells.sum(dtype=int) + 1000

    wait_until(is_spilled, DEADLINE, "dirt")
    door = next(door for door in truth_of(playing).doors if door.name == "kitchen door")
    left, low, right, high = door.opening
    act(playing, ((left + right) / 2, (low + high) / 2), "Shut the door")
    wait_until(
        lambda: [d.name for d in truth_of(playing).doors if d.is_shut] == ["kitchen door"],
        DEADLINE,
        "a shut door",
    )
    playing.show("more")
    page.get_by_role("button", name="Open the kitchen door").click()
    wait_until(lambda: not any(d.is_shut for d in truth_of(playing).doors), DEADLINE, "it open")
    page.get_by_role("button", name="Block the station").click()
    wait_until(lambda: len(truth_of(playing).things) == things + 5, DEADLINE, "a box")
    page.get_by_role("button", name="Clear away").click()
    wait_until(lambda: len(truth_of(playing).things) == things, DEADLINE, "all gone")


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_the_robot_is_dragged_elsewhere(playing: Opened) -> None:
    page = playing.page
    x, y = playing.robot.robot().pose[:2]
    page.mouse.move(*playing.pixels(x, y))
    page.mouse.down()
    page.mouse.move(*playing.pixels(1.0, 1.0), steps=4)
    wait_until(lambda: truth_of(playing).is_lifted, DEADLINE, "the robot to be lifted")
    page.get_by_text("Lifted off the floor").wait_for()
    page.mouse.move(*playing.pixels(1.2, 2.2), steps=4)
    page.mouse.up()
    wait_until(lambda: not truth_of(playing).is_lifted, DEADLINE, "the robot on the floor")
    assert math.dist(truth_of(playing).pose[:2], (1.2, 2.2)) < 0.05


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_the_truth_is_laid_over_the_belief_where_it_is_offered(playing: Opened) -> None:
    page, door = playing.page, "kitchen door"
    playing.robot.set_door(door, is_shut=True)
    left, low, right, high = next(d.opening for d in truth_of(playing).doors if d.name == door)
    middle = [(left + right) / 2, (low + high) / 2]

    def is_violet() -> bool:
        red, green, blue, _ = page.evaluate(COLOUR_AT, middle)
        return bool(blue > red + 20 > green + 40)

    page.get_by_text("Kitchen door: shut").wait_for(state="attached")
    assert not is_violet()
    page.get_by_role("checkbox", name="Show the truth").check()
    assert page.locator("#layers input").last.is_checked()
    wait_until(is_violet, DEADLINE, "the shut door to be drawn")
    anchor = playing.robot.home().rooms[0].anchor
    playing.tap(*anchor)
    assert "Spill dirt" in page.locator(f"{CARD} button").all_inner_texts()
    page.evaluate(
        """async () => {
            const { get, set } = await import("/store.js");
            set("limits", { ...get("limits"), play: [] });
        }"""
    )
    assert not page.locator("#play").is_visible()
    playing.tap(*anchor)
    assert page.locator(f"{CARD} button").all_inner_texts() == ["Go here", "Clean here"]
