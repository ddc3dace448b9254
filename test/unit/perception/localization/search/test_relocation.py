"""Finding the robot again: what is believed at once, what takes more views, and what never."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.located import (
    CONFIG,
    FURNISHED,
    LIDAR,
    SQUARE,
    TWO_ROOMS,
    Eye,
    Ranges,
    free_poses,
)

from roomba.geometry import Pose, wrap_angle
from roomba.grid import OccupancyMap
from roomba.perception.localization.search.relocation import (
    KEPT,
    Expectation,
    Hypothesis,
    Relocation,
    Verdict,
)
from roomba.perception.matching.surface_field import SurfaceField
from roomba.world.home.home import Home

RECKONED = Pose(-3.0, 7.0, 2.0)
"""Dead reckoning's frame lies anywhere."""


def begin(home: Home, ranges: Ranges, expectation: Expectation | None = None) -> Relocation:
    """Search until all is searched."""
    relocation = Relocation(
        SurfaceField.of(home.map),
        CONFIG.localization,
        CONFIG.body.radius,
        LIDAR.view(ranges),
        RECKONED,
        expectation,
    )
    for _ in range(1000):
        if relocation.verdict is not Verdict.SEARCHING:
            return relocation
        assert not relocation.hypotheses
        relocation.advance()
    raise AssertionError("the search does not end")


def best(relocation: Relocation, reckoned: Pose = RECKONED) -> Pose:
    return relocation.hypotheses[0].frame.compose(reckoned)


def is_at(found: Pose, pose: Pose) -> bool:
    turn = abs(wrap_angle(found.theta - pose.theta))
    return found.distance_to(pose.x, pose.y) < 0.02 and turn < 0.01


@pytest.mark.parametrize("home", [FURNISHED, TWO_ROOMS])
def test_one_look_finds_it_where_a_home_tells_places_apart(home: Home) -> None:
    random = np.random.default_rng(3)
    eye = Eye(home)
    found = 0
    for pose in free_poses(home, 12, random):
        relocation = begin(home, eye.scan(pose, random))
        assert relocation.verdict in (Verdict.FOUND, Verdict.AMBIGUOUS)
        if relocation.verdict is Verdict.FOUND:
            assert is_at(best(relocation), pose)
            found += 1
    assert found >= 10


def test_the_likeliest_comes_first() -> None:
    relocation = begin(TWO_ROOMS, Eye(TWO_ROOMS).scan(Pose(5.2, 2.0, 0.0)))
    evidence = [each.evidence for each in relocation.hypotheses]
    assert evidence == sorted(evidence, reverse=True)
    assert len(evidence) <= KEPT


def test_the_same_place_is_there_but_once() -> None:
    relocation = begin(
        SQUARE,
        Eye(SQUARE).scan(Pose(1.0, 1.2, 0.3)),
        Expectation(Pose(1.05, 1.22, 0.32), 0.2, 0.2, 1.0),
    )
    places = [each.frame.compose(RECKONED) for each in relocation.hypotheses]
    for index, one in enumerate(places):
        for other in places[:index]:
            is_near = one.distance_to(other.x, other.y) < 0.2
            assert not (is_near and abs(wrap_angle(one.theta - other.theta)) < 0.2)


def test_a_square_is_never_found_however_much_is_seen() -> None:
    random, eye = np.random.default_rng(2), Eye(SQUARE)
    start = Pose(1.0, 1.2, 0.3)
    relocation = begin(SQUARE, eye.scan(start, random))
    for step in range(40):
        move = Pose(0.2 * math.sin(step), 0.2 * math.cos(step), 0.7 * step)
        relocation.see(LIDAR.view(eye.scan(start.compose(move), random)), RECKONED.compose(move))
        assert relocation.verdict is Verdict.AMBIGUOUS
        assert len(relocation.hypotheses) >= 4
    assert relocation.views > 20


def test_looking_at_more_tells_two_rooms_apart_that_look_alike_at_first() -> None:
    """The scan reaches 1.3 m at first: a corner like any other; then it reaches farther."""
    eye = Eye(TWO_ROOMS)
    start = Pose(0.7, 0.7, 0.3)
    ranges = eye.scan(start)
    relocation = begin(TWO_ROOMS, np.where(ranges < 1.3, ranges, np.inf).astype(np.float32))
    assert relocation.verdict is Verdict.AMBIGUOUS
    for step in range(1, 7):
        move = Pose(0.15 * step, 0.0, 0.0)
        relocation.see(LIDAR.view(eye.scan(start.compose(move))), RECKONED.compose(move))
    assert relocation.verdict is Verdict.FOUND
    assert is_at(best(relocation, RECKONED.compose(move)), start.compose(move))


def test_a_scan_from_the_same_place_says_nothing_new() -> None:
    eye, start = Eye(SQUARE), Pose(1.0, 1.2, 0.3)
    relocation = begin(SQUARE, eye.scan(start))
    before = [each.evidence for each in relocation.hypotheses]
    view = LIDAR.view(eye.scan(start))
    for move in (Pose(), Pose(0.1, 0.0, 0.0), Pose(0.0, 0.05, 0.35)):
        relocation.see(view, RECKONED.compose(move))
    assert relocation.views == 1
    assert [each.evidence for each in relocation.hypotheses] == before
    relocation.see(
        LIDAR.view(eye.scan(start.compose(Pose(0.0, 0.0, 0.5)))),
        RECKONED.compose(Pose(0.0, 0.0, 0.5)),
    )
    assert relocation.views == 2


