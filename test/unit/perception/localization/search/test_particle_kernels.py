"""The steps of the particle filter beside slow references."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.robots.located import FURNISHED, LIDAR, Eye
from hypothesis import given
from hypothesis import strategies as st

from roomba.geometry import Pose
from roomba.perception.localization.search.particle_kernels import (
    fill_likelihoods,
    leave_walls,
    move_all,
    normalise,
    resample,
    spread_over,
    weigh_all,
    weight_around,
)
from roomba.perception.matching.surface_field import SurfaceField

FIELD = SurfaceField.of(FURNISHED.map)
OUTSIDE = math.log(0.1)


def test_each_spot_has_each_heading_once() -> None:
    spots = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])
    particles = np.full((24, 4), np.nan)
    spread_over(spots, 8, particles)
    for number, spot in enumerate(spots):
        own = particles[8 * number : 8 * number + 8]
        assert np.unique(own[:, :2], axis=0).tolist() == [spot.tolist()]
        assert np.allclose(np.diff(np.sort(own[:, 2])), math.pi / 4.0)
    assert not particles[:, 3].any()


@given(
    st.floats(-3.0, 3.0), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-1.0, 1.0),
    st.floats(-0.1, 0.1),
)  # fmt: skip
def test_a_particle_moves_as_a_pose_does(
    theta: float, x: float, y: float, turn: float, more: float
) -> None:
    particles, noise = np.array([[1.0, 2.0, theta, 0.5]]), np.array([[more, -more, 0.5 * more]])
    move_all(particles, x, y, turn, noise)
    expected = Pose(1.0, 2.0, theta).compose(Pose(x + more, y - more, 0.0))
    assert particles[0, :2] == pytest.approx([expected.x, expected.y])
    assert particles[0, 2:] == pytest.approx([theta + turn + 0.5 * more, 0.5])


def likelihood(distance: float, depth: float, spread: float, chance: float) -> float:
    off = distance if distance > 0.0 else max(0.0, -distance - depth)
    return math.log(chance + (1.0 - chance) * math.exp(-0.5 * (off / spread) ** 2))


@pytest.mark.parametrize("depth", [0.0, 0.1, 0.2])
def test_a_beam_is_the_likelier_the_nearer_to_a_surface_or_a_little_inside(depth: float) -> None:
    likelihoods = np.empty_like(FIELD.values)
    fill_likelihoods(FIELD.values, depth, 0.2, 0.1, likelihoods)
    for row, column in np.random.default_rng(0).integers(0, min(FIELD.values.shape), (50, 2)):
        expected = likelihood(float(FIELD.values[row, column]), depth, 0.2, 0.1)
        assert likelihoods[row, column] == pytest.approx(expected, abs=1e-5)


def test_a_weight_is_the_sum_over_the_beams() -> None:
    likelihoods = np.empty_like(FIELD.values)
    fill_likelihoods(FIELD.values, 0.1, 0.2, 0.1, likelihoods)
    view = LIDAR.view(Eye(FURNISHED).scan(Pose(1.2, 1.0, 0.3)))
    chosen = np.arange(0, len(view), 7)
    poses = np.array([[1.2, 1.0, 0.3], [2.0, 1.0, -2.0], [4.9, 3.9, 1.0]])
    particles = np.column_stack((poses, [0.0, 1.0, 2.0]))
    weigh_all(likelihoods, FIELD.place, view.ends, chosen, 0.25, OUTSIDE, particles)
    for pose, before, after in zip(poses, (0.0, 1.0, 2.0), particles[:, 3], strict=True):
        ends = view.ends_at(Pose(*pose.tolist()))[chosen].astype(float)
        total = 0.0
        for x, y in ends.tolist():
            row, column = FIELD.frame.cell_of(x, y)
            inside = 0 <= row < FIELD.frame.rows and 0 <= column < FIELD.frame.columns
            total += float(likelihoods[row, column]) if inside else OUTSIDE
        assert after == pytest.approx(before + 0.25 * total, rel=1e-2)
    assert particles[0, 3] > particles[1, 3] - 1.0


def test_particles_in_walls_and_off_the_map_have_no_weight() -> None:
    inside, wall, off = (1.2, 1.0), (-0.05, 1.0), (50.0, 1.0)
    particles = np.array([[*at, 0.0, 0.0] for at in (inside, wall, off)])
    leave_walls(FIELD.values, FIELD.place, 0.0, particles)
    assert particles[:, 3].tolist() == [0.0, -math.inf, -math.inf]


def test_weights_sum_up_to_one_and_tell_how_many_particles_they_are_worth() -> None:
    particles, weights = np.zeros((4, 4)), np.empty(4)
    assert normalise(particles, weights) == pytest.approx(4.0)
    assert weights == pytest.approx(0.25)
    particles[:, 3] = -1e4, -1e4 + math.log(3.0), -math.inf, -math.inf
    assert normalise(particles, weights) == pytest.approx(1.0 / (0.25**2 + 0.75**2))
    assert weights == pytest.approx([0.25, 0.75, 0.0, 0.0])
    particles[:, 3] = -math.inf
    assert normalise(particles, weights) == 0.0


@given(
    st.lists(st.floats(0.01, 1.0), min_size=1, max_size=20),
    st.integers(1, 50),
    st.floats(0.0, 0.999),
)
def test_each_is_drawn_as_often_as_its_weight_says(
    weights: list[float], count: int, start: float
) -> None:
    """Low variance: no more and no less than the share of it, up to one."""
    shares = np.array(weights) / sum(weights)
    particles = np.zeros((len(weights), 4))
    particles[:, 0] = np.arange(len(weights))
    particles[:, 3] = 5.0
    chosen = np.full((count, 4), np.nan)
    resample(particles, shares, start, chosen)
    drawn = np.bincount(chosen[:, 0].astype(int), minlength=len(weights))
    assert np.all(np.abs(drawn - count * shares) <= 1.0 + 1e-6)
    assert not chosen[:, 3].any()


def test_the_weight_around_a_place_and_its_middle() -> None:
    at = np.array([1.0, 1.0, math.pi - 0.05])
    particles = np.array(
        [
            [1.1, 1.0, -math.pi + 0.05, 0.0],
            [0.9, 1.0, math.pi - 0.15, 0.0],
            [3.0, 1.0, math.pi, 0.0],
            [1.0, 1.0, 0.0, 0.0],
        ]
    )
    middle = np.zeros(3)
    weights = np.array([0.2, 0.2, 0.5, 0.1])
    assert weight_around(particles, weights, at, 0.7, 0.4, middle) == pytest.approx(0.4)
    assert middle == pytest.approx([1.0, 1.0, math.pi - 0.05])
    assert weight_around(particles, weights, at + 10.0, 0.7, 0.4, middle) == 0.0
