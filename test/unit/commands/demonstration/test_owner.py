"""What the owner does on a real page: a plan is made, and due within two minutes."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.households.written_robot import WrittenRobot

from roomba.client.address import HERE
from roomba.commands.demonstration.owner import Owner, next_minute
from roomba.configuration.household import HouseholdConfig
from roomba.household.household import LiveHousehold
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer, listen

NOW = dt.datetime(2026, 3, 2, 23, 59, 15, tzinfo=dt.timezone.utc)


@pytest.fixture
def household(tmp_path: Path) -> LiveHousehold:
    robot = WrittenRobot()
    config, told = HouseholdConfig(), pytest.fail
    return LiveHousehold(robot, tmp_path, config, 100.0, lambda text: told(text), now=lambda: NOW)


@pytest.fixture
def owner(household: LiveHousehold) -> Iterator[Owner]:
    app = create_app(WrittenRobot(), Guard("token"), household=household)
    server = PageServer(app, listen(HERE, 0, is_fixed=True))
    server.start()
    yield Owner(f"{server.address}#token=token")
    server.stop()


def test_a_plan_of_all_floor_is_made_for_the_next_minute(
    owner: Owner, household: LiveHousehold
) -> None:
    due = owner.plan_clean(NOW)
    view = household.plans()
    assert [plan.next for plan in view.plans] == [due]
    assert view.household.plans[0].order.mode.value == "whole"
    assert owner.notes() == []


def test_the_next_minute_leaves_time_to_make_the_plan() -> None:
    midnight = dt.datetime(2026, 3, 3, tzinfo=dt.timezone.utc)
    assert next_minute(NOW) == midnight
    assert next_minute(midnight - dt.timedelta(seconds=15)) == midnight + dt.timedelta(minutes=1)
