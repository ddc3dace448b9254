"""Maps, rooms, zones and goals: values, or refused with what was expected."""

import math

import numpy as np
import pytest
from fixtures.nodes.malformed import filled, grid, rooms, zones
from geometry_msgs.msg import Point, PoseStamped, Quaternion
from hypothesis import given
from hypothesis import strategies as st
from nav_msgs.msg import OccupancyGrid, Path
from roomba_robot.msg import CarpetArray, CleanGoal, LowThingArray, Rectangle, RoomArray, ZoneArray
from rospy import Time
from sensor_msgs.msg import BatteryState

from roomba.clean_request import CleanRefusedError
from roomba.grid import MOST_CELLS
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import OfferedZone
from roomba_ros.convert.clean_action import request_of
from roomba_ros.convert.common import map_of, told_map_of
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.page import (
    battery_seconds_of,
    carpets_of,
    charges_of,
    low_things_of,
    shown_path_of,
)
from roomba_ros.convert.rooms import carpets_message, low_things_message, outlines_of, zones_of

BAD = (math.nan, math.inf, -math.inf)


def test_a_map_is_what_was_told() -> None:
    message = grid(9)
    message.data[5] = 100
    known = map_of(message)
    assert known.frame.shape == (3, 3)
    assert np.argwhere(known.values == 100).tolist() == [[1, 2]]
    assert not told_map_of(message).was_loaded
    message.info.map_load_time = Time(1)
    assert told_map_of(message).was_loaded


@given(st.integers(0, 40))
def test_a_map_has_as_many_values_as_cells(values: int) -> None:
    if values == 9:
        assert map_of(grid(9)).values.shape == (3, 3)
        return
    with pytest.raises(MessageError, match=rf"expected 3 x 3 map values, got {values}"):
        map_of(grid(values))


@pytest.mark.parametrize("number", BAD)
def test_maps_at_places_that_are_none_are_refused(number: float) -> None:
    with pytest.raises(
        MessageError, match=r"expected a resolution from 0\.001 to 1 m and a finite origin"
    ):
        map_of(filled("nav_msgs/OccupancyGrid", number))
    messages = [grid(9), grid(9), grid(9), grid(9)]
    messages[0].info.resolution = number
    messages[1].info.origin.position.x = number
    messages[2].info.origin.position.y = number
    messages[3].info.origin.orientation.z = number
    for message in messages:
        with pytest.raises(MessageError):
            map_of(message)


@pytest.mark.parametrize(
    ("width", "height", "resolution", "reason"),
    [
        (0, 3, 0.05, "1 to 20000000 cells, got 0 x 3"),
        (MOST_CELLS, 2, 0.05, "make its cells larger"),
        (3, 3, 0.0, "a resolution from 0.001 to 1 m"),
        (3, 3, -0.05, "a resolution from 0.001 to 1 m"),
        (3, 3, 1e6, "a resolution from 0.001 to 1 m"),
        (3, 3, 1e-9, "a resolution from 0.001 to 1 m"),
    ],
)
def test_maps_of_sizes_that_no_map_has_are_refused(
    width: int, height: int, resolution: float, reason: str
) -> None:
    message: OccupancyGrid = grid(9)
    message.info.width, message.info.height, message.info.resolution = width, height, resolution
    with pytest.raises(MessageError, match=reason):
        map_of(message)


def test_a_turned_map_is_refused() -> None:
    message = grid(9)
    message.info.origin.orientation = Quaternion(0.0, 0.0, math.sin(0.05), math.cos(0.05))
    with pytest.raises(MessageError, match=r"without rotation, got one turned by 0\.1000 rad"):
        map_of(message)


def test_rooms_are_outlines_by_name() -> None:
    ((name, outline),) = outlines_of(rooms(5))
    assert name == "hall"
    assert len(outline.exterior.coords) == 6
    assert outlines_of(RoomArray()) == ()


def test_broken_outlines_are_refused() -> None:
    for corners in (0, 1, 2):
        with pytest.raises(MessageError, match=f"3 corners or more .* 'hall', got {corners}"):
            outlines_of(rooms(corners))
    hole = rooms(5)
    hole.rooms[0].holes = [rooms(2).rooms[0].outline]
    with pytest.raises(MessageError, match="got 2"):
        outlines_of(hole)


@pytest.mark.parametrize("number", BAD)
def test_outlines_and_zones_with_numbers_that_are_not_finite_are_refused(number: float) -> None:
    message = rooms(5)
    message.rooms[0].outline.points[3].y = number
    with pytest.raises(MessageError, match="an outline of the room 'hall' of finite numbers"):
        outlines_of(message)
    zone = zones(4)
    zone.zones[0].points[1].x = number
    with pytest.raises(MessageError, match="zone 'bowl': expected numbers of at most"):
        zones_of(zone)


