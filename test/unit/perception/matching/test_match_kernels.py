"""Matching a scan to a map: it finds small offsets, says how sure it is, and never breaks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.robots.located import CORRIDOR, FURNISHED, LIDAR, TWO_ROOMS, Eye, free_poses
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.matching.field_kernels import look
from roomba.perception.matching.match_kernels import add_beams, beam_ends, invert, match
from roomba.perception.matching.scan_view import ScanView
from roomba.perception.matching.surface_field import SurfaceField
from roomba.world.home.home import Home

Floats = NDArray[np.float64]

FROM_AFAR = np.array([0.40, 0.30, 0.20, 0.10, 0.05, 0.05])
VARIANCE = 0.06**2
PRIOR = np.diag([0.1**2, 0.1**2, 0.06**2])
FIELD = SurfaceField.of(FURNISHED.map)
EYE = Eye(FURNISHED)


def matched(
    field: SurfaceField, view: ScanView, prior: Floats, covariance: Floats = PRIOR
) -> tuple[Floats, Floats]:
    pose, after = prior.copy(), covariance.copy()
    match(field.values, field.place, view.ends, len(view), prior, after, FROM_AFAR, VARIANCE, pose)
    return pose, after


@pytest.mark.parametrize("home", [FURNISHED, TWO_ROOMS])
@pytest.mark.parametrize("is_noisy", [False, True])
def test_it_recovers_offsets_of_8_cm_and_3_degrees(home: Home, is_noisy: bool) -> None:
    random = np.random.default_rng(3)
    field, eye = SurfaceField.of(home.map), Eye(home)
    for true in free_poses(home, 60, random):
        view = LIDAR.view(eye.scan(true, random if is_noisy else None))
        way, turn = random.uniform(-math.pi, math.pi), math.radians(random.choice([-3.0, 3.0]))
        prior = np.array(
            [true.x + 0.08 * math.cos(way), true.y + 0.08 * math.sin(way), true.theta + turn]
        )
        pose, _ = matched(field, view, prior)
        assert math.hypot(pose[0] - true.x, pose[1] - true.y) < 0.005, true
        assert pose[2] == pytest.approx(true.theta, abs=math.radians(0.25)), true


def test_along_a_corridor_without_features_it_keeps_the_prior() -> None:
    field, eye = SurfaceField.of(CORRIDOR.map), Eye(CORRIDOR)
    random = np.random.default_rng(1)
    for theta in (0.2, 1.3, -2.0):
        view = LIDAR.view(eye.scan(Pose(15.0, 0.62, theta), random))
        pose, covariance = matched(field, view, np.array([15.06, 0.58, theta + 0.03]))
        assert pose[0] == pytest.approx(15.06, abs=1e-3)
        assert pose[1] == pytest.approx(0.62, abs=0.003)
        assert pose[2] == pytest.approx(theta, abs=0.004)
        assert covariance[0, 0] == pytest.approx(PRIOR[0, 0], rel=0.02)
        assert covariance[1, 1] < 0.01**2
        assert covariance[2, 2] < 0.01**2


def test_beams_weigh_against_the_prior_by_their_certainty() -> None:
    """One wall, one beam: the mean of two measurements, weighed by their variances."""
    view = ScanView(np.array([[1.0, 0.0, 1.0, 0.0]]), np.zeros(3))
    wall = np.tile(1.05 - 0.05 * np.arange(60, dtype=np.float32), (20, 1))
    pose, prior = np.array([0.0, 0.5, 0.0]), np.array([0.0, 0.5, 0.0])
    covariance = np.diag([0.04, 1e-12, 1e-12])
    # The surface is at 1.05 m; the end at 1.00 m; scales so wide that all counts in full.
    scales = np.array([1e6])
    place = np.array([0.0, 0.0, 0.05])
    match(wall, place, view.ends, 1, prior, covariance, scales, 0.01, pose)
    assert pose[0] == pytest.approx(0.05 * 0.04 / (0.04 + 0.01), abs=1e-6)
    assert covariance[0, 0] == pytest.approx(1.0 / (1.0 / 0.04 + 1.0 / 0.01), rel=1e-5)


def test_the_prior_s_correlations_count() -> None:
    """A corridor tells y; if y and x were unsure together, it tells x as well."""
    field, eye = SurfaceField.of(CORRIDOR.map), Eye(CORRIDOR)
    view = LIDAR.view(eye.scan(Pose(15.0, 0.62, 0.0)))
    together = np.array([[0.0101, 0.01, 0.0], [0.01, 0.0101, 0.0], [0.0, 0.0, 0.01]])
    pose, _ = matched(field, view, np.array([14.96, 0.58, 0.0]), together)
    assert pose[0] == pytest.approx(15.0, abs=0.002)


def test_what_the_map_does_not_know_pulls_but_little() -> None:
    """A quarter of the beams ends 40 cm too early: a person stands there."""
    true = Pose(1.4, 2.6, 0.7)
    ranges = EYE.scan(true)
    ranges[40:130] = np.maximum(ranges[40:130] - 0.4, 0.2)
    pose, _ = matched(FIELD, LIDAR.view(ranges), np.array([1.44, 2.57, 0.73]))
    assert pose == pytest.approx([true.x, true.y, true.theta], abs=0.005)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_no_beams_change_nothing_and_few_change_little(count: int) -> None:
    view = LIDAR.view(EYE.scan(Pose(1.0, 1.0, 0.0)))
    few = ScanView(view.ends[:: len(view) // max(count, 1)][:count], view.mount)
    prior = np.array([1.03, 0.98, 0.02])
    pose, covariance = matched(FIELD, few, prior)
    if count == 0:
        assert pose.tolist() == prior.tolist()
        assert covariance == pytest.approx(PRIOR, rel=1e-9)
    else:
        assert np.abs(pose - prior).max() < 0.05
        assert np.sqrt(np.linalg.eigvalsh(covariance)[-1]) > 0.05


def test_beams_off_the_map_change_nothing() -> None:
    view = LIDAR.view(EYE.scan(Pose(1.0, 1.0, 0.0)))
    prior = np.array([100.0, -50.0, 1.0])
    pose, covariance = matched(FIELD, view, prior)
    assert pose.tolist() == prior.tolist()
    assert covariance == pytest.approx(PRIOR, rel=1e-9)


COVARIANCES = st.tuples(
    *[st.floats(1e-4, 3.0)] * 3, *[st.floats(-0.95, 0.95)] * 2, st.floats(-math.pi, math.pi)
).map(lambda numbers: covariance_of(*numbers))


def covariance_of(x: float, y: float, theta: float, xt: float, yt: float, turn: float) -> Floats:
    """Any shape: deviations along axes that are turned, and coupled to the heading."""
    lower = np.array([[x, 0.0, 0.0], [0.3 * x, y, 0.0], [theta * xt, theta * yt, theta]])
    cosine, sine = math.cos(turn), math.sin(turn)
    axes = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(axes @ lower @ lower.T @ axes.T)


@given(
    st.tuples(st.floats(-1.0, 6.0), st.floats(-1.0, 5.0), st.floats(-7.0, 7.0)),
    COVARIANCES,
    st.integers(0, 2**32 - 1),
    st.integers(0, 360),
)
@settings(max_examples=examples(150))
def test_any_scan_anywhere_leaves_a_covariance_that_is_one_and_no_larger_than_before(
    prior: tuple[float, float, float], covariance: Floats, seed: int, beams: int
) -> None:
    random = np.random.default_rng(seed)
    ranges = np.full(360, np.inf, np.float32)
    ranges[:beams] = random.uniform(0.15, 12.0, beams)
    pose, after = matched(FIELD, LIDAR.view(ranges), np.array(prior), covariance)
    assert np.isfinite(pose).all()
    assert np.isfinite(after).all()
    assert after.tolist() == after.T.tolist()
    assert np.linalg.eigvalsh(after)[0] > 0.0
    # In units of the prior: 1 where nothing was learned.
    root = np.linalg.inv(np.linalg.cholesky(covariance))
    assert np.linalg.eigvalsh(root @ after @ root.T)[-1] <= 1.0 + 1e-6


FINITE = st.floats(allow_nan=False, allow_infinity=False)


@given(st.tuples(FINITE, FINITE, FINITE), st.lists(FINITE, max_size=12))
@settings(max_examples=examples(200))
def test_no_finite_prior_and_no_scan_at_all_makes_nan(
    prior: tuple[float, float, float], few: list[float]
) -> None:
    ranges = np.full(360, np.nan, np.float32)
    with np.errstate(over="ignore"):
        ranges[: len(few)] = np.array(few, np.float64).astype(np.float32)
    pose, covariance = matched(FIELD, LIDAR.view(ranges), np.array(prior))
    assert np.isfinite(pose).all()
    assert np.isfinite(covariance).all()


def test_a_prior_that_knows_all_stays_as_it_is() -> None:
    view = LIDAR.view(EYE.scan(Pose(1.0, 1.0, 0.0)))
    prior = np.array([1.03, 0.98, 0.02])
    pose, covariance = matched(FIELD, view, prior, np.zeros((3, 3)))
    assert pose.tolist() == prior.tolist()
    assert not covariance.any()


@given(COVARIANCES)
def test_the_inverse_is_that_of_numpy(matrix: Floats) -> None:
    out = np.empty((3, 3))
    assert invert(np.triu(matrix), out)
    assert out @ matrix == pytest.approx(np.eye(3), abs=1e-5)


@pytest.mark.parametrize(
    "matrix", [np.zeros((3, 3)), np.diag([1.0, 1.0, 0.0]), np.full((3, 3), np.nan)]
)
def test_what_has_no_inverse_is_told(matrix: Floats) -> None:
    assert not invert(matrix, np.empty((3, 3)))


def test_gradients_are_those_of_half_the_squared_distances() -> None:
    """With a wide scale all beams count in full, and the gradient is that of a plain sum."""
    view = LIDAR.view(EYE.scan(Pose(1.0, 1.0, 0.4)))

    def half_squares(pose: Floats) -> float:
        cosine, sine = math.cos(pose[2]), math.sin(pose[2])
        ends = view.ends[:, :2] @ np.array([[cosine, sine], [-sine, cosine]]) + pose[:2]
        return 0.5 * sum(look(FIELD.values, FIELD.place, x, y)[0] ** 2 for x, y in ends.tolist())

    at = np.array([1.02, 0.97, 0.42])
    information, gradient, lanes = np.zeros((3, 3)), np.zeros(3), view.ends[:, :2].T.copy()
    add_beams(FIELD.values, FIELD.place, lanes, len(view), at, 1e6, 1.0, information, gradient)
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = 1e-5
        slope = (half_squares(at + step) - half_squares(at - step)) / 2e-5
        assert gradient[axis] == pytest.approx(slope, rel=0.02, abs=0.02)
    assert np.linalg.eigvalsh(information + np.triu(information, 1).T)[0] > 0.0


def test_a_beam_that_is_a_scale_off_weighs_a_quarter() -> None:
    slope = np.tile(0.05 * np.arange(60, dtype=np.float32), (20, 1))
    place = np.array([0.0, 0.0, 0.05])
    information, gradient = np.zeros((3, 3)), np.zeros(3)
    lanes = np.array([[0.3], [0.0]])
    add_beams(slope, place, lanes, 1, np.array([0.0, 0.5, 0.0]), 0.3, 8.0, information, gradient)
    assert information[0, 0] == pytest.approx(2.0)
    assert gradient[0] == pytest.approx(2.0 * 0.3)


def test_ends_are_those_of_the_beams_in_reach_through_the_mount() -> None:
    ranges = np.array([1.0, 0.1, 2.0, np.inf, -np.inf, np.nan, 11.9, 12.0], np.float32)
    angles = np.arange(8) * (math.pi / 4.0)
    ends = np.full((8, 4), 7.0)
    directions = np.column_stack((np.cos(angles), np.sin(angles)))
    mount = Pose(0.1, -0.05, 0.5)
    count = beam_ends(ranges, directions, np.array([0.1, -0.05, 0.5]), 0.15, 12.0, ends)
    assert count == 3
    for row, beam in enumerate((0, 2, 6)):
        end = mount.compose(
            Pose(
                float(ranges[beam]) * math.cos(angles[beam]),
                float(ranges[beam]) * math.sin(angles[beam]),
            )
        )
        assert ends[row, :2] == pytest.approx([end.x, end.y])
        assert ends[row, 2:] == pytest.approx(
            [math.cos(0.5 + angles[beam]), math.sin(0.5 + angles[beam])]
        )
    assert (ends[3:] == 7.0).all()
