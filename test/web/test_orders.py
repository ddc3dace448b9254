"""What else can be asked for on the page: a drawn zone, edges, a place, a beep, other rooms."""

from __future__ import annotations

import math

import pytest
from fixtures.waiting import wait_until
from web.conftest import EACH_SIZE, Opened
from web.test_page import DEADLINE

from roomba.clean_request import CleanRequest
from roomba.headless.embodied import Embodied
from roomba.vocabulary import CleanMode


def asked_for(robot: Embodied) -> CleanMode | None:
    cleaning = robot.mission.cleaning
    return None if cleaning is None else cleaning.ledger.request.mode


def test_a_zone_is_drawn_and_cleaned(opened: Opened) -> None:
    opened.show("zones")
    opened.page.get_by_role("button", name="Clean a zone").click()
    opened.show_map()
    x, y = opened.robot.home().rooms[0].anchor
    opened.drag((x - 0.6, y - 0.5), (x, y), (x + 0.6, y + 0.5))
    opened.wait_for_phase("cleaning")
    assert opened.robot.ask(asked_for) is CleanMode.ZONES
    assert 0.0 < opened.robot.robot().vacuum.wanted < 1.2 * 1.0 + 0.2
    assert opened.robot.home().zones == ()


def test_it_beeps_and_edges_alone_are_cleaned(opened: Opened) -> None:
    opened.show("more")
    opened.page.get_by_text("Drive by hand", exact=True).click()
    with opened.page.expect_response("**/api/v1/locate") as answer:
        opened.page.get_by_role("button", name="Beep").click()
    assert answer.value.ok
    opened.show("rooms")
    opened.page.locator("#mode").select_option("edges")
    opened.page.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("cleaning")
    assert opened.robot.ask(asked_for) is CleanMode.EDGES


def test_how_is_cleaned_is_remembered_for_the_home(opened: Opened) -> None:
    page = opened.page
    opened.show("rooms")
    page.locator("#passes").select_option("2")
    page.locator("#fan").select_option("quiet")
    page.reload()
    opened.wait_for_phase("docked")
    wait_until(lambda: page.locator("#passes").input_value() == "2", DEADLINE, "two passes")
    assert page.locator("#fan").input_value() == "quiet"
    assert page.evaluate("() => Object.keys(localStorage)") == ["how is cleaned in flat"]
    # In another home it is as usual.
    page.evaluate(
        "async () => { const { get, set } = await import('/store.js');"
        " set('home', { ...get('home'), name: 'studio' }); }"
    )
    assert page.locator("#passes").input_value() == "1"
    assert page.locator("#fan").input_value() == "standard"


@pytest.mark.parametrize("speed", [20.0])
def test_it_goes_where_the_floor_was_tapped_and_back_to_be_charged(opened: Opened) -> None:
    page = opened.page
    x, y = opened.robot.home().rooms[0].anchor
    opened.tap(x, y)
    page.get_by_role("button", name="Go here").click()

    def is_there() -> bool:
        at_x, at_y, _ = opened.robot.robot().pose
        return math.hypot(at_x - x, at_y - y) < 0.3

    wait_until(is_there, DEADLINE, "the robot where the floor was tapped")
    opened.wait_for_phase("idle")
    # What was tapped to go there is no choice of a room.
    assert page.inner_text("#clean") == "Clean all"
    wait_until(lambda: opened.robot.robot().vacuum.battery < 0.995, DEADLINE, "a used battery")
    page.get_by_role("button", name="Dock").click()
    opened.wait_for_phase("docked")
    page.get_by_text("On its station, charging").wait_for()
    assert "full in" in page.inner_text("#battery")


def test_a_clean_under_way_is_given_up_after_a_yes_alone(opened: Opened) -> None:
    page = opened.page
    name = opened.robot.home().rooms[0].name
    opened.robot.clean(CleanRequest(mode=CleanMode.ROOMS, rooms=(name,)))
    opened.wait_for_phase("cleaning")
    page.get_by_role("button", name="Clean all").click()
    page.locator("#ask").get_by_role("button", name="Cancel").click()
    assert opened.robot.ask(asked_for) is CleanMode.ROOMS
    page.get_by_role("button", name="Clean all").click()
    with page.expect_response("**/api/v1/clean"):
        page.locator("#ask").get_by_role("button", name="OK").click()
    assert opened.robot.ask(asked_for) is CleanMode.WHOLE
    # It cleans no rooms in order now: there is nothing to which one could be added.
    page.locator("#queue").wait_for(state="hidden")
    page.keyboard.press("1")
    assert "first" in (page.locator("#pause").get_attribute("class") or "")
    page.get_by_role("button", name="Clean 1 room").click()
    with page.expect_response("**/api/v1/clean"):
        page.locator("#ask").get_by_role("button", name="OK").click()
    assert opened.robot.ask(asked_for) is CleanMode.ROOMS


