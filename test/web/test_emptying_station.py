"""A station that empties the bin, on the page: when it does, and what its bag holds."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.pages.windows import Windows
from fixtures.waiting import wait_until
from web.conftest import SIZES, Opened, page_at, serving

from roomba.commands.play.living import live_client
from roomba.configuration.household import HouseholdConfig
from roomba.headless.embodied import Embodied
from roomba.household.household import LiveHousehold
from roomba.plans.plan import Emptying
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.world.emptying import EmptyingStation
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM

DEADLINE = 20.0
"""s of wall time."""
SPEED = 4.0
"""Emptying takes 8 s of the robot's, so 2 s: long enough for a busy page to show it."""


@pytest.fixture
def household(tmp_path: Path) -> Iterator[LiveHousehold]:
    robot = live_client("studio", seed=1, speed=SPEED, knows_map=True, station_empties=True)
    config = HouseholdConfig()
    household = LiveHousehold(
        robot, tmp_path, config, 100.0, lambda text: pytest.fail(text), period=0.05
    )
    robot.start()
    household.start()
    yield household
    household.stop()
    robot.end()


@pytest.fixture
def opened(windows: Windows, household: LiveHousehold) -> Iterator[Opened]:
    guard = Guard(new_token())
    with (
        serving(create_app(household.robot, guard, household=household)) as server,
        page_at(windows, f"{server.address}#token={guard.token}", SIZES["desktop"]) as page,
    ):
        opened = Opened(page, household.robot, server, guard)  # type: ignore[arg-type]
        opened.wait_for_phase("docked")
        yield opened


def station_of(robot: Embodied) -> EmptyingStation:
    station: EmptyingStation = robot.simulator.emptying  # type: ignore[attr-defined]
    return station


def put_into_bin(opened: Opened, grams: float) -> None:
    def put(robot: Embodied) -> None:
        fleet = robot.simulator._fleet  # type: ignore[attr-defined]
        fleet.robots["in_bin"] = round(grams * MICROGRAMS_PER_GRAM)

    opened.robot.ask(put)


def test_it_is_set_when_the_bin_is_emptied_and_a_full_bag_is_told(
    opened: Opened, household: LiveHousehold
) -> None:
    page = opened.page
    page.locator("#upkeep summary").click()
    put_into_bin(opened, 5.0)
    page.get_by_role("button", name="Empty it now").click()
    opened.wait_for_phase("emptying")
    wait_until(lambda: opened.robot.robot().dirt == 0.0, DEADLINE, "the bin is emptied")
    opened.wait_for_phase("docked")
    assert opened.robot.ask(station_of).in_bag == pytest.approx(5.0)

    def fill(robot: Embodied) -> None:
        station_of(robot).in_bag = 1e6

    opened.robot.ask(fill)
    page.get_by_text("full: put an empty one in").wait_for()
    page.locator("#emptying-when").select_option("after each run")
    wait_until(
        lambda: household.plans().household.emptying is Emptying.EACH_RUN, DEADLINE, "it is set"
    )
    assert "put an empty bag into the station" in household.upkeep().reminders
    put_into_bin(opened, 5.0)
    page.get_by_role("button", name="Empty it now").click()
    page.get_by_text("the bag of its station is full").first.wait_for()
    assert opened.robot.robot().dirt == pytest.approx(5.0)
    # With an empty one it does by itself what is set.
    page.get_by_role("button", name="Bag replaced").click()
    wait_until(lambda: opened.robot.robot().dirt == 0.0, DEADLINE, "the bin is emptied")
    assert opened.robot.ask(station_of).in_bag == pytest.approx(5.0)
