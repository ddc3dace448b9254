"""The truth of a simulated home becomes messages, and the same values again."""

from __future__ import annotations

import math

import numpy as np
import pytest
from geometry_msgs.msg import Point32, Polygon
from roomba_robot.msg import Door as DoorMessage
from roomba_robot.msg import Rectangle, SimHome

from roomba.client.view import DoorView
from roomba.grid import GridFrame
from roomba.world.truth import DoorNow, HomeNow
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.page import sim_dirt_of, sim_home_of
from roomba_ros.convert.sensors import sim_dirt_message, sim_home_message

RING = ((0.0, 0.0), (1.5, 0.0), (1.5, 0.5))
DOOR = DoorNow("kitchen door", (2.0, 3.0, 2.5, 3.25), is_shut=True)


def test_a_home_comes_back_as_it_was_told() -> None:
    message = sim_home_message(12.5, HomeNow((RING,), (DOOR,), is_lifted=True), "map")
    assert message.header.stamp.to_sec() == 12.5
    assert message.header.frame_id == "map"
    told = sim_home_of(message)
    assert told.things == (RING,)
    assert told.doors == (DoorView("kitchen door", (2.0, 3.0, 2.5, 3.25), is_shut=True),)
    assert told.is_lifted


@pytest.mark.parametrize(
    "wrong",
    [
        SimHome(things=[Polygon([Point32(0.0, 0.0, 0.0), Point32(1.0, 0.0, 0.0)])]),
        SimHome(things=[Polygon([Point32(math.nan, 0.0, 0.0)] * 3)]),
        SimHome(doors=[DoorMessage("gate", Rectangle(0.0, 0.0, math.inf, 1.0), False)]),
    ],
)
def test_what_makes_no_sense_is_refused(wrong: SimHome) -> None:
    with pytest.raises(MessageError):
        sim_home_of(wrong)


def test_dirt_comes_back_within_a_percent() -> None:
    frame = GridFrame(0.05, -1.0, 2.0, 3, 4)
    share = np.linspace(0.0, 1.0, 12).reshape(3, 4)
    told, cells = sim_dirt_of(sim_dirt_message(1.0, frame, share, "map"))
    assert told == frame
    assert cells.dtype == np.uint8
    assert cells / 255.0 == pytest.approx(share, abs=0.01)