@EACH_SIZE
def test_the_order_of_chosen_rooms_is_changed_before_they_are_cleaned(opened: Opened) -> None:
    page, rooms = opened.page, opened.page.locator("#rooms")
    first, second, third = (room.name for room in opened.robot.home().rooms[:3])
    opened.show("rooms")
    rooms.locator(f"[data-room='{first}']").click()
    assert rooms.locator(".mover").count() == 0
    for name in (second, third):
        rooms.locator(f"[data-room='{name}']").click()

    def numbers() -> list[str]:
        return rooms.locator(".order").all_inner_texts()[:3]

    assert numbers() == ["1", "2", "3"]
    later = rooms.get_by_role("button", name=f"Clean {first} later")
    assert rooms.get_by_role("button", name=f"Clean {first} earlier").is_disabled()
    later.click()
    assert numbers() == ["2", "1", "3"]
    # By keys: the focus stays with the room, also where it cannot come later any more.
    for key in ("Enter", " "):
        page.keyboard.press(key)
    focused = "() => document.activeElement.getAttribute('aria-label').toLowerCase()"
    assert page.evaluate(focused) == f"clean {first} earlier"
    assert numbers() == ["2", "1", "3"]
    later.click()
    opened.show("rooms")
    # What the map shows as numbers is this choice.
    chosen = page.evaluate("async () => (await import('/store.js')).get('chosen')")
    assert chosen == [second, third, first]
    page.get_by_role("button", name="Clean 3 rooms").click()
    opened.wait_for_phase("cleaning")
    wait_until(
        lambda: opened.robot.robot().vacuum.queue == (second, third, first), DEADLINE, "the order"
    )


def test_the_rooms_of_a_clean_under_way_are_changed(opened: Opened) -> None:
    first, second, third = (room.name for room in opened.robot.home().rooms[:3])
    opened.show("rooms")
    queue = opened.page.locator("#queue")
    for name in (first, second):
        opened.page.locator(f"#rooms [data-room='{name}']").click()
    assert not queue.is_visible()
    opened.page.get_by_role("button", name="Clean 2 rooms").click()
    opened.wait_for_phase("cleaning")
    queue.get_by_text(f"{first}, now").wait_for()
    # So it does not go on to the next room meanwhile.
    opened.page.get_by_role("button", name="Pause").click()
    opened.wait_for_phase("paused")

    def are(*names: str) -> None:
        wait_until(lambda: opened.robot.robot().vacuum.queue == names, DEADLINE, f"{names}")
        # What is pressed next goes by what the page shows.
        shown = queue.locator("li .name")
        wait_until(lambda: shown.all_inner_texts()[-1].lower() == names[-1], DEADLINE, f"{names}")
        wait_until(lambda: shown.count() == len(names), DEADLINE, f"{len(names)} rooms")

    are(first, second)
    queue.get_by_role("button", name=f"{second} earlier").click()
    are(second, first)
    queue.get_by_text(f"{second}, now").wait_for()
    opened.page.locator(f"#rooms [data-room='{third}']").click()
    opened.page.get_by_label(f"Passes of {third}").select_option("2")
    assert "first" in (opened.page.locator("#pause").get_attribute("class") or "")
    opened.page.get_by_role("button", name="Add what is chosen").click()
    are(second, first, third)
    opened.page.reload()  # what was chosen is known to the robot alone
    opened.wait_for_phase("paused")
    opened.show("rooms")
    queue.get_by_role("button", name=f"Leave {third} out").click()
    are(second, first)
    opened.page.get_by_role("button", name="Undo").click()
    are(second, first, third)
    ways = opened.robot.robot().vacuum.queue_ways
    assert [way.passes for way in ways] == [1, 1, 2]
    assert queue.get_by_role("button", name=f"{second} earlier").is_disabled()
    opened.show("rooms")
    opened.page.get_by_role("button", name="Stop", exact=True).click()
    opened.wait_for_phase("idle")
    assert not queue.is_visible()
