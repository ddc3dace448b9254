"""What a person does on the page, in a real browser, with what the robot then does."""

from __future__ import annotations

from pathlib import Path

import pytest
from fixtures.waiting import wait_until
from PIL import Image
from playwright.sync_api import Page, Route
from web.conftest import Opened, in_each_scheme

from roomba.client.view import ZoneView
from roomba.headless.embodied import Embodied
from roomba.vocabulary import FanLevel, RoomWay

DEADLINE = 20.0
"""s of wall time."""

COUNT_COLOURS = """() => {
    const canvas = document.getElementById("floor"), seen = new Set();
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    for (let at = 0; at < data.length; at += 4)
        seen.add(data[at] << 16 | data[at + 1] << 8 | data[at + 2]);
    return seen.size;
}"""
CONTRASTS = """() => {
    const part = (text) => text.match(/[\\d.]+/g).map(Number);
    const linear = (value) => value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    const weights = [0.2126, 0.7152, 0.0722];
    const light = ([r, g, b]) => [r, g, b].map((value) => linear(value / 255))
        .reduce((sum, value, index) => sum + value * weights[index], 0);
    const behind = (element) => {
        for (let at = element; at; at = at.parentElement) {
            const colour = part(getComputedStyle(at).backgroundColor);
            if (colour.length === 3 || colour[3] > 0) return colour;
        }
    };
    const kinds = "h1, h2, p, dt, dd, button, label, summary, .area";
    return [...document.querySelectorAll(kinds)]
        .filter((element) => element.innerText && element.offsetParent && !element.disabled)
        .map((element) => {
            const one = light(part(getComputedStyle(element).color));
            const other = light(behind(element));
            const ratio = (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
            return [element.innerText, ratio];
        });
}"""
CONTROLS = """() => [...document.querySelectorAll("button, select, summary, canvas")]
    .filter((element) => element.offsetParent)
    .map((element) => {
        const { width, height } = element.getBoundingClientRect();
        const label = element.labels?.[0]?.textContent;
        const name = element.getAttribute("aria-label") || element.textContent || label;
        return [element.id, name, width, height];
    })"""


DRAW_WAY = """async (points) => {
    const { set } = await import("/store.js"), { drawTrail } = await import("/map/moving.js");
    const drawn = [], paper = { beginPath() {}, stroke() {} };
    paper.moveTo = () => drawn.push("to");
    paper.lineTo = () => drawn.push("along");
    set("trail", points);
    drawTrail(paper);
    return drawn.filter((how) => how === "along").length;
}"""


def colours(opened: Opened) -> int:
    """Return how many different colours the map has."""
    return int(opened.page.evaluate(COUNT_COLOURS))


def test_the_map_is_drawn_and_the_state_is_said(opened: Opened) -> None:
    page = opened.page
    assert page.inner_text("#headline") == "On its station, ready"
    assert "%" in page.inner_text("#battery")
    names = [room.name for room in opened.robot.home().rooms]
    opened.show("rooms")
    shown = page.locator("#rooms .name").all_text_contents()
    assert shown == names
    assert colours(opened) > 20


def test_where_the_robot_was_carried_or_not_seen_no_way_is_drawn(opened: Opened) -> None:
    def lines(*points: list[float]) -> int:
        return int(opened.page.evaluate(DRAW_WAY, points))

    assert lines([0, 0], [0.1, 0], [0.1, 0.5], [0.2, 0.5]) == 3
    assert lines([0, 0], [0.1, 0], [0.1, 0.5, True], [0.2, 0.5]) == 2
    assert lines([0, 0], [0.1, 0], [0.1, 1.5], [0.2, 1.5]) == 2


@pytest.mark.parametrize("speed", [20.0])
def test_a_person_cleans_two_rooms_in_order(opened: Opened) -> None:
    page = opened.page
    opened.show("rooms")
    kitchen = page.locator("#rooms [data-room=kitchen]")
    page.get_by_role("button", name="hallway").click()
    kitchen.click()
    assert kitchen.get_attribute("aria-pressed") == "true"
    assert kitchen.locator(".order").inner_text() == "2"
    page.get_by_role("button", name="Clean 2 rooms").click()
    opened.wait_for_phase("cleaning")
    area = {room.name: room.area for room in opened.robot.home().rooms}
    wanted = opened.robot.robot().vacuum.wanted
    assert wanted < area["hallway"] + area["kitchen"]
    assert wanted > 0.5 * (area["hallway"] + area["kitchen"])
    page.get_by_role("button", name="Pause").click()
    opened.wait_for_phase("paused")
    page.get_by_role("button", name="Go on").click()
    opened.wait_for_phase("cleaning")
    page.get_by_role("button", name="Stop", exact=True).click()
    opened.wait_for_phase("idle")
    assert "Stopped" in page.inner_text("#last-text")
    page.get_by_role("button", name="Dock").click()
    opened.wait_for_phase("docked")