def test_zones_are_those_that_were_told_or_refused_together() -> None:
    assert zones_of(zones(4)).names == ("bowl",)
    assert zones_of(ZoneArray()).all == ()
    for corners in (0, 2):
        with pytest.raises(MessageError, match=f"3 to 200 points, got {corners}"):
            zones_of(ZoneArray(zones=[*zones(4).zones, *zones(corners).zones]))
    wrong = zones(4)
    wrong.zones[0].kind = 7
    with pytest.raises(MessageError, match="a kind from 0 to 2, got 7"):
        zones_of(wrong)


def test_zones_that_are_offered_come_as_they_were_told() -> None:
    offer = OfferedZone(3, ((0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)))
    message = low_things_message(5.0, [offer], "map")
    (view,) = low_things_of(message)
    assert (view.times, view.corners) == (offer.times, offer.corners)
    assert low_things_of(LowThingArray()) == ()
    for bad in BAD:
        message.things[0].corners[2].y = bad
        with pytest.raises(MessageError, match="finite"):
            low_things_of(message)
    message.things[0].corners = message.things[0].corners[:2]
    with pytest.raises(MessageError, match="3 corners or more"):
        low_things_of(message)


def test_carpets_come_as_they_were_told() -> None:
    outline = ((0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0))
    message = carpets_message(5.0, FeltCarpets((outline,)), "map")
    assert message.header.frame_id == "map"
    assert carpets_of(message) == (outline,)
    assert carpets_of(CarpetArray()) == ()
    for bad in BAD:
        message.carpets[0].corners[2].x = bad
        with pytest.raises(MessageError, match="finite"):
            carpets_of(message)
    message.carpets[0].corners = message.carpets[0].corners[:2]
    with pytest.raises(MessageError, match="3 corners or more of a carpet"):
        carpets_of(message)


@pytest.mark.parametrize("number", BAD)
@pytest.mark.parametrize("mode", range(6))
def test_goals_with_numbers_that_are_not_finite_are_refused(mode: int, number: float) -> None:
    """Also where their mode asks for neither zones nor a spot: the program is wrong."""
    zone = Rectangle(0.0, 0.0, number, 1.0)
    spot = Point(0.0, number, 0.0)
    for goal in (CleanGoal(zones=[zone]), CleanGoal(spot=spot, zones=[Rectangle(0, 0, 1, 1)])):
        goal.mode, goal.rooms = mode, ["hall"]
        with pytest.raises(MessageError) as refused:
            request_of(goal)
        assert isinstance(refused.value, CleanRefusedError)


@pytest.mark.parametrize(
    ("values", "seconds"),
    [
        ({"percentage": 0.5, "current": -1.0, "capacity": 2.0}, 3600.0),
        ({"percentage": 0.5, "current": 2.0, "capacity": 2.0}, 1800.0),
        ({"percentage": 0.5, "current": 0.0, "capacity": 2.0}, math.nan),
        ({"percentage": math.nan, "current": -1.0, "capacity": 2.0}, math.nan),
        ({"percentage": 0.5, "current": math.inf, "capacity": 2.0}, math.nan),
        ({"percentage": 0.5, "current": -1.0, "capacity": math.nan}, math.nan),
    ],
)
def test_how_long_a_battery_lasts(values: dict[str, float], seconds: float) -> None:
    found = battery_seconds_of(BatteryState(**values))
    assert found == pytest.approx(seconds, nan_ok=True)


@pytest.mark.parametrize("far", [1e308, -1e39])
def test_a_path_that_no_page_can_draw_is_refused(far: float) -> None:
    path = Path(poses=[PoseStamped(), PoseStamped()])
    for each in path.poses:
        each.pose.orientation.w = 1.0
    assert shown_path_of(path).shape == (2, 2)
    path.poses[1].pose.position.x = far
    with pytest.raises(MessageError, match="expected a path in a home"):
        shown_path_of(path)


def test_a_battery_fills_by_its_current_or_by_its_status() -> None:
    charging, discharging = (
        BatteryState.POWER_SUPPLY_STATUS_CHARGING,
        BatteryState.POWER_SUPPLY_STATUS_DISCHARGING,
    )
    assert charges_of(BatteryState(current=1.2, power_supply_status=discharging))
    # A real robot tells no current.
    assert charges_of(BatteryState(current=math.nan, power_supply_status=charging))
    assert not charges_of(BatteryState(current=math.nan, power_supply_status=discharging))
    assert not charges_of(BatteryState(current=-0.5, power_supply_status=discharging))