def test_nowhere_is_said_of_a_scan_that_fits_nowhere() -> None:
    random = np.random.default_rng(1)
    relocation = begin(FURNISHED, random.uniform(0.3, 6.0, 360).astype(np.float32))
    assert relocation.verdict is Verdict.NOWHERE


def changed(pose: Pose) -> Ranges:
    """Four of ten beams end too early: things stand around that no map knows."""
    ranges = Eye(FURNISHED).scan(pose)
    ranges[60:204] *= 0.6
    return ranges


def expected_at(pose: Pose) -> Expectation:
    return Expectation(pose, 0.2, 0.2, CONFIG.localization.needed_evidence + 2.0)


def test_where_it_is_expected_half_of_the_beams_are_enough() -> None:
    """Homes change more often than robots are elsewhere."""
    pose = Pose(1.4, 2.6, 0.7)
    ranges = changed(pose)
    assert begin(FURNISHED, ranges).verdict is not Verdict.FOUND
    relocation = begin(FURNISHED, ranges, expected_at(Pose(1.42, 2.58, 0.72)))
    assert relocation.verdict is Verdict.FOUND
    assert is_at(best(relocation), pose)
    turned = begin(FURNISHED, ranges, expected_at(Pose(1.42, 2.58, 1.1)))
    assert turned.verdict is not Verdict.FOUND


def test_where_nothing_fits_at_all_expecting_it_there_does_not_help() -> None:
    random = np.random.default_rng(1)
    ranges = random.uniform(0.3, 6.0, 360).astype(np.float32)
    assert begin(FURNISHED, ranges, expected_at(Pose(1.4, 2.6, 0.7))).verdict is not Verdict.FOUND


def test_an_expectation_does_not_hold_where_another_place_fits_much_better() -> None:
    pose = Pose(1.2, 1.0, 0.3)
    scan = Eye(FURNISHED).scan(pose)
    relocation = begin(FURNISHED, scan, expected_at(Pose(4.0, 2.5, 1.0)))
    assert relocation.verdict is Verdict.FOUND
    assert is_at(best(relocation), pose)


def test_of_places_that_look_alike_the_expected_one_is_believed() -> None:
    pose = Pose(1.0, 1.2, 0.3)
    scan = Eye(SQUARE).scan(pose)
    assert begin(SQUARE, scan).verdict is Verdict.AMBIGUOUS
    relocation = begin(SQUARE, scan, expected_at(Pose(1.1, 1.15, 0.2)))
    assert relocation.verdict is Verdict.FOUND
    assert is_at(best(relocation), pose)
    turned = begin(SQUARE, scan, expected_at(Pose(1.1, 1.15, 0.8)))
    assert turned.verdict is Verdict.AMBIGUOUS


def test_a_place_that_fits_but_fairly_is_not_believed() -> None:
    """It agrees with 60 to 70 of 100 beams: where it is may not be among the places that fit."""
    eye, start = Eye(FURNISHED), Pose(1.4, 2.6, 0.7)
    ranges = eye.scan(start)
    ranges[60:170] *= 0.6
    relocation = begin(FURNISHED, ranges)
    assert 0.5 <= relocation.hypotheses[0].fit.agree < 0.7
    assert relocation.verdict is Verdict.NOWHERE


def test_hypotheses_follow_when_dead_reckoning_drifts() -> None:
    eye, start = Eye(FURNISHED), Pose(1.0, 0.8, 0.2)
    relocation = begin(FURNISHED, eye.scan(start))
    for step in range(1, 9):
        reckoned = RECKONED.compose(Pose(0.15 * step, 0.0, 0.0))
        there = start.compose(Pose(0.12 * step, 0.0, 0.02 * step))
        relocation.see(LIDAR.view(eye.scan(there)), reckoned)
        assert is_at(best(relocation, reckoned), there)
    assert relocation.views == 9


def twin_rooms() -> Home:
    """Two rooms that are the same to the last cell."""
    values = np.hstack((FURNISHED.map.values, FURNISHED.map.values))
    frame = replace(FURNISHED.map.frame, columns=values.shape[1])
    return replace(FURNISHED, map=OccupancyMap(frame, np.ascontiguousarray(values)))


def test_a_place_is_tied_with_another_one_that_all_fits_as_well() -> None:
    pose, twins = Pose(1.5, 1.0, 0.3), twin_rooms()
    width = FURNISHED.map.frame.columns * FURNISHED.map.frame.resolution
    other = replace(pose, x=pose.x + width)
    relocation = begin(twins, Eye(FURNISHED).scan(pose))
    assert relocation.verdict is Verdict.AMBIGUOUS
    assert relocation.is_tied(pose, RECKONED)
    assert relocation.is_tied(other, RECKONED)
    assert not relocation.is_tied(Pose(4.0, 2.5, 0.0), RECKONED)
    assert not begin(FURNISHED, Eye(FURNISHED).scan(pose)).is_tied(pose, RECKONED)


@pytest.mark.parametrize(("spread", "is_clear"), [(0.01, True), (0.15, False)])
def test_where_the_map_fits_badly_a_small_lead_tells_no_places_apart(
    spread: float, is_clear: bool
) -> None:
    """Errors of a map are the same for beams beside each other and favour one place of two."""
    relocation = begin(FURNISHED, Eye(FURNISHED).scan(Pose(1.5, 1.0, 0.3)))
    best = relocation.hypotheses[0]
    best.evidence = -1000.0 * spread
    lead = 1.5 * CONFIG.localization.needed_evidence
    relocation.hypotheses.append(
        Hypothesis(Pose(9.0, 9.0, 0.0), best.evidence - lead, best.fit, is_expected=False)
    )
    assert (relocation.verdict is Verdict.FOUND) == is_clear
