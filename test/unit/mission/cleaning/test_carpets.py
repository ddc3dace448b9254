"""Cleans over a carpet: what the fan does there, and what is left out."""

from __future__ import annotations

import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import NOISY
from fixtures.robots.missions import STATION, until

from roomba.clean_request import CleanRequest
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.cleaning.stages import edges_of
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.vocabulary import CarpetWay, EdgeOrder, FanLevel, Phase
from roomba.world.home.home import DirtSource

CARPET = (1.4, 0.4, 2.6, 2.1)
HOME = room_home(
    3.0,
    2.5,
    station=STATION,
    carpets=(CARPET,),
    sources=(DirtSource("dust", 2.0, 1.25, 0.8, 4.0, 0.0),),
)
BARE = room_home(3.0, 2.5, station=STATION)
DRAWN = Zones((Zone("rug", ZoneKind.CARPET, ((1.4, 0.4), (2.6, 0.4), (2.6, 2.1), (1.4, 2.1))),))
LATE = 0.12
"""m; that it drives before it feels another floor."""


WAYS = [
    (CleanRequest(), True),
    (CleanRequest(carpets=CarpetWay.SAME), False),
    (CleanRequest(fan=FanLevel.QUIET), False),
]


def depth_in_carpet(robot: HeadlessMission) -> float:
    """Return how far it really is within the carpet, m; below 0 off it."""
    left, low, right, high = CARPET
    x, y = robot.simulator.pose.x, robot.simulator.pose.y
    return min(x - left, right - x, y - low, high - y)


@pytest.mark.parametrize(("request_", "boosts"), WAYS, ids=["boost", "same", "quiet"])
def test_the_fan_is_stronger_on_carpet_and_as_asked_off_it(
    request_: CleanRequest, boosts: bool
) -> None:
    robot = HeadlessMission(HOME, NOISY, seed=1, longest_burst=0)
    robot.mission.clean(request_, robot.senses())
    asked = NOISY.fan.duty_at(request_.fan)
    ticks = dict.fromkeys((True, False), 0)
    while sum(ticks.values()) < 400:
        robot.advance()
        depth, mission = depth_in_carpet(robot), robot.mission
        if mission.state.phase is not Phase.CLEANING or abs(depth) < LATE:
            continue
        ticks[depth > 0.0] += 1
        assert mission.is_on_carpet is (depth > 0.0)
        is_strong = robot.simulator.duty[1] == NOISY.fan.strong
        assert is_strong or robot.simulator.duty[1] == asked
        assert is_strong is (boosts and depth > 0.0)
    assert min(ticks.values()) > 20


def test_in_bursts_it_feels_the_same() -> None:
    both = [HeadlessMission(HOME, NOISY, seed=1, longest_burst=burst) for burst in (0, 100)]
    for robot in both:
        robot.mission.clean(CleanRequest(), robot.senses())
        until(robot, lambda robot=robot: robot.seen.time > 60.0, 90.0)  # type: ignore[misc]
    ticked, burst = both
    while burst.seen.time > ticked.seen.time:
        ticked.tick()
    assert burst.simulator.pose == ticked.simulator.pose
    assert burst.seen.in_bin == ticked.seen.in_bin > 0.0
    assert burst.mission.carpet.rows == ticked.mission.carpet.rows


def test_a_carpet_that_is_drawn_counts_where_none_is_felt() -> None:
    robot = HeadlessMission(BARE, NOISY, seed=1, zones=DRAWN)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, lambda: depth_in_carpet(robot) > LATE, 120.0)
    assert robot.mission.is_on_carpet
    assert robot.simulator.duty[1] == NOISY.fan.strong


def test_a_carpet_that_is_drawn_is_left_out_if_that_is_asked_for() -> None:
    robot = HeadlessMission(BARE, NOISY, seed=1, zones=DRAWN)
    result = robot.clean(CleanRequest(carpets=CarpetWay.AVOID)).result
    left, low, right, high = CARPET
    assert result.outcome is CleanOutcome.COMPLETED
    whole = HeadlessMission(BARE, NOISY, seed=1).mission.context
    area = whole.coverable().sum() * whole.frame.resolution**2
    assert result.wanted == pytest.approx(area - (right - left) * (high - low), abs=0.01)
    assert result.covered > 0.99 * result.wanted


@pytest.mark.parametrize("order", [EdgeOrder.FIRST, EdgeOrder.LAST])
def test_edges_are_cleaned_before_the_rest_or_after_it(order: EdgeOrder) -> None:
    robot = HeadlessMission(BARE, NOISY, seed=1)
    robot.mission.clean(CleanRequest(edges=order), robot.senses())
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    until(robot, lambda: cleaning.ledger.stage_number == 1, 400.0)
    context = robot.mission.context
    edges = edges_of(context.coverable(), context)
    swept = cleaning.ledger.clean
    first, other = (edges, ~edges) if order is EdgeOrder.FIRST else (~edges, edges)
    wanted = context.coverable()
    assert (swept & first & wanted).sum() > 0.98 * (first & wanted).sum()
    assert (swept & other & wanted).sum() < 0.7 * (other & wanted).sum()
