"""Zones on the map are drawn, dragged, resized, brought back; the map stays under the fingers."""

from __future__ import annotations

import math

import pytest
from fixtures.waiting import wait_until
from playwright.sync_api import Route
from web.conftest import SIZES, Opened
from web.test_page import DEADLINE

from roomba.client.view import ZoneView
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import LowThing, LowThings

DESKTOP = pytest.mark.parametrize("size", [SIZES["desktop"]])
CORNERS = ((1.0, 1.6), (2.0, 1.6), (2.0, 2.4), (1.0, 2.4))
ELSEWHERE = tuple((x + 2.0, y) for x, y in CORNERS)
VIEW = """async () => {
    const { toFloor, view } = await import("/map/view.js");
    return { scale: view.scale, at: toFloor(200, 150) };
}"""
PIXEL = """async (place) => {
    const { toScreen } = await import("/map/view.js"), canvas = document.getElementById("floor");
    const [x, y] = toScreen(...place).map((at) => Math.round(at * devicePixelRatio));
    return [...canvas.getContext("2d").getImageData(x, y, 1, 1).data];
}"""
SHOWN = """async () => (await import("/store.js")).chosenZone()?.points ?? []"""
PLACE = """async ([px, py]) => (await import("/map/view.js")).toFloor(px, py)"""


def points_of(opened: Opened) -> tuple[tuple[float, float], ...]:
    zones = opened.robot.home().zones
    return zones[0].points if zones else ()


def wait_for_points(opened: Opened, points: tuple[tuple[float, float], ...]) -> None:
    def are_there() -> bool:
        now = points_of(opened)
        return len(now) == len(points) and all(
            math.dist(one, other) < 0.06 for one, other in zip(now, points, strict=True)
        )

    wait_until(are_there, DEADLINE, lambda: f"{points}, not {points_of(opened)}")


@DESKTOP
def test_a_wall_is_taken_back_and_a_zone_is_dragged_and_resized(opened: Opened) -> None:
    page = opened.page
    page.get_by_role("button", name="Virtual wall").click()
    opened.drag((1.0, 1.6), (2.0, 2.4))
    wait_for_points(opened, ((1.0, 1.6), (2.0, 2.4)))
    # The page is told of each change a little later than the robot.
    page.locator("#zones li", has_text="Wall 1").wait_for(state="attached")
    page.get_by_role("button", name="Undo").click()
    wait_until(lambda: points_of(opened) == (), DEADLINE, "no wall")
    page.locator("#zones li").wait_for(state="detached")
    opened.robot.put_zone(ZoneView("Zone 1", "no-go", CORNERS))
    page.locator("#zones li", has_text="Zone 1").wait_for(state="attached")
    opened.tap(1.5, 2.0)
    page.get_by_text("Zone 1: drag it, or a corner").wait_for()
    opened.drag((1.5, 2.0), (1.7, 2.1))
    moved = tuple((x + 0.2, y + 0.1) for x, y in CORNERS)
    wait_for_points(opened, moved)
    opened.drag((2.2, 2.5), (2.4, 2.7))
    wait_for_points(opened, ((1.2, 1.7), (2.4, 1.7), (2.4, 2.7), (1.2, 2.7)))
    page.locator("#floor").focus()
    page.keyboard.press("ArrowLeft")
    wait_for_points(opened, ((1.1, 1.7), (2.3, 1.7), (2.3, 2.7), (1.1, 2.7)))
    page.keyboard.press("Delete")
    wait_until(lambda: points_of(opened) == (), DEADLINE, "no zone")
    page.get_by_role("button", name="Undo").click()
    wait_for_points(opened, ((1.1, 1.7), (2.3, 1.7), (2.3, 2.7), (1.1, 2.7)))


@DESKTOP
def test_buttons_and_the_wheel_zoom_and_the_map_stays_under_the_mouse(opened: Opened) -> None:
    page = opened.page
    at_first = page.evaluate(VIEW)["scale"]
    page.get_by_role("button", name="Zoom in").click()
    assert page.evaluate(VIEW)["scale"] > 1.2 * at_first
    for _ in range(2):
        page.get_by_role("button", name="Zoom out").click()
    assert page.evaluate(VIEW)["scale"] < at_first
    page.get_by_role("button", name="Show the whole home").click()
    assert page.evaluate(VIEW)["scale"] == pytest.approx(at_first)
    box = page.locator("#floor").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 200, box["y"] + 150)
    before = page.evaluate(VIEW)
    for step in (-240, -240, 120):
        page.mouse.wheel(0, step)
    wait_until(
        lambda: page.evaluate(VIEW)["scale"] > 1.4 * before["scale"], DEADLINE, "a nearer look"
    )
    after = page.evaluate(VIEW)
    assert after["at"] == pytest.approx(before["at"], abs=1e-6)


