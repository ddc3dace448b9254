"""When the household lets the station empty the bin."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from fixtures.households.written_robot import VIEW

from roomba.client.view import RobotView
from roomba.configuration.household import EmptyingConfig
from roomba.household.emptying import is_to_be_emptied
from roomba.plans.plan import Emptying

CONFIG = EmptyingConfig()
CAPACITY = 100.0


def view(phase: str, dirt: float, bag: float = 0.2) -> RobotView:
    return replace(VIEW, vacuum=replace(VIEW.vacuum, phase=phase), dirt=dirt, bag=bag)


@pytest.mark.parametrize(
    ("wanted", "phase", "dirt", "expected"),
    [
        (Emptying.EACH_RUN, "docked", 5.0, True),
        (Emptying.EACH_RUN, "docked", 0.5, False),
        (Emptying.EACH_RUN, "cleaning", 50.0, False),
        (Emptying.FULL, "docked", 5.0, False),
        (Emptying.FULL, "docked", 75.0, True),
        (Emptying.FULL, "charging", 75.0, False),
        (Emptying.FULL, "bin full", 98.0, True),
        (Emptying.EACH_RUN, "bin full", math.nan, True),
        (Emptying.NEVER, "bin full", 98.0, False),
        (Emptying.NEVER, "docked", 98.0, False),
    ],
)
def test_it_is_emptied_as_is_wanted_and_never_in_quiet_hours(
    wanted: Emptying, phase: str, dirt: float, expected: bool
) -> None:
    seen = view(phase, dirt)
    assert is_to_be_emptied(seen, wanted, CAPACITY, CONFIG, is_quiet=False) is expected
    assert not is_to_be_emptied(seen, wanted, CAPACITY, CONFIG, is_quiet=True)


@pytest.mark.parametrize("bag", [math.nan, 1.0])
def test_without_a_bag_that_has_room_it_is_not_asked(bag: float) -> None:
    seen = view("bin full", 98.0, bag)
    assert not is_to_be_emptied(seen, Emptying.FULL, CAPACITY, CONFIG, is_quiet=False)
