"""Following a known pose: noisy drives, and homes that do not look as their map does."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from fixtures.robots.located import (
    CLOSED,
    CONFIG,
    CORRIDOR,
    FURNISHED,
    LIDAR,
    MOVED,
    SQUARE,
    TWO_ROOMS,
    Eye,
    Ranges,
    free_poses,
    glass,
)
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.geometry import Pose, wrap_angle
from roomba.perception.localization.belief.belief import Rows, numbers_of, unknown_belief
from roomba.perception.localization.belief.reckon_kernels import carry
from roomba.perception.localization.tracker import Tracker
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField
from roomba.world.home.home import Home

WAY_NOISE, TURN_NOISE = 0.01, math.radians(1.0)
"""m, rad; of each step of 0.1 s: much more than wheels have."""
SPREAD = np.diag([WAY_NOISE**2, WAY_NOISE**2, TURN_NOISE**2])
SURE = np.diag([0.02**2, 0.02**2, 0.02**2])


def tracker_at(home: Home, pose: Pose) -> Tracker:
    return tracker_in(SurfaceField.of(home.map), pose, SURE, unknown_belief())


def tracker_in(
    field: SurfaceField, pose: Pose, covariance: NDArray[np.float64], belief: Rows
) -> Tracker:
    numbers = numbers_of(CONFIG.localization, CONFIG.gyro)
    return Tracker(field, pose, covariance, belief, numbers)


def moved(
    pose: Pose, covariance: NDArray[np.float64], step: Pose, spread: NDArray[np.float64]
) -> tuple[Pose, NDArray[np.float64]]:
    """Return a pose and its covariance after a step in its own frame, unsure by ``spread``.

    ``spread`` is float64 [3, 3] along the axes of the robot after the step.
    """
    after, unsure = pose.as_array(), covariance.copy()
    carry(after, unsure, step.x, step.y, step.theta, *np.diag(spread).tolist())
    return Pose(*after.tolist()), unsure


def move(tracker: Tracker, step: Pose, spread: NDArray[np.float64]) -> None:
    tracker.pose, tracker.covariance = moved(tracker.pose, tracker.covariance, step, spread)


def loop(count: int, middle: Pose, radius: float) -> list[Pose]:
    """A drive in a wobbling circle around a point, 3 cm a step."""
    turn = 0.03 / radius
    poses = []
    for step in range(count):
        angle, out = turn * step, radius * (1.0 + 0.3 * math.sin(0.11 * step))
        x, y = middle.x + out * math.cos(angle), middle.y + out * math.sin(angle)
        poses.append(Pose(x, y, wrap_angle(angle + 0.5 * math.pi + 0.3 * math.sin(0.2 * step))))
    return poses


def follow(
    home: Home,
    truth: list[Pose],
    seed: int = 0,
    see_as: Callable[[Ranges, Pose], Ranges] = lambda ranges, pose: ranges,
) -> tuple[Tracker, float, int]:
    """Return the tracker after a drive, its largest error, m, and how often it was in doubt."""
    random, eye = np.random.default_rng(seed), Eye(home)
    tracker = tracker_at(home, truth[0].compose(Pose(*random.normal(0.0, 0.02, 3).tolist())))
    worst, doubts = 0.0, 0
    for before, after in pairwise(truth):
        step = before.inverse().compose(after)
        noise = random.normal(0.0, (WAY_NOISE, WAY_NOISE, TURN_NOISE))
        move(tracker, step.compose(Pose(*noise.tolist())), SPREAD)
        view = LIDAR.view(see_as(eye.scan(after, random), after))
        tracker.see(view)
        tracker.judge(view)
        worst = max(worst, tracker.pose.distance_to(after.x, after.y))
        doubts += tracker.is_doubtful
    return tracker, worst, doubts


IN_FURNISHED = loop(250, Pose(3.4, 1.3, 0.0), 0.6)
IN_LEFT_ROOM = loop(250, Pose(2.0, 0.9, 0.0), 0.45)


@pytest.mark.parametrize("seed", range(3))
def test_it_follows_noisy_drives(seed: int) -> None:
    tracker, worst, doubts = follow(FURNISHED, IN_FURNISHED, seed)
    assert worst < 0.02
    assert abs(wrap_angle(tracker.pose.theta - IN_FURNISHED[-1].theta)) < math.radians(1.0)
    assert doubts == 0


def test_its_error_is_what_its_covariance_says() -> None:
    """The square of the error, in units of the covariance, is 3 on average if that is right."""
    random, eye = np.random.default_rng(8), Eye(FURNISHED)
    tracker = tracker_at(FURNISHED, IN_FURNISHED[0])
    inside = total = 0
    for before, after in pairwise(IN_FURNISHED):
        noise = random.normal(0.0, (WAY_NOISE, WAY_NOISE, TURN_NOISE))
        step = before.inverse().compose(after).compose(Pose(*noise.tolist()))
        move(tracker, step, SPREAD)
        tracker.see(LIDAR.view(eye.scan(after, random)))
        off = tracker.pose
        error = np.array([off.x - after.x, off.y - after.y, wrap_angle(off.theta - after.theta)])
        inside += float(error @ np.linalg.solve(tracker.covariance, error)) < 11.3
        total += 1
    assert inside >= 0.95 * total


@pytest.mark.parametrize("seed", range(2))
def test_moved_furniture_does_not_drag_it_away(seed: int) -> None:
    assert follow(MOVED, IN_FURNISHED, seed)[1] < 0.03


@pytest.mark.parametrize("seed", range(2))
def test_a_closed_door_does_not_drag_it_away(seed: int) -> None:
    _, worst, doubts = follow(CLOSED, IN_LEFT_ROOM, seed)
    assert worst < 0.03
    assert doubts == 0


@pytest.mark.parametrize("radius", [0.05, 0.2])
def test_round_things_that_no_map_knows_do_not_drag_it_away(radius: float) -> None:
    discs = [(3.4, 1.3), (4.2, 2.6), (2.4, 0.9), (1.2, 1.4)]

    def see_as(ranges: Ranges, pose: Pose) -> Ranges:
        angles = pose.theta + np.arange(len(ranges)) * (2.0 * np.pi / len(ranges))
        for x, y in discs:
            ahead = (x - pose.x) * np.cos(angles) + (y - pose.y) * np.sin(angles)
            aside = (y - pose.y) * np.cos(angles) - (x - pose.x) * np.sin(angles)
            meets = (np.abs(aside) < radius) & (ahead > 0.0)
            way = ahead - np.sqrt(np.maximum(radius**2 - aside**2, 0.0))
            ranges = np.where(meets, np.minimum(ranges, way), ranges).astype(np.float32)
        return ranges

    assert follow(FURNISHED, IN_FURNISHED, see_as=see_as)[1] < 0.03


@pytest.mark.parametrize("behind", [math.inf, 2.0])
@pytest.mark.parametrize("home", [FURNISHED, SQUARE])
def test_a_glass_wall_does_not_drag_it_away(home: Home, behind: float) -> None:
    truth = IN_FURNISHED if home is FURNISHED else loop(200, Pose(1.5, 1.5, 0.0), 0.6)
    _, worst, doubts = follow(home, truth, see_as=lambda ranges, pose: glass(ranges, pose, behind))
    assert worst < 0.03
    # It was so from the beginning: what is usual here.
    assert doubts == 0


def moved_wall_among_much_else(ranges: Ranges) -> Ranges:
    """Ahead, a fifth of the beams see a wall that is 8 cm nearer; all others end at no wall."""
    turns = np.arange(len(ranges)) / len(ranges)
    ahead = np.minimum(turns, 1.0 - turns) < 0.1
    return np.where(ahead, ranges - np.float32(0.08), np.float32(0.4) * ranges)


def test_what_little_agrees_with_the_map_takes_it_nowhere_and_teaches_no_walls() -> None:
    """The rest is not where the map has it: what agrees may have been moved as well."""
    pose, belief = Pose(3.4, 1.3, 0.0), unknown_belief()
    field = SurfaceField.of(FURNISHED.map)
    tracker = tracker_in(field, pose, SURE, belief)
    ranges = Eye(FURNISHED).scan(pose)
    for _ in range(10):
        tracker.see(LIDAR.view(ranges))
        tracker.judge(LIDAR.view(ranges))
    assert not tracker.is_doubtful
    before, sure = tracker.pose, tracker.covariance[0, 0]
    for number in range(100):
        move(tracker, Pose(), 0.01 * SPREAD)
        belief["unlike"] = 1.0  # as if it saw another place each time
        view = LIDAR.view(moved_wall_among_much_else(ranges))
        tracker.see(view)
        tracker.judge(view)
        assert tracker.is_doubtful or number < 3
        if number == 3:
            learned = belief["wall_offset"].copy()
    assert tracker.pose.distance_to(before.x, before.y) < 0.01
    assert (belief["wall_offset"] == learned).all()
    # It grows unsure meanwhile, and is put right by the next scan that fits.
    assert tracker.covariance[0, 0] > 1.5 * sure
    tracker.see(LIDAR.view(ranges))
    assert tracker.pose.distance_to(pose.x, pose.y) < 0.01


def test_along_a_corridor_it_becomes_unsure_and_across_it_does_not() -> None:
    truth = [Pose(12.0 + 0.03 * step, 0.6, 0.1 * math.sin(0.1 * step)) for step in range(200)]
    tracker, _, _ = follow(CORRIDOR, truth)
    along, across = np.sqrt(np.diag(tracker.covariance)[:2])
    assert along == pytest.approx(math.sqrt(0.02**2 + 199 * WAY_NOISE**2), rel=0.15)
    assert across < 0.01
    assert abs(tracker.pose.y - truth[-1].y) < 0.02
    assert abs(tracker.pose.x - truth[-1].x) < 3.0 * along


def test_an_unsure_pose_is_matched_from_farther_away() -> None:
    eye, field = Eye(FURNISHED), SurfaceField.of(FURNISHED.map)
    random = np.random.default_rng(0)
    for true in free_poses(FURNISHED, 20, random):
        way = random.uniform(-math.pi, math.pi)
        off = Pose(0.25 * math.cos(way), 0.25 * math.sin(way))
        start = Pose(true.x + off.x, true.y + off.y, true.theta + 0.15)
        unsure = tracker_in(field, start, np.diag([0.09, 0.09, 0.04]), unknown_belief())
        unsure.see(LIDAR.view(eye.scan(true)))
        assert unsure.pose.distance_to(true.x, true.y) < 0.02


def test_few_beams_err_together_and_tell_less_than_their_number() -> None:
    """Of 15 beams each counts half or less: twice as many tell at least four times as much."""
    here = Pose(1.2, 1.0, 0.3)
    ends = LIDAR.view(Eye(FURNISHED).scan(here)).ends[::24][:15]

    def learned(times: int) -> NDArray[np.float64]:
        tracker = tracker_at(FURNISHED, here)
        tracker.covariance = 1e4 * SURE
        tracker.see(ScanView(np.repeat(ends, times, axis=0), np.zeros(3)))
        return np.linalg.inv(tracker.covariance)

    assert (np.diag(learned(2)) > 3.8 * np.diag(learned(1))).all()
    assert np.diag(learned(4)) == pytest.approx(2.0 * np.diag(learned(2)), rel=0.05)


def see_at(tracker: Tracker, ranges: Ranges, times: int) -> list[bool]:
    view = LIDAR.view(ranges)
    doubts = []
    for _ in range(times):
        tracker.see(view)
        tracker.judge(view)
        doubts.append(tracker.is_doubtful)
    return doubts


@pytest.mark.parametrize("to", [Pose(6.0, 1.2, 2.0), Pose(1.2, 2.6, -2.0), Pose(3.3, 0.6, 1.0)])
def test_a_scan_from_elsewhere_makes_doubts_within_half_a_second(to: Pose) -> None:
    eye = Eye(TWO_ROOMS)
    here = Pose(1.0, 1.0, 0.3)
    tracker = tracker_at(TWO_ROOMS, here)
    assert not any(see_at(tracker, eye.scan(here), 30))
    assert see_at(tracker, eye.scan(to), 5)[-1]


def test_one_bad_scan_makes_no_doubts() -> None:
    eye = Eye(TWO_ROOMS)
    here = Pose(1.0, 1.0, 0.3)
    tracker = tracker_at(TWO_ROOMS, here)
    see_at(tracker, eye.scan(here), 30)
    wrong = eye.scan(here)
    wrong[60:240] = 0.3
    assert not any(see_at(tracker, wrong, 1))
    assert not any(see_at(tracker, eye.scan(here), 5))


def test_beams_through_a_wall_make_doubts_though_most_beams_agree() -> None:
    """A quarter comes back from behind what the map shows: it is not what was moved in front."""
    eye, here = Eye(TWO_ROOMS), Pose(1.0, 1.0, 0.3)
    behind, before = tracker_at(TWO_ROOMS, here), tracker_at(TWO_ROOMS, here)
    ranges = eye.scan(here)
    for tracker, ahead in ((behind, 0.8), (before, -0.3)):
        see_at(tracker, ranges, 30)
        changed = ranges.copy()
        changed[100:190] += ahead
        assert see_at(tracker, changed, 8)[-1] == (ahead > 0.0)


def test_what_changes_slowly_becomes_usual() -> None:
    """A third of the beams, a few more each second, no longer end where the map says."""
    eye, here = Eye(TWO_ROOMS), Pose(1.0, 1.0, 0.3)
    tracker = tracker_at(TWO_ROOMS, here)
    ranges = eye.scan(here)
    for step in range(120):
        ranges[step] = 0.3
        assert not any(see_at(tracker, ranges, 4))
    assert tracker.fit is not None
    assert tracker.fit.agree < 0.7
    assert tracker.pose.distance_to(here.x, here.y) < 0.01


def test_a_trusted_fit_is_usual_from_then_on() -> None:
    eye, here = Eye(TWO_ROOMS), Pose(1.0, 1.0, 0.3)
    tracker = tracker_at(TWO_ROOMS, here)
    ranges = eye.scan(here)
    ranges[:200] = 0.3
    tracker.trust(Fit(0.42, 0.58, 0.0, -9.0))
    assert tracker.fit == Fit(0.42, 0.58, 0.0, -9.0)
    assert not any(see_at(tracker, ranges, 10))


@given(
    st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-3, 3)),
    st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)),
    st.integers(0, 2**32 - 1),
)
def test_a_step_carries_the_covariance_along(
    start: tuple[float, float, float], step: tuple[float, float, float], seed: int
) -> None:
    """Against differences of the motion itself, by the pose and by the step's own errors."""
    random = np.random.default_rng(seed)
    root: NDArray[np.float64] = np.tril(random.uniform(-0.3, 0.3, (3, 3)))
    covariance = root @ root.T
    spread: NDArray[np.float64] = np.diag(random.uniform(0.0, 0.1, 3))
    pose, after = moved(Pose(*start), covariance, Pose(*step), spread)

    def end(off: NDArray[np.float64], error: NDArray[np.float64]) -> NDArray[np.float64]:
        begun = Pose(*(np.array(start) + off).tolist())
        to = begun.compose(Pose(*step)).compose(Pose(*error.tolist()))
        return np.array([to.x, to.y, wrap_angle(to.theta - pose.theta)])

    none, tiny = np.zeros(3), 1e-6 * np.eye(3)
    by_pose = np.column_stack([(end(d, none) - end(-d, none)) / 2e-6 for d in tiny])
    by_step = np.column_stack([(end(none, d) - end(none, -d)) / 2e-6 for d in tiny])
    expected = by_pose @ covariance @ by_pose.T + by_step @ spread @ by_step.T
    assert pose == Pose(*start).compose(Pose(*step))
    assert after == pytest.approx(expected, abs=1e-6)