def test_tapping_the_map_chooses_a_room_or_cleans_a_spot(opened: Opened) -> None:
    page = opened.page
    room = opened.robot.home().rooms[0]
    opened.tap(*room.anchor)
    page.get_by_text(f"{room.name} is number 1", exact=False).wait_for()
    assert page.inner_text("#clean") == "Clean 1 room"
    opened.tap(*room.anchor)
    assert page.inner_text("#clean") == "Clean all"
    page.get_by_role("button", name="Clean here").click()
    opened.wait_for_phase("cleaning")
    assert opened.robot.robot().vacuum.wanted <= 1.5**2 + 0.1
    assert page.inner_text("#clean") == "Clean 1 room"


def test_zones_are_given_up_drawn_and_removed(opened: Opened) -> None:
    page = opened.page
    opened.show("zones")
    page.get_by_role("button", name="No-go zone").click()
    page.get_by_text("Drag over the floor").wait_for()
    page.locator("#hint").get_by_role("button", name="Cancel").click()
    assert not page.locator("#hint").is_visible()
    for kind, corners in (("No-go zone", 4), ("Virtual wall", 2)):
        zone = draw_and_remove(opened, kind)
        assert len(zone.points) == corners
        opened.robot.remove_zone(zone.name)
        page.locator("#zones li").wait_for(state="detached")


def draw_and_remove(opened: Opened, kind: str) -> ZoneView:
    """Draw a zone on the page, remove it, and take that back; return it."""
    page = opened.page
    opened.show("zones")
    page.get_by_role("button", name=kind).click()
    opened.show_map()
    x, y = opened.robot.home().rooms[0].anchor
    opened.drag((x - 0.5, y - 0.3), (x, y), (x + 0.5, y + 0.4))
    wait_until(lambda: len(opened.robot.home().zones) == 1, DEADLINE, "a zone")
    (zone,) = opened.robot.home().zones
    assert zone.points[0] == pytest.approx((x - 0.5, y - 0.3), abs=0.05)
    opened.show("zones")
    page.get_by_role("button", name=f"Remove {zone.name}").click()
    wait_until(lambda: not opened.robot.home().zones, DEADLINE, "no zone")
    # What was drawn could be undone as well, until the page has heard that it is gone.
    page.get_by_text(f"{zone.name} is removed").wait_for()
    page.get_by_role("button", name="Undo").click()
    wait_until(lambda: opened.robot.home().zones == (zone,), DEADLINE, "the zone again")
    page.locator("#zones li").wait_for(state="attached")
    return zone


def test_a_room_gets_another_name_and_a_cut_that_is_none_is_refused(opened: Opened) -> None:
    page = opened.page
    opened.show("rooms")
    page.get_by_role("button", name="kitchen").click()
    page.get_by_role("button", name="Rename").click()
    name, fault = page.get_by_role("textbox", name="Name"), page.locator("#ask-fault")
    taken, unseen = "There is a room 'hallway' already", "of 1 to 80 printable characters"
    for wrong, why in (("hallway", taken), ("a\u202eb", unseen)):
        name.fill(wrong)
        page.get_by_role("button", name="OK").click()
        fault.get_by_text(why).wait_for()
        assert name.input_value() == wrong
    assert page.is_hidden("#refusal")
    name.fill("Cook's den")
    page.get_by_role("button", name="OK").click()
    page.wait_for_selector("#ask:not([open])", state="attached")
    page.get_by_role("button", name="Cook's den").wait_for()
    assert "Cook's den" in [room.name for room in opened.robot.home().rooms]
    for chosen in page.locator("#rooms [aria-pressed=true]").all():
        chosen.click()
    x, y = opened.robot.home().rooms[0].anchor
    page.keyboard.press("1")
    page.get_by_role("button", name="Split").click()
    opened.show_map()
    assert page.is_hidden("#refusal")
    opened.drag((x, y), (x + 0.2, y))
    page.wait_for_selector("#refusal:not([hidden])")
    assert page.inner_text("#refusal")


def test_a_name_that_is_taken_after_cancel_is_told_and_can_be_taken_back(opened: Opened) -> None:
    page, robot, held = opened.page, opened.robot, list[Route]()
    page.route("**/rooms/rename", lambda route: held.append(route))
    page.keyboard.press("1")
    opened.show("rooms")
    before = robot.home().rooms[0].name
    page.get_by_role("button", name="Rename").click()
    page.get_by_role("textbox", name="Name").fill("Den")
    page.get_by_role("button", name="OK").click()
    wait_until(lambda: page.evaluate("true") and held != [], DEADLINE, "a wish on its way")
    page.locator("#ask").get_by_role("button", name="Cancel").click()
    page.wait_for_selector("#ask:not([open])", state="attached")
    held[0].continue_()
    page.unroute("**/rooms/rename")
    told = f"It was too late to cancel: {before} is Den now."
    page.locator("#note-text").get_by_text(told).wait_for()
    wait_until(lambda: robot.home().rooms[0].name == "Den", DEADLINE, "another name")
    page.get_by_role("button", name="Undo").click()
    wait_until(lambda: robot.home().rooms[0].name == before, DEADLINE, "the name of before")