@pytest.mark.parametrize("size", [SIZES["phone"]])
def test_two_fingers_zoom_and_the_map_stays_under_them(opened: Opened) -> None:
    page = opened.page
    box = page.locator("#floor").bounding_box()
    assert box is not None
    touch = page.context.new_cdp_session(page)

    def fingers(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": x + box["x"], "y": y + box["y"]} for x, y in places]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    one, other = (150.0, 250.0), (250.0, 250.0)
    under = [page.evaluate(PLACE, place) for place in (one, other)]
    fingers("touchStart", one, other)
    for _ in range(6):
        one, other = (one[0] - 10.0, one[1] + 4.0), (other[0] + 10.0, other[1] + 4.0)
        fingers("touchMove", one, other)

    def are_under_them() -> bool:
        now = [page.evaluate(PLACE, place) for place in (one, other)]
        return all(math.dist(*pair) < 0.01 for pair in zip(under, now, strict=True))

    # The browser hands on what fingers do once a frame.
    wait_until(are_under_them, DEADLINE, "the same floor under the fingers")
    fingers("touchEnd")
    assert opened.page.inner_text("#clean") == "Clean all"


def wait_until_shown(opened: Opened, points: tuple[tuple[float, float], ...]) -> None:
    """Wait until the page shows the chosen zone there."""
    shown = list[object]()

    def is_shown() -> bool:
        shown[:] = opened.page.evaluate(SHOWN)
        return shown == [pytest.approx(point, abs=0.001) for point in points]

    wait_until(is_shown, DEADLINE, lambda: f"{points}, not {shown}")


def choose(opened: Opened) -> None:
    """Have a zone, and choose it on the map."""
    opened.robot.put_zone(ZoneView("Zone 1", "no-go", CORNERS))
    opened.show_map()
    opened.page.locator("#zones li", has_text="Zone 1").wait_for(state="attached")
    opened.tap(1.5, 2.0)
    opened.page.get_by_text("Zone 1: drag it, or a corner").wait_for()


@DESKTOP
def test_the_zone_that_is_chosen_is_shown_where_the_robot_has_it(opened: Opened) -> None:
    page, robot = opened.page, opened.robot
    choose(opened)
    robot.put_zone(ZoneView("Zone 1", "no-go", ELSEWHERE))
    wait_until_shown(opened, ELSEWHERE)
    page.locator("#floor").focus()
    for _ in range(10):
        page.keyboard.down("ArrowUp")
    page.keyboard.up("ArrowUp")
    higher = tuple((x, y + 1.0) for x, y in ELSEWHERE)
    wait_for_points(opened, higher)
    wait_until_shown(opened, higher)
    robot.put_zone(ZoneView("Zone 1", "no-go", CORNERS))
    wait_until_shown(opened, CORNERS)


@DESKTOP
def test_one_place_of_a_zone_is_asked_for_at_a_time_and_the_newest_wins(opened: Opened) -> None:
    page, asked = opened.page, list[Route]()

    def hold_the_first(route: Route) -> None:
        asked.append(route)
        if len(asked) > 1:
            route.continue_()

    choose(opened)
    page.route("**/api/v1/zones", hold_the_first)
    page.locator("#floor").focus()
    for _ in range(5):
        page.keyboard.press("ArrowUp")
    higher = tuple((x, y + 0.5) for x, y in CORNERS)
    wait_until_shown(opened, higher)
    assert len(asked) == 1
    asked[0].continue_()
    wait_until(lambda: page.evaluate("true") and len(asked) == 2, DEADLINE, "the newest place")
    wait_for_points(opened, higher)


@pytest.mark.parametrize("size", [SIZES["phone"]])
def test_a_second_finger_leaves_a_zone_where_the_robot_has_it(opened: Opened) -> None:
    page = opened.page
    choose(opened)
    touch = page.context.new_cdp_session(page)

    def fingers(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": x, "y": y} for x, y in places]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    x, y = opened.pixels(1.5, 2.0)
    fingers("touchStart", (x, y))
    fingers("touchMove", (x + 40.0, y))
    wait_until(lambda: page.evaluate(SHOWN)[0][0] > 1.1, DEADLINE, "a zone that is dragged")
    fingers("touchStart", (x + 40.0, y), (x + 40.0, y + 90.0))
    fingers("touchMove", (x + 40.0, y), (x + 40.0, y + 110.0))
    fingers("touchEnd")
    wait_until_shown(opened, CORNERS)
    assert points_of(opened) == CORNERS


@DESKTOP
def test_a_zone_is_offered_where_something_was_felt_taken_or_ignored(opened: Opened) -> None:
    low = LowThings((LowThing(1.0, 1.0, 1.2, 1.0, 3), LowThing(2.0, 2.0, 2.0, 2.0, 4)))
    page, robot = opened.page, opened.robot
    robot.ask(lambda alive: setattr(alive.mission.obstacles, "low", low))
    page.get_by_text("Felt 3 times at 1.1, 1.0").wait_for()
    page.get_by_role("button", name="Make a no-go zone at 1.1, 1.0").click()
    wait_until(lambda: len(robot.home().zones) == 1, DEADLINE, "a zone")
    assert robot.home().zones[0].name == "Zone 1"
    page.get_by_role("button", name="Ignore what was felt at 2.0, 2.0").click()
    wait_until(lambda: robot.home().low_things == (), DEADLINE, "no offer")
    page.locator("#low-offer").wait_for(state="hidden")


@DESKTOP
def test_carpets_that_it_felt_are_a_layer_of_the_map(opened: Opened) -> None:
    carpet = ((1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0))
    page, robot = opened.page, opened.robot
    robot.ask(lambda alive: alive.mission.carpets.recall(FeltCarpets((carpet,))))
    page.locator(".layers summary").click()
    layer = page.get_by_label("Carpets it felt")

    def is_hidden_without_it() -> bool:
        seen = []
        for is_shown in (True, False, True):
            layer.set_checked(is_shown)
            seen.append(page.evaluate(PIXEL, [1.5, 1.5]))
        return bool(seen[0] == seen[2] != seen[1])

    # All is asked for again: the map may come after the page.
    wait_until(is_hidden_without_it, DEADLINE, "it is drawn, and hidden")


def test_a_zone_gets_another_name_on_the_map_and_in_the_list(opened: Opened) -> None:
    page, robot = opened.page, opened.robot
    first, other = ZoneView("Zone 1", "no-go", CORNERS), ZoneView("Zone 2", "no-go", ELSEWHERE)
    robot.put_zone(first)
    robot.put_zone(other)
    opened.show_map()
    page.locator("#zones li", has_text="Zone 2").wait_for(state="attached")
    opened.tap(1.5, 2.0)
    page.locator("#offer").get_by_role("button", name="Rename").click()
    name = page.get_by_role("textbox", name="Name")
    name.fill("Zone 2")
    page.get_by_role("button", name="OK").click()
    page.locator("#ask-fault").get_by_text("There is a zone “Zone 2” already.").wait_for()
    name.fill("Cat's bowl")
    page.get_by_role("button", name="OK").click()
    page.locator("#note-text").get_by_text("Zone 1 is Cat's bowl now.").wait_for()
    bowl = ZoneView("Cat's bowl", "no-go", CORNERS)
    wait_until(lambda: set(robot.home().zones) == {bowl, other}, DEADLINE, "another name")
    page.get_by_role("button", name="Undo").click()
    wait_until(lambda: set(robot.home().zones) == {first, other}, DEADLINE, "the name of before")
    opened.show("zones")
    page.get_by_role("button", name="Move Zone 2", exact=True).click()
    page.get_by_role("button", name="Rename Zone 2").click()
    name.fill("Rug")
    page.get_by_role("button", name="OK").click()
    page.locator("#zones li", has_text="Rug").wait_for()
    # The zone is set by its new name before the old one goes.
    wait_until(
        lambda: {zone.name for zone in robot.home().zones} == {"Zone 1", "Rug"},
        DEADLINE,
        "the name of before is gone",
    )
