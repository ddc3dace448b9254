"""How well a scan fits a pose: beam by beam, against cases that can be counted."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.references.sphere_traced import expected_range
from fixtures.robots.located import FURNISHED, LIDAR, TWO_ROOMS, Eye, free_poses
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.matching.fit_kernels import (
    AGREEING,
    EVIDENCE,
    JUDGE_LANES,
    LOOKED_AT,
    SHORT,
    THROUGH,
    judge,
)
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField

EYE = Eye(FURNISHED)
FIELD = SurfaceField.of(FURNISHED.map)


def fit_at(pose: Pose, view: ScanView, field: SurfaceField = FIELD, stride: int = 1) -> Fit:
    return view.fit(field, np.array([pose.x, pose.y, pose.theta]), stride)


def two_walls() -> SurfaceField:
    """A wall from x = 2.0 to 2.2 m, and another one from x = 3.0 m on."""
    values = np.full((40, 80), FREE, np.int8)
    values[:, 40:44] = values[:, 60:] = OCCUPIED
    return SurfaceField.of(OccupancyMap(GridFrame(0.05, 0.0, 0.0, 40, 80), values))


def one_beam(length: float) -> ScanView:
    return ScanView(np.array([[length, 0.0, 1.0, 0.0]]), np.zeros(3))


@pytest.mark.parametrize(
    ("length", "agree", "short", "through"),
    [
        (1.0, 1.0, 0.0, 0.0),
        # So much is noise of the beam, the pose and the map: 6 cm, and 1 % of the way.
        (1.065, 1.0, 0.0, 0.0),
        (0.935, 1.0, 0.0, 0.0),
        # Something that the map does not know is in front of the wall.
        (0.92, 0.0, 1.0, 0.0),
        (0.5, 0.0, 1.0, 0.0),
        # Inside of the wall, behind it, and on the wall behind it.
        (1.09, 0.0, 0.0, 1.0),
        (1.6, 0.0, 0.0, 1.0),
        (2.0, 0.0, 0.0, 1.0),
    ],
)
def test_a_beam_agrees_or_is_short_or_goes_through(
    length: float, agree: float, short: float, through: float
) -> None:
    fit = fit_at(Pose(1.0, 1.0, 0.0), one_beam(length), two_walls())
    assert (fit.agree, fit.short, fit.through) == (agree, short, through)


def test_the_slack_grows_with_the_range() -> None:
    wall = np.full((20, 260), FREE, np.int8)
    wall[:, 240:] = OCCUPIED
    field = SurfaceField.of(OccupancyMap(GridFrame(0.05, 0.0, 0.0, 20, 260), wall))
    assert fit_at(Pose(2.0, 0.5, 0.0), one_beam(10.15), field).agree == 1.0
    assert fit_at(Pose(11.0, 0.5, 0.0), one_beam(1.15), field).through == 1.0


def test_evidence_says_more_the_nearer_a_beam_ends_and_least_behind_walls() -> None:
    pose, field = Pose(1.0, 1.0, 0.0), two_walls()
    lengths = (1.0, 1.02, 1.05, 0.5, 1.6)
    evidence = [fit_at(pose, one_beam(length), field).evidence for length in lengths]
    assert evidence[0] == pytest.approx(0.0, abs=1e-5)
    assert evidence == sorted(evidence, reverse=True)
    # A perfect hit is e^(10 x 0.1 x 3.5) times as likely as ten beams that end anywhere.
    assert evidence[3] == pytest.approx(0.1 * math.log(0.03), rel=0.01)
    assert evidence[4] == pytest.approx(0.1 * math.log(0.01))


def test_where_it_was_seen_all_beams_agree() -> None:
    for pose in free_poses(FURNISHED, 30, np.random.default_rng(6)):
        fit = fit_at(pose, LIDAR.view(EYE.scan(pose)))
        # Nearly: some just miss a corner.
        assert fit.agree > 0.98
        assert fit.evidence > -3.0


def test_in_a_wrong_place_beams_go_through_walls_and_the_evidence_says_so() -> None:
    random = np.random.default_rng(4)
    here = free_poses(FURNISHED, 30, random)
    there = free_poses(FURNISHED, 30, random)
    through = []
    for pose, wrong in zip(here, there, strict=True):
        view = LIDAR.view(EYE.scan(pose, random))
        right, fit = fit_at(pose, view), fit_at(wrong, view)
        if wrong.distance_to(pose.x, pose.y) > 0.5:
            assert fit.evidence < right.evidence - 15.0
            assert fit.agree < 0.8
            through.append(fit.through)
    assert len(through) > 20
    assert np.median(through) > 0.25


def test_what_stands_in_the_way_is_short_and_not_through() -> None:
    pose = Pose(1.2, 1.0, 0.4)
    ranges = EYE.scan(pose)
    ranges[100:172] = 0.3
    fit = fit_at(pose, LIDAR.view(ranges))
    assert fit.short == pytest.approx(0.2, abs=0.02)
    assert fit.through < 0.02


@given(
    st.tuples(st.floats(-1.0, 6.0), st.floats(-1.0, 5.0), st.floats(-7.0, 7.0)),
    st.integers(0, 2**32 - 1),
    st.integers(0, 360),
    st.integers(1, 9),
)
@settings(max_examples=examples(100))
def test_shares_add_to_1_and_evidence_is_never_for_what_is_not_there(
    pose: tuple[float, float, float], seed: int, beams: int, stride: int
) -> None:
    random = np.random.default_rng(seed)
    ranges = np.full(360, np.inf, np.float32)
    ranges[:beams] = random.uniform(0.15, 12.0, beams)
    fit = fit_at(Pose(*pose), LIDAR.view(ranges), stride=stride)
    shares = (fit.agree, fit.short, fit.through)
    assert min(shares) >= 0.0
    assert sum(shares) == pytest.approx(1.0 if beams else 0.0)
    asked = math.ceil(beams / stride)
    assert 0.1 * math.log(0.01) * asked - 1e-9 <= fit.evidence <= 0.0


def test_with_a_stride_only_some_beams_are_asked() -> None:
    pose, counts = np.array([1.2, 1.0, 0.4]), np.full(5, 9.0)
    lanes = np.empty((JUDGE_LANES, 360))
    view = LIDAR.view(EYE.scan(Pose(*pose.tolist())))
    judge(FIELD.values, FIELD.place, view.ends, len(view), pose, view.mount, 8, counts, lanes)
    assert counts[LOOKED_AT] == math.ceil(len(view) / 8)
    assert counts[[AGREEING, SHORT, THROUGH]].sum() == counts[LOOKED_AT]
    assert counts[EVIDENCE] <= 0.0


def test_the_way_of_a_beam_begins_at_the_lidar() -> None:
    """The middle of the robot is behind a wall, its lidar is not, and sees the next wall."""
    view = ScanView(np.array([[2.0, 0.0, 1.0, 0.0]]), np.array([1.3, 0.0, 0.0]))
    assert fit_at(Pose(1.0, 1.0, 0.0), view, two_walls()).agree == 1.0
    sideways = ScanView(np.array([[0.0, -2.0, 0.0, -1.0]]), np.array([0.0, -1.3, 0.0]))
    assert fit_at(Pose(1.0, 1.0, 0.5 * math.pi), sideways, two_walls()).agree == 1.0


def test_what_a_map_shows_where_the_lidar_is_hides_nothing() -> None:
    """A person who walked behind the robot was drawn there."""
    values = np.full((40, 80), FREE, np.int8)
    values[:, 60:] = OCCUPIED
    values[19:21, 20] = OCCUPIED
    field = SurfaceField.of(OccupancyMap(GridFrame(0.05, 0.0, 0.0, 40, 80), values))
    assert fit_at(Pose(1.02, 1.0, 0.0), one_beam(1.98), field).agree == 1.0
    assert fit_at(Pose(0.8, 1.0, 0.0), one_beam(2.2), field).through == 1.0


def test_the_lidar_sees_past_an_edge_that_the_middle_of_the_robot_does_not() -> None:
    """A wall ahead for y < 1 m, and one a metre behind it for the rest."""
    values = np.full((40, 80), FREE, np.int8)
    values[:20, 40:] = values[20:, 60:] = OCCUPIED
    field = SurfaceField.of(OccupancyMap(GridFrame(0.05, 0.0, 0.0, 40, 80), values))
    view = ScanView(np.array([[2.0, 0.6, 1.0, 0.0]]), np.array([0.0, 0.6, 0.0]))
    assert fit_at(Pose(1.0, 0.7, 0.0), view, field).agree == 1.0
    assert fit_at(Pose(1.0, 0.2, 0.0), view, field).through == 1.0


def test_off_the_map_no_beam_agrees() -> None:
    view = LIDAR.view(Eye(TWO_ROOMS).scan(Pose(1.0, 1.0, 0.0)))
    fit = fit_at(Pose(50.0, 50.0, 0.0), view)
    assert (fit.agree, fit.short, fit.through) == (0.0, 1.0, 0.0)


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=examples(60))
def test_beams_go_through_what_a_ray_of_its_own_meets_before(seed: int) -> None:
    """All rays at once mark the same beams as each ray for itself."""
    random = np.random.default_rng(seed)
    pose = free_poses(FURNISHED, 1, random)[0]
    ranges = EYE.scan(pose, random)
    ranges[random.integers(0, 360, 40)] += random.uniform(0.05, 1.0, 40).astype(np.float32)
    view = LIDAR.view(ranges)
    off = pose.compose(Pose(*random.normal(0.0, 0.03, 3).tolist()))
    through = 0
    for x, y, along, across in view.ends.tolist():
        length = math.hypot(x, y)
        there = off.compose(Pose(along, across))
        to_x, to_y = there.x - off.x, there.y - off.y
        # The robot itself fills the first 0.1 m.
        met = 0.1 + expected_range(
            FIELD, off.x + 0.1 * to_x, off.y + 0.1 * to_y, to_x, to_y, length
        )
        through += met < length - (0.06 + 0.01 * length)
    assert fit_at(off, view).through * len(view) == pytest.approx(through, abs=0.5)
