"""The report of a clean is true: how much is clean, what is not, and why; in homes of any size.

``ROOMBA_EXAMPLES=500`` tries so many homes, others each time.
"""

from __future__ import annotations

import math
import os
from typing import Final

import numpy as np
import pytest
import shapely
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import NOISY
from fixtures.robots.missions import floor_clean
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from roomba.clean_request import CleanRequest
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome, MissReason
from roomba.perception.rooms.rooms import Rooms
from roomba.vocabulary import CleanMode
from roomba.world.home.home import DirtSource

MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
TOLD_WITHIN: Final = 0.01
"""Share of the floor by which what is told may differ from what is so."""
WORTH_TELLING: Final = 0.02
"""Share of the floor; of less that is not clean nothing need be said."""
DOOR: Final = (0.7, 1.5)
"""m; where the door begins and ends in y."""


def two_room_home(hall: float, den: float, height: float, crumbs: float) -> HeadlessMission:
    """Return a robot in two rooms side by side, with a door between them; lengths in m."""
    home = room_home(
        hall + 0.1 + den,
        height,
        ((hall, 0.0, hall + 0.1, DOOR[0]), (hall, DOOR[1], hall + 0.1, height)),
        station=Pose(0.2, 1.2, math.pi),
        sources=(DirtSource("crumbs", 0.7, 0.6, 0.3, crumbs, 0.0),),
    )
    middle = hall + 0.05
    rooms = Rooms.from_outlines(
        home.map.frame,
        ~home.map.solid,
        [
            ("den", shapely.box(middle, 0.0, hall + 0.1 + den, height)),
            ("hall", shapely.box(0.0, 0.0, middle, height)),
        ],
    )
    brush = NOISY.brush.model_copy(update={"bin_capacity": 1.0})
    config = NOISY.model_copy(update={"brush": brush})
    return HeadlessMission(home, config, rooms=rooms, empties_bin_after=20.0)


@settings(
    max_examples=MORE or 6,
    derandomize=not MORE,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
@given(
    hall=st.sampled_from([1.4, 1.8, 2.2]),
    den=st.sampled_from([0.9, 1.3, 1.7]),
    height=st.sampled_from([2.0, 2.4]),
    crumbs=st.sampled_from([0.2, 3.0]),
    is_shut=st.booleans(),
    by_rooms=st.booleans(),
)
def test_what_is_told_is_so(
    hall: float, den: float, height: float, crumbs: float, is_shut: bool, by_rooms: bool
) -> None:
    robot = two_room_home(hall, den, height, crumbs)
    if is_shut:
        for y in np.arange(DOOR[0] + 0.1, DOOR[1], 0.15).tolist():
            robot.simulator.place_obstacle(hall + 0.05, y, 0.05)
    request = CleanRequest(CleanMode.ROOMS, rooms=("den", "hall")) if by_rooms else CleanRequest()
    result = robot.clean(request).result
    assert result.outcome is CleanOutcome.COMPLETED

    truly = floor_clean(robot)
    assert result.fraction == pytest.approx(truly, abs=TOLD_WITHIN)
    left = result.wanted - result.covered
    if left > WORTH_TELLING * result.wanted:
        assert result.message, f"{left:.2f} m2 are not clean, and nothing is said of it"
        told = sum(each.area for each in result.missed)
        assert told == pytest.approx(left, abs=TOLD_WITHIN * result.wanted)
    else:
        assert result.message == ""
    if is_shut:
        assert "den" in result.message
        assert result.missed[0].room == "den"
        assert result.missed[0].reason is MissReason.SHUT
    else:
        assert truly > 1.0 - WORTH_TELLING
    if crumbs > robot.robot_config.brush.bin_capacity:
        assert robot.emptied, "the bin was never full"
    picked_up = robot.seen.in_bin + sum(robot.emptied)
    assert result.dirt == pytest.approx(picked_up, rel=0.1, abs=0.1)
