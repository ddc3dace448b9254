"""Finding the robot again where scans stop fitting because dead reckoning is wrong."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import Eye
from numpy.typing import NDArray

from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.configuration.sensors import LidarConfig
from roomba.geometry import Pose
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.following.finding_back import FindingBack
from roomba.perception.slam.mapper import Mapper

Floats = NDArray[np.float64]

CUPBOARDS = (
    (1.5, 0.0, 2.1, 0.4),
    (3.6, 2.0, 4.5, 2.4),
    (6.0, 0.0, 6.3, 0.5),
    (7.7, 1.9, 8.6, 2.4),
    (9.4, 0.0, 10.6, 0.3),
    (12.0, 2.1, 12.4, 2.4),
)
EYE = Eye(room_home(16.0, 2.4, CUPBOARDS))
SPEED, PERIOD = 1.0, 0.2
"""m/s, s; a quick robot whose lidar is slow."""
ANGLES = np.radians(np.arange(-90.0, 91.0))
BEAMS = np.round(np.degrees(ANGLES)).astype(int) % 360
"""Those of a scan all around."""
LIDAR = LidarModel(ANGLES, 0.1, 12.0, Pose())


def true_pose(time: float) -> Pose:
    """It drives along a hall, a little to and fro."""
    return Pose(1.0 + SPEED * time, 1.2 + 0.2 * math.sin(time), 0.2 * math.cos(time))


def mapper_at(start: Pose) -> Mapper:
    config = RobotConfig()
    return Mapper(MappingConfig(), config.localization, config.gyro, start)


def driven(frozen: float, leaps: bool) -> tuple[Mapper, list[float]]:
    """Return the mapper and its errors after each scan, m.

    After 5 s odometry stands still for some time; then it leaps to where the robot is, or not.
    """
    random, mapper = np.random.default_rng(2), mapper_at(true_pose(0.0))
    errors, lost, shown = [], Pose(), true_pose(0.0)
    for tick in range(round(12.0 / PERIOD)):
        now = tick * PERIOD
        here = true_pose(now)
        if not 5.0 < now < 5.0 + frozen:
            shown = lost.compose(here)
        elif not leaps:
            lost = shown.compose(here.inverse())
        mapper.move(now, shown)
        noise = random.normal(0.0, 0.01, len(BEAMS))
        ranges = (EYE.scan(here)[BEAMS] + noise).astype(np.float32)
        mapper.see(now, ranges, LIDAR)
        errors.append(mapper.at_scan.distance_to(here.x, here.y))
    return mapper, errors


@pytest.mark.parametrize("leaps", [True, False], ids=["leaps after it", "goes on from there"])
@pytest.mark.parametrize("frozen", [0.7, 1.5, 3.0])
def test_odometry_that_stands_still_for_a_while_does_not_carry_it_away(
    frozen: float, leaps: bool
) -> None:
    """Scans tell that the robot goes on, though its wheels say that it stands."""
    mapper, errors = driven(frozen, leaps)
    assert mapper.estimate.knowledge is Knowledge.KNOWN
    assert max(errors) < 0.9
    assert max(errors[-15:]) < 0.25
    mapper.finish()
    end = true_pose(12.0 - PERIOD)
    assert mapper.at_scan.distance_to(end.x, end.y) < 0.25


FAR_APART = 10.0
"""s between scans that are a metre apart, as logs keep them."""


def test_in_a_hall_that_is_larger_than_the_search_a_turn_of_the_wheels_is_put_right() -> None:
    """What is farther than it looks is no reason against a place, and few beams show a wall."""
    pillars = [
        (6.0 * n, 12.0 + 4.0 * n % 9, 6.0 * n + 1.5, 13.0 + 4.0 * n % 9) for n in range(1, 7)
    ]
    far = LidarConfig(max_range=40.0, sweep_time=0.0)
    eye = Eye(room_home(44.0, 34.0, pillars), far)
    lidar = LidarModel(ANGLES, 0.1, 40.0, Pose())
    true, slipped = Pose(3.0, 17.0, 0.1), Pose(0.0, 0.0, math.radians(9.0))
    mapper, shown = mapper_at(true), true
    for step in range(20):
        mapper.move(FAR_APART * step, shown)
        mapper.see(FAR_APART * step, eye.scan(true)[BEAMS].astype(np.float32), lidar)
        assert mapper.estimate.knowledge is Knowledge.KNOWN or not step
        assert mapper.at_scan.distance_to(true.x, true.y) < 0.15
        moved = Pose(1.0, 0.0, -0.01)
        true = true.compose(moved)
        shown = shown.compose(moved if step != 9 else moved.compose(slipped))


def test_a_piece_begins_where_the_wheels_say() -> None:
    """Scans that show something else each time tell nothing; then the map goes by the wheels."""
    here = Pose()
    mapper = mapper_at(here)
    for step in range(12):
        ranges = np.full(len(ANGLES), 0.7 + 0.12 * step, np.float32)
        mapper.move(FAR_APART * step, here)
        mapper.see(FAR_APART * step, ranges, LIDAR)
        assert mapper.at_scan.distance_to(here.x, here.y) < 0.01
        here = here.compose(Pose(4.0, 0.0, 0.1))
    assert len(mapper.ways_apart) == 1
    # It drove far between the scans: it was not carried, and the piece is where the wheels say.
    assert not mapper._map.graph._carried_to


def test_what_stops_to_fit_from_one_scan_to_the_next_was_carried() -> None:
    here, mapper = Pose(4.0, 1.2, 0.0), mapper_at(Pose(4.0, 1.2, 0.0))
    for tick in range(40):
        at = Pose(0.03 * tick)
        # After 1 s it is where everything looks different; its wheels drive on as before.
        ranges = EYE.scan(here.compose(at))[BEAMS] if tick < 10 else np.full(len(ANGLES), 0.9)
        mapper.move(0.1 * tick, at, 0.0)
        mapper.see(0.1 * tick, ranges.astype(np.float32), LIDAR)
    assert mapper._map.graph._carried_to == {len(mapper._map.graph.submaps) - 1: False}


@pytest.mark.parametrize("is_missed", [True, False])
def test_what_does_not_fit_after_a_pause_counts_as_carried(is_missed: bool) -> None:
    """Odometry has leapt by 3 m meanwhile, and everything looks different."""
    here, mapper = Pose(4.0, 1.2, 0.0), mapper_at(Pose(4.0, 1.2, 0.0))
    for tick in range(40):
        at, now = Pose(0.03 * tick), 0.1 * tick
        ranges = EYE.scan(here.compose(at))[BEAMS] if tick < 10 else np.full(len(ANGLES), 0.9)
        if tick >= 10:
            at, now = Pose(0.03 * tick + 3.0), now + 60.0
        if tick == 10 and is_missed:
            mapper.miss(0.1 * tick)
        mapper.move(now, at, 0.0)
        mapper.see(now, ranges.astype(np.float32), LIDAR)
    graph = mapper._map.graph
    assert set(graph._carried_to) == ({len(graph.submaps) - 1} if is_missed else set())
    assert len(mapper.ways_apart) == 1


@pytest.mark.parametrize("is_bridged", [True, False])
def test_a_pause_after_which_scans_fit_says_nothing_of_later_ones(is_bridged: bool) -> None:
    here, mapper = Pose(4.0, 1.2, 0.0), mapper_at(Pose(4.0, 1.2, 0.0))
    for step in range(16):
        ranges = np.full(len(ANGLES), 0.7 + 0.12 * step) if step > 3 else EYE.scan(here)[BEAMS]
        if step == (2 if is_bridged else 4):
            mapper.miss(FAR_APART * step - 1.0)
        mapper.move(FAR_APART * step, here)
        mapper.see(FAR_APART * step, ranges.astype(np.float32), LIDAR)
        here = here.compose(Pose(0.2) if step < 3 else Pose(4.0, 0.0, 0.1))
    assert len(mapper.ways_apart) == 1
    assert bool(mapper._map.graph._carried_to) is not is_bridged


CORNER = np.array(
    [(x, 2.0) for x in np.arange(-1.5, 2.0, 0.1)] + [(2.0, y) for y in np.arange(-1.5, 2.0, 0.1)]
)
AHEAD = 2.5
"""m; so far before the place where it is thought to be a scan fits."""


@pytest.mark.parametrize(("told", "is_found"), [(0.0, True), (AHEAD, False)])
def test_it_is_looked_for_where_odometry_that_stood_still_may_have_left_it(
    told: float, is_found: bool
) -> None:
    """Not so far off where odometry told of the way that it drives in that time."""
    tried: list[Floats] = []
    follower: Any = SimpleNamespace(
        points=np.column_stack((CORNER - (AHEAD, 0.0), np.zeros_like(CORNER))),
        here=np.zeros(3),
        unsure_way=told,
        unsure_turn=0.0,
        shows_enough=True,
        is_sure=False,
        try_at=lambda pose, better: tried.append(pose),
    )
    finding = FindingBack(MappingConfig())
    row = finding.state[0]
    row["stamp"], row["well_since"], row["pace"] = FAR_APART, 0.0, AHEAD / FAR_APART
    finding.search(follower, [np.column_stack((CORNER, np.zeros_like(CORNER)))])
    assert bool(tried) is is_found
    if is_found:
        assert tried[0][:2] == pytest.approx((AHEAD, 0.0), abs=0.1)


@pytest.mark.parametrize(
    ("to", "leaps"), [(Pose(0.2, 0.1, 0.1), False), (Pose(0.5, 0.3, 0.2), True)]
)
def test_a_place_that_is_farther_than_wheels_slip_begins_a_piece(to: Pose, leaps: bool) -> None:
    """One scan alone may be wrong; what is seen from there on tells whether it was right."""
    mapper, here = mapper_at(Pose(4.0, 1.2, 0.0)), Pose(4.0, 1.2, 0.0)
    for tick in range(8):
        mapper.move(0.1 * tick, Pose(0.02 * tick, 0.0, 0.0), 0.0)
        mapper.see(0.1 * tick, EYE.scan(here.compose(Pose(0.02 * tick)))[BEAMS], LIDAR)
    assert mapper.ways_apart == []
    there = here.compose(Pose(0.14)).compose(to)
    for tick in range(8, 11):
        mapper.move(0.1 * tick, Pose(0.14, 0.0, 0.0), 0.0)
        mapper.see(0.1 * tick, EYE.scan(there)[BEAMS], LIDAR)
    assert (len(mapper.ways_apart) == 1) is leaps
    assert mapper.pose.distance_to(there.x, there.y) < 0.1


def test_a_place_that_one_scan_showed_after_a_pause_is_not_relied_on() -> None:
    """Neither does odometry say that the robot is there, nor do other scans."""
    mapper, here = mapper_at(Pose(4.0, 1.2, 0.0)), Pose(4.0, 1.2, 0.0)
    for tick in range(8):
        mapper.move(0.1 * tick, Pose(0.02 * tick, 0.0, 0.0), 0.0)
        mapper.see(0.1 * tick, EYE.scan(here.compose(Pose(0.02 * tick)))[BEAMS], LIDAR)
    mapper.miss(0.7)
    mapper.move(60.0, Pose(0.14, 0.0, 0.0), 0.0)
    mapper.see(60.0, EYE.scan(here.compose(Pose(0.64, 0.3, 0.2)))[BEAMS], LIDAR)
    assert mapper._map.graph._carried_to == {1: True}
