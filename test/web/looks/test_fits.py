"""All of the page is visible: with long names, on the smallest phones, and in landscape."""

from __future__ import annotations

import pytest
from fixtures.waiting import wait_until
from playwright.sync_api import Locator
from web.conftest import EACH_SIZE, SIZES, Opened
from web.test_page import DEADLINE

LONG = "donaudampfschifffahrtsgesellschaftskapitänskajütenzimmer"
SMALLEST = (320, 640)
CLIPPED = """async (text) => {
    const { write } = await import("/map/trace.js"), said = [];
    const context = document.createElement("canvas").getContext("2d");
    context.fillText = (words) => said.push(words, context.measureText(words).width);
    write(context, text, 0, 0, { most: 96 });
    return said;
}"""


def box(place: Locator) -> tuple[float, float, float, float]:
    """Return left, top, right and bottom, px."""
    found = place.bounding_box()
    assert found is not None
    x, y, width, height = (found[name] for name in ("x", "y", "width", "height"))
    return x, y, x + width, y + height


def is_apart(one: Locator, other: Locator) -> bool:
    """Whether two things do not lie over each other."""
    left, top, right, bottom = box(one)
    from_left, from_top, to_right, to_bottom = box(other)
    return right <= from_left or to_right <= left or bottom <= from_top or to_bottom <= top


@EACH_SIZE
def test_a_long_name_leaves_room_for_all_else(opened: Opened) -> None:
    page, width = opened.page, opened.page.evaluate("() => innerWidth")
    opened.robot.rename_room("living room", LONG)
    page.wait_for_function(
        "(name) => document.querySelector('#rooms .name').textContent === name", arg=LONG
    )
    opened.tap(*opened.robot.home().rooms[0].anchor)
    page.locator("#offer").get_by_role("button", name="Go here").click()
    wait_until(lambda: LONG[1:] in page.inner_text("#headline"), DEADLINE, "its name")
    assert box(page.locator("#emergency"))[2] <= width
    assert is_apart(page.locator(".what h1"), page.locator(".figures"))
    page.keyboard.press("1")
    opened.show("rooms")
    page.get_by_role("button", name="Rename").click()
    page.locator("#ask-text").fill(LONG.upper())
    page.locator("#ask").get_by_role("button", name="OK").click()
    undo = page.get_by_role("button", name="Undo")
    undo.wait_for()
    left, _, right, _ = box(page.locator("#note"))
    assert 0 <= left < box(undo)[0] < box(undo)[2] < right <= width
    shown, long = page.evaluate(CLIPPED, LONG)
    assert shown.startswith("donau")
    assert shown.endswith("…")
    assert long <= 96
    assert page.evaluate(CLIPPED, "hall")[0] == "hall"


@EACH_SIZE
def test_what_is_in_one_row_is_in_line_and_apart(opened: Opened) -> None:
    opened.show("rooms")
    rooms = opened.page.locator("#rooms .room")
    rooms.nth(1).click()
    opened.page.locator("#rooms select").first.wait_for()
    first, second = box(rooms.nth(0)), box(rooms.nth(1))
    if opened.page.evaluate("() => innerWidth") == SIZES["tablet"][0]:
        assert first[1] == second[1]
        assert second[0] - first[2] >= 8
    else:
        assert first[0] == second[0]
        assert second[1] >= first[3]
    opened.page.click("#clean")
    opened.wait_for_phase("cleaning")
    # A number, which an ordered list has elsewhere, is not missing here.
    queue = opened.page.locator("#queue-list .name").first
    queue.wait_for()
    assert box(queue)[0] == box(opened.page.locator("#queue-title"))[0]


@pytest.mark.parametrize("size", [SMALLEST])
def test_the_scale_lies_beside_the_tools(opened: Opened) -> None:
    tools = opened.page.locator(".tools > :not(.scale)").all()
    for _ in range(4):
        assert all(is_apart(tool, opened.page.locator(".scale")) for tool in tools)
        opened.page.get_by_role("button", name="Zoom in").click()
        opened.page.wait_for_timeout(300)  # the scale follows four times a second


@pytest.mark.parametrize("size", [(844, 390)])
def test_on_a_phone_that_lies_the_map_is_no_thumbnail(opened: Opened) -> None:
    left, top, right, bottom = box(opened.page.locator("#floor"))
    assert min(right - left, bottom - top) > 0.75 * 390
    assert box(opened.page.locator("#pause"))[3] <= 390


@pytest.mark.parametrize("size", [SIZES["phone"]])
def test_outside_of_the_home_nothing_is_offered(opened: Opened) -> None:
    left, top, _, _ = box(opened.page.locator("#floor"))
    opened.page.mouse.click(left + 12, top + 12)
    assert opened.page.is_hidden("#offer")
    opened.tap(*opened.robot.home().rooms[0].anchor)
    opened.page.locator("#offer").wait_for()


@EACH_SIZE
def test_a_wide_window_has_the_rate_of_dirt_under_the_map(opened: Opened) -> None:
    page, rate = opened.page, opened.page.locator("#rate")
    width, height = page.evaluate("() => [innerWidth, innerHeight]")
    is_wide = (width, height) == SIZES["desktop"]
    assert rate.is_visible() == is_wide
    if not is_wide:
        return
    page.click("#clean")
    opened.wait_for_phase("cleaning")
    wait_until(lambda: page.inner_text("#rate-title") > "Dirt 0.05", DEADLINE, "a rate of dirt")
    assert rate.get_by_role("img", name="g/min, the last ten minutes").count() == 1
    _, top, right, bottom = box(rate)
    assert top == box(page.locator("#floor"))[3]
    assert (right, bottom) == (box(page.locator(".map"))[2], height)
    tops = "line => Math.min(...line.getAttribute('points').split(' ').map(at => at.split(',')[1]))"
    # The line rises above the middle of its picture.
    assert page.locator("#rate-line .line").evaluate(tops) < 32


def test_the_browser_keeps_the_page_clear_of_a_notch(opened: Opened) -> None:
    """With viewport-fit=cover the page would lie below it, and had to keep clear itself."""
    content = opened.page.get_attribute("meta[name=viewport]", "content")
    assert content is not None
    assert "viewport-fit" not in content