def test_a_choice_outlives_another_name_and_what_is_gone_is_told(opened: Opened) -> None:
    page, robot = opened.page, opened.robot
    page.keyboard.press("1")
    page.keyboard.press("2")
    before = robot.home().rooms[0].name, robot.home().rooms[1].name
    opened.show("rooms")
    page.get_by_label(f"Passes of {before[0]}").select_option("3")
    robot.rename_room(before[0], "den")
    page.locator("#rooms [data-room=den][aria-pressed=true]").wait_for(state="attached")
    assert page.get_by_label("Passes of den").input_value() == "3"
    assert page.inner_text("#clean") == "Clean 2 rooms"
    robot.join_rooms(("den", before[1]))
    page.get_by_text("no longer a room, and not chosen any more").wait_for()
    assert page.inner_text("#clean") != "Clean 2 rooms"


def test_rooms_that_were_joined_or_split_become_as_they_were(opened: Opened) -> None:
    page, before = opened.page, opened.robot.home().rooms

    def undo(count: int) -> None:
        wait_until(lambda: len(opened.robot.home().rooms) == count, DEADLINE, f"{count} rooms")
        page.get_by_role("button", name="Undo").click()
        wait_until(lambda: opened.robot.home().rooms == before, DEADLINE, "the rooms as before")
        # A tap on a list that is about to be another one would choose nothing.
        shown = page.locator("#rooms .name")
        wait_until(lambda: shown.count() == len(before), DEADLINE, "them on the page")

    opened.show("rooms")
    page.get_by_role("button", name="kitchen").click()
    page.get_by_role("button", name="living room").click()
    page.get_by_role("button", name="Join").click()
    undo(len(before) - 1)
    page.get_by_role("button", name="living room").click()
    page.get_by_role("button", name="Split").click()
    # The sheet of a phone gives way to the map on which the line is drawn.
    assert page.locator("[data-tab][aria-expanded=true]").count() == 0
    rings = next(room.rings for room in before if room.name == "living room")
    middle = sum(y for _, y in rings[0]) / len(rings[0])
    left, right = min(x for x, _ in rings[0]), max(x for x, _ in rings[0])
    opened.drag((left - 0.1, middle), (0.5 * (left + right), middle), (right + 0.1, middle))
    undo(len(before) + 1)


def check_it_can_be_read(page: Page, least_controls: int = 13) -> None:
    """Texts have contrast, and controls a name and a size to be touched."""
    for scheme in in_each_scheme(page):
        ratios = page.evaluate(CONTRASTS)
        assert len(ratios) > 15
        assert [(text, ratio) for text, ratio in ratios if ratio < 4.5] == [], scheme
    controls = page.evaluate(CONTROLS)
    assert len(controls) >= least_controls
    for identity, name, width, height in controls:
        assert name, identity
        assert min(width, height) >= 24, (identity, name)


def test_it_can_be_read_and_touched(opened: Opened) -> None:
    for part in opened.parts():
        opened.show(part)
        check_it_can_be_read(opened.page)


def test_each_room_has_its_own_passes_and_fan_and_the_speed_is_set(opened: Opened) -> None:
    page = opened.page
    opened.show("rooms")
    page.get_by_role("button", name="kitchen").click()
    page.get_by_role("button", name="bathroom").click()
    page.get_by_label("Passes of kitchen").select_option("2")
    page.get_by_label("Fan of bathroom").select_option("quiet")
    page.get_by_label("Top speed").select_option("0.3")
    wait_until(lambda: opened.robot.robot().top_speed == 0.3, DEADLINE, "another top speed")
    page.get_by_role("button", name="Clean 2 rooms").click()
    opened.wait_for_phase("cleaning")

    def ways(robot: Embodied) -> tuple[RoomWay, ...]:
        cleaning = robot.mission.cleaning
        return () if cleaning is None else cleaning.ledger.request.each

    expected = RoomWay(2, FanLevel.STANDARD), RoomWay(1, FanLevel.QUIET)
    assert opened.robot.ask(ways) == expected


def test_layers_are_switched_and_the_picture_is_saved(opened: Opened, tmp_path: Path) -> None:
    page = opened.page
    opened.show_map()
    page.locator(".layers summary").click()
    before = colours(opened)
    page.get_by_role("checkbox", name="Furniture").uncheck()
    page.get_by_role("checkbox", name="Rooms").uncheck()
    wait_until(lambda: colours(opened) < before, DEADLINE, "fewer colours")
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save picture").click()
    assert saved.value.suggested_filename == "flat.png"
    saved.value.save_as(tmp_path / "flat.png")
    with Image.open(tmp_path / "flat.png") as picture:
        assert picture.size[0] >= 300
        assert len(set(picture.convert("RGB").resize((200, 200)).tobytes())) > 20
