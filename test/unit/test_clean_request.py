"""Requests that make no sense are refused, before a robot hears of them."""

from __future__ import annotations

import math

import pytest

from roomba.clean_request import CleanRefusedError, CleanRequest, Rectangle
from roomba.errors import RequestRefusedError
from roomba.geometry import Pose
from roomba.vocabulary import LONGEST_NAME, MOST_PASSES, MOST_ZONES, CleanMode, FanLevel, RoomWay


def test_without_more_words_all_is_cleaned_once() -> None:
    request = CleanRequest()
    assert (request.mode, request.passes, request.fan) == (
        CleanMode.WHOLE,
        1,
        FanLevel.STANDARD,
    )


@pytest.mark.parametrize("passes", [0, -1, MOST_PASSES + 1])
def test_too_few_or_many_passes_are_refused(passes: int) -> None:
    with pytest.raises(CleanRefusedError, match=f"1 to {MOST_PASSES} passes, got {passes}"):
        CleanRequest(passes=passes)


def test_as_many_passes_as_allowed_are_taken() -> None:
    assert CleanRequest(passes=MOST_PASSES).passes == MOST_PASSES


def test_each_room_has_its_own_way_or_all_have_the_same() -> None:
    ways = RoomWay(3, FanLevel.QUIET), RoomWay(1, FanLevel.STRONG)
    request = CleanRequest(CleanMode.ROOMS, ("den", "hall"), passes=2, each=ways)
    assert (request.way_of("den"), request.way_of("hall")) == ways
    assert request.way_of("what was out of reach") == RoomWay(2, FanLevel.STANDARD)
    assert request.most_passes == 3
    alike = CleanRequest(CleanMode.ROOMS, ("den",), passes=2)
    assert (alike.way_of("den"), alike.most_passes) == (RoomWay(2), 2)


def test_ways_for_other_than_each_room_are_refused() -> None:
    with pytest.raises(CleanRefusedError, match="each of the 2 rooms, or none; got 1"):
        CleanRequest(CleanMode.ROOMS, ("den", "hall"), each=(RoomWay(),))
    with pytest.raises(CleanRefusedError, match="for mode whole"):
        CleanRequest(each=(RoomWay(),))
    with pytest.raises(CleanRefusedError, match="passes, got 0"):
        CleanRequest(CleanMode.ROOMS, ("den",), each=(RoomWay(0),))


def test_rooms_and_zones_must_be_told() -> None:
    with pytest.raises(CleanRefusedError, match="rooms"):
        CleanRequest(CleanMode.ROOMS)
    with pytest.raises(CleanRefusedError, match="zones"):
        CleanRequest(CleanMode.ZONES)


@pytest.mark.parametrize(
    "zone",
    [
        (1.0, 0.0, 0.5, 1.0),
        (0.0, 1.0, 1.0, 0.5),
        (0.0, 0.0, 0.0, 1.0),
        (0.0, 0.5, 1.0, 0.5),
        (math.nan, 0.0, 1.0, 1.0),
        (0.0, 0.0, 1.0, math.nan),
        (-1.0, 0.0, 0.0, math.inf),
        (-math.inf, 0.0, 0.0, 1.0),
    ],
)
def test_zones_that_are_none_are_refused(zone: Rectangle) -> None:
    with pytest.raises(CleanRefusedError, match="lowest x") as refused:
        CleanRequest(CleanMode.ZONES, zones=((0.0, 0.0, 1.0, 1.0), zone))
    assert isinstance(refused.value, RequestRefusedError)


@pytest.mark.parametrize("spot", [(math.nan, 0.0), (0.0, math.inf), (-math.inf, 1.0)])
def test_a_spot_that_is_nowhere_is_refused(spot: tuple[float, float]) -> None:
    with pytest.raises(CleanRefusedError, match="a spot of finite numbers"):
        CleanRequest(CleanMode.SPOT, spot=spot)


def test_in_another_frame_its_places_stay_where_they_are() -> None:
    turn = Pose(2.0, 0.5, math.pi / 2)
    spot = CleanRequest(CleanMode.SPOT, spot=(1.0, 0.0)).moved(turn)
    assert spot.spot == pytest.approx((2.0, 1.5))
    zones = CleanRequest(CleanMode.ZONES, zones=((0.0, 0.0, 2.0, 1.0),), passes=2).moved(turn)
    # Their sides are along the axes.
    assert zones.zones[0] == pytest.approx((0.5, 1.0, 2.5, 2.0))
    assert zones.passes == 2
    here = CleanRequest(CleanMode.SPOT)
    assert here.moved(turn) == here


def test_more_than_a_home_has_is_refused_before_it_is_looked_at() -> None:
    zone = (0.0, 0.0, 1.0, 1.0)
    assert CleanRequest(CleanMode.ZONES, zones=MOST_ZONES * (zone,)).zones
    with pytest.raises(CleanRefusedError, match="at most 1000 zones, got 1001"):
        CleanRequest(CleanMode.ZONES, zones=(MOST_ZONES + 1) * (zone,))
    with pytest.raises(CleanRefusedError, match="at most 1000 rooms, got 1001"):
        CleanRequest(CleanMode.ROOMS, rooms=(MOST_ZONES + 1) * ("hall",))


@pytest.mark.parametrize("name", ["", "a\nb", "a\0", (LONGEST_NAME + 1) * "a", 1_000_000 * "a"])
def test_a_room_of_a_name_that_none_has_is_refused_in_few_words(name: str) -> None:
    with pytest.raises(CleanRefusedError, match="1 to 80 printable characters") as refusal:
        CleanRequest(CleanMode.ROOMS, rooms=("hall", name))
    assert len(str(refusal.value)) < 200
