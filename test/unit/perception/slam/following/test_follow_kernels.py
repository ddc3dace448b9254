"""The pace at which a follower predicts, and the matches from farther away that it accepts."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, START, points_of, row

from roomba.geometry import Pose
from roomba.perception.localization.belief.belief import BELIEF
from roomba.perception.slam.following import follow_kernels
from roomba.perception.slam.following.follow_kernels import COVARIANCE, FOLLOWER, follow
from roomba.perception.slam.scan_matching.surfels import SurfelGrid

BETWEEN_SCANS = 0.1
"""s."""


def pace_after(places: list[float], before: float) -> list[float]:
    """Return the pace ahead, m/s, after each of the places, m, at which scans put the robot."""
    learn: Any = getattr(follow_kernels._learn_pace, "py_func", follow_kernels._learn_pace)
    follower = SimpleNamespace(here=np.zeros(3), pace=np.array([before, 0.0, 0.0]))
    paces, last = [], 0.0
    for place in places:
        follower.here[0] = place
        learn(follower, last, 0.0, 0.0, BETWEEN_SCANS)
        paces.append(float(follower.pace[0]))
        last = place
    return paces


def test_it_is_how_fast_scans_show_that_the_robot_moves() -> None:
    steady = pace_after([0.05, 0.10, 0.15], 0.5)
    assert steady == pytest.approx([0.5, 0.5, 0.5])
    assert pace_after([0.01, 0.03, 0.06, 0.10], 0.0) == pytest.approx([0.1, 0.2, 0.3, 0.4])


def test_a_jump_along_a_corridor_is_no_pace() -> None:
    """What would be 10 m/s; the robot goes on about as before, and is not thrown back."""
    there, after = pace_after([1.0, 1.05], 0.5)
    assert there == pytest.approx(0.65)
    assert after == pytest.approx(0.5)


ODOMETRY, PACE = (0.05, 0.0, 0.0), (0.06, 0.0, 0.0)
FARTHEST = 0.045
"""m."""


def looked_farther(monkeypatch: pytest.MonkeyPatch, found: tuple[float, ...]) -> float:
    """Return where along x a scan is taken to be from that fits perfectly at ``found`` alone."""
    work = np.zeros(FOLLOWER["work"].shape)
    work[0], work[1], work[2] = ODOMETRY, ODOMETRY, PACE
    follower = SimpleNamespace(work=work, met=0.7, close=0.8)

    def match(follower: Any, *_: object) -> bool:
        follower.work[1], follower.met, follower.close = found, 1.0, 1.0
        return True

    monkeypatch.setattr(follow_kernels, "_match", match)
    for name in ("_look_farther", "_is_leap"):
        kernel: Any = getattr(follow_kernels, name)
        monkeypatch.setattr(follow_kernels, name, getattr(kernel, "py_func", kernel))
    look: Any = follow_kernels._look_farther
    look(follower, None, None, 0, work[0].copy(), 0.9, FARTHEST)
    assert (follower.met == 1.0) == (follower.work[1, 0] == found[0])
    return float(follower.work[1, 0])


def test_a_scan_that_fits_better_nearby_is_taken_from_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert looked_farther(monkeypatch, (0.02, 0.0, 0.0)) == 0.02


def test_odometry_that_is_off_is_corrected_by_a_scan_that_goes_on_at_the_pace(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert looked_farther(monkeypatch, (0.10, 0.0, 0.0)) == 0.10


def test_what_stands_by_a_scan_while_odometry_and_pace_go_on_moves_along_with_the_robot(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert looked_farther(monkeypatch, (0.0, 0.0, 0.0)) == ODOMETRY[0]
    assert looked_farther(monkeypatch, (0.04, 0.06, 0.0)) == ODOMETRY[0]


def followed(expected: float) -> Any:
    """Return the follower after a scan, seen from 5 cm beside where it thinks it is."""
    eye, grid = Eye(FURNISHED), SurfelGrid(8.0)
    grid.add(points_of(eye.scan(START)), row(START))
    points = points_of(eye.scan(Pose(START.x + 0.05, START.y, START.theta)))
    follower: Any = np.zeros(1, FOLLOWER).view(np.recarray)
    belief: Any = np.zeros(1, BELIEF).view(np.recarray)
    follower.here, follower.is_sure = row(START), True
    follower.variance, follower.range_deviation = POINT_VARIANCE, 0.05
    follower.least_points, follower.many_misses = 20, 10
    follower.odometry_scale = 10.0
    follower.standing = 1e-6
    belief.spread = 0.02**2
    follow(follower, belief, np.zeros(3), grid.arrays, points, len(points), BETWEEN_SCANS, expected)
    return follower[0]


def test_a_match_from_farther_away_that_is_rejected_leaves_nothing_behind() -> None:
    """No scan agrees in more than all of its points."""
    without, rejected = followed(0.0), followed(1.1)
    assert rejected.is_sure
    assert rejected.here.tolist() == without.here.tolist()
    assert rejected.odometry_scale.tolist() == without.odometry_scale.tolist()
    for each in range(COVARIANCE, COVARIANCE + 6):
        assert rejected.work[each].tolist() == without.work[each].tolist()


POINT_VARIANCE = 0.03**2
"""m2."""
STEP_DEVIATION = 0.005
"""m; what odometry is thought to be off by in a step."""


def trust_after(range_noise: float, step_error: float, scans: int = 2000) -> float:
    """Return how many times its variances odometry is thought to be off, along x.

    Of a robot that 100 points hold along each axis, with ranges that err by ``range_noise``, m,
    and odometry by ``step_error``, m; a match takes over what its points say, errors included.
    """
    random = np.random.default_rng(1)
    follower = SimpleNamespace(
        work=np.zeros(FOLLOWER["work"].shape),
        spread=np.zeros((3, 3)),
        odometry_scale=np.ones(3),
        range_deviation=range_noise,
        variance=POINT_VARIANCE,
    )
    information = 100.0 / POINT_VARIANCE
    follower.work[7:10] = information * np.eye(3)
    before = 0.0
    for _ in range(scans):
        thought = follower.odometry_scale * STEP_DEVIATION**2
        follower.spread[:] = np.diag(thought)
        follower.work[4:7] = np.diag(1.0 / (information + 1.0 / thought))
        share = follower.work[4, 0] * information
        told = random.normal(0.0, range_noise / 10.0)
        prior = before + random.normal(0.0, step_error)
        before = prior + share * (told - prior)
        follow_kernels._learn_scale(
            follower, np.array([prior, 0.0, 0.0]), np.array([before, 0.0, 0.0])
        )
    return float(follower.odometry_scale[0])


def test_noise_of_ranges_is_not_taken_for_an_error_of_the_wheels() -> None:
    assert trust_after(0.07, 0.002) < 1.5


@pytest.mark.parametrize("range_noise", [0.005, 0.05])
def test_wheels_that_err_are_trusted_less_with_a_noisy_lidar_too(range_noise: float) -> None:
    assert trust_after(range_noise, 0.03) > 50.0
