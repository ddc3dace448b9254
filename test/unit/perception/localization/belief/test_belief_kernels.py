"""The belief's kernels against plain Python, and against the classes that share them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import pytest
from fixtures.homes.worlds import DT
from fixtures.robots.located import (
    CONFIG,
    LIDAR,
    START,
    TWO_ROOMS,
    WORST_ERROR,
    Located,
    Ranges,
    look_until_known,
    started,
    steps,
)
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.perception.localization.belief.belief import (
    ADAPTING,
    SMOOTHING,
    numbers_of,
    share_of,
    unknown_belief,
)
from roomba.perception.localization.belief.correct_kernels import (
    calibrate,
    correct,
    deviation,
    is_calm,
)
from roomba.perception.localization.belief.reckon_kernels import (
    LEFT_OUT,
    WAS_SET_BACK,
    WENT_ON,
    reckon,
    reckon_on,
)
from roomba.perception.localization.estimate import Knowledge, worst_deviation
from roomba.perception.localization.localizer import Localizer
from roomba.world.observation import Observation

Floats = NDArray[np.float64]
LOCALIZATION, GYRO = CONFIG.localization, CONFIG.gyro


@dataclass
class Plain:
    """Dead reckoning as it is written in books: poses and matrices."""

    pose: Pose
    covariance: Floats
    reckoned: Pose = field(default_factory=Pose)
    odometry: Pose | None = None
    stamp: float = -math.inf
    turning: float = math.nan
    bias: float = 0.0
    samples: int = 0
    still_since: float = math.inf
    spread: Floats = field(default_factory=lambda: np.zeros(3))

    def move(self, stamp: float, odometry: Pose, turning: float) -> int:
        since = stamp - self.stamp
        if -0.1 < since <= 0.0:
            return LEFT_OUT
        step = Pose() if self.odometry is None else self.odometry.inverse().compose(odometry)
        if 0.0 < since < math.hypot(step.x, step.y) / 3.0 - 0.05:
            step = Pose()
        elapsed = since if 0.0 < since <= 1.0 and self.odometry is not None else 0.0
        self.odometry, self.stamp = odometry, stamp
        way = math.hypot(step.x, step.y)
        self.learn(way, step.theta, turning)
        turn, variance = self.turn(way, step.theta, turning, elapsed)
        bent = Pose(0.0, 0.0, 0.5 * (turn - step.theta)).compose(Pose(step.x, step.y))
        spread = np.array([LOCALIZATION.way_noise**2, LOCALIZATION.side_noise**2, 0.0]) * way
        spread[:2] += LOCALIZATION.turn_way_noise**2 * abs(turn)
        spread[2] = variance
        self.spread += spread
        self.reckoned = self.reckoned.compose(Pose(bent.x, bent.y, turn))
        after = self.pose.compose(Pose(bent.x, bent.y, turn))
        jacobian, axes = np.eye(3), np.eye(3)
        jacobian[:2, 2] = self.pose.y - after.y, after.x - self.pose.x
        cosine, sine = math.cos(after.theta), math.sin(after.theta)
        axes[:2, :2] = [[cosine, -sine], [sine, cosine]]
        self.covariance = jacobian @ self.covariance @ jacobian.T + axes @ np.diag(spread) @ axes.T
        self.pose = after
        return WENT_ON if since > 0.0 else WAS_SET_BACK

    def learn(self, way: float, turn: float, turning: float) -> None:
        if way > 1e-4 or abs(turn) > 1e-4 or math.isnan(turning):
            self.still_since, self.samples = math.inf, 0
            return
        self.still_since = min(self.still_since, self.stamp)
        worst = 5.0 * (4.0 * GYRO.bias + 4.0 * GYRO.noise)
        if self.stamp - self.still_since >= 0.3 and abs(turning) <= worst:
            self.samples += 1
            self.bias += (turning - self.bias) / (self.samples + 20.0)

    def turn(
        self, way: float, wheels: float, turning: float, elapsed: float
    ) -> tuple[float, float]:
        before, self.turning = self.turning, turning
        noise = LOCALIZATION
        by_wheels = noise.wheel_turn_noise**2 * way + noise.turn_noise**2 * abs(wheels) + 1e-9
        if math.isnan(turning) or elapsed == 0.0:
            return wheels, by_wheels
        before = turning if math.isnan(before) else before
        gyro = (0.5 * (before + turning) - self.bias) * elapsed
        by_gyro = (
            (GYRO.noise * elapsed) ** 2
            + noise.gyro_drift**2 * elapsed
            + noise.turn_noise**2 * abs(gyro)
            + (0.3 * (turning - before) * elapsed) ** 2
        )
        by_wheels += (gyro - wheels) ** 2
        share = by_wheels / (by_wheels + by_gyro)
        return wheels + share * (gyro - wheels), share * by_gyro


@st.composite
def drives(draw: st.DrawFn) -> list[tuple[float, Pose, float]]:
    """Stamps, odometry and gyro as they may come: late, twice, set back, jumping, standing."""
    time, odometry, told = 10.0, Pose(1.0, -2.0, 3.0), []
    for _ in range(draw(st.integers(1, 25))):
        time += draw(st.sampled_from([DT, DT, 0.0, -0.05, -5.0, 0.7, 20.0]))
        step = draw(
            st.sampled_from(
                [Pose(), Pose(0.02, 0.0, 0.03), Pose(-0.01, 0.001, -0.2), Pose(9.0, 0.0, 1.0)]
            )
        )
        odometry = odometry.compose(step)
        told.append((time, odometry, draw(st.sampled_from([0.0, 0.003, -0.5, 2.0, math.nan]))))
    return told


@given(drives())
@settings(max_examples=examples(200))
def test_reckoning_is_that_of_plain_python(told: list[tuple[float, Pose, float]]) -> None:
    spread = np.array([[0.01, 0.002, 0.001], [0.002, 0.02, -0.003], [0.001, -0.003, 0.04]])
    plain = Plain(Pose(0.3, 0.4, -3.0), spread)
    beliefs, numbers = unknown_belief(), numbers_of(LOCALIZATION, GYRO)
    belief = beliefs[0]
    belief["pose"], belief["covariance"] = (0.3, 0.4, -3.0), spread
    for stamp, odometry, turning in told:
        done = reckon(beliefs, numbers, stamp, odometry.x, odometry.y, odometry.theta, turning)
        assert done == plain.move(stamp, odometry, turning)
        assert same(belief["pose"], plain.pose)
        assert same(belief["reckoned"], plain.reckoned)
        assert belief["covariance"] == pytest.approx(plain.covariance, rel=1e-9, abs=1e-12)
        assert belief["spread"] == pytest.approx(plain.spread, rel=1e-9, abs=1e-15)
        assert belief["bias"] == pytest.approx(plain.bias, abs=1e-15)
        assert belief["stamp"] == plain.stamp


def same(row: Floats, pose: Pose) -> bool:
    x, y, theta = row.tolist()
    apart = (x - pose.x, y - pose.y, wrap_angle(theta - pose.theta))
    return bool(max(map(abs, apart)) < 1e-9)


@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
def test_the_worst_deviation_is_the_estimate_s(a: float, b: float, c: float) -> None:
    root = np.array([[a, 0.0, 0.0], [b, c, 0.0], [0.0, 0.0, 1.0]])
    covariance = root @ root.T
    assert deviation(covariance) == pytest.approx(worst_deviation(covariance), rel=1e-12)


def test_who_is_unsure_without_a_number_is_unsure_without_end() -> None:
    assert deviation(np.full((3, 3), np.nan)) == math.inf


class Kernels:
    """What a compiled loop does with the belief of a localizer that is calm."""

    def __init__(self, localizer: Localizer, every: int = 1) -> None:
        self.belief, self.numbers = localizer.belief, numbers_of(LOCALIZATION, GYRO, every)
        self.field, self.every, self.lidar = localizer.field, every, LIDAR.arrays()
        self.path = localizer.path
        self._scans = 0

    def tick(self, seen: Observation, ranges: Ranges | None) -> bool:
        """Take a tick; tell whether all is calm still."""
        odometry = seen.odometry
        reckon_on(
            self.belief,
            self.numbers,
            self.path,
            seen.time,
            odometry.x,
            odometry.y,
            odometry.theta,
            seen.angular_velocity,
        )
        if ranges is not None:
            if self._scans % self.every == 0:
                field, place = self.field.values, self.field.place
                correct(self.belief, self.numbers, field, place, self.lidar, ranges, seen.time)
                calibrate(self.belief)
            self._scans += 1
        return bool(is_calm(self.belief, self.numbers, seen.time))


def ticks(robot: Located, seconds: float) -> Iterator[tuple[Observation, Ranges | None]]:
    """Drive about by the lidar alone, without feeding the localizer."""
    scans = robot.world.observe().scans
    random = np.random.default_rng(3)
    wanted, seen = Twist(0.2, 0.5), robot.world.observe()
    for step in steps(seconds):
        if step % 30 == 0:
            wanted = Twist(float(random.uniform(0.0, 0.3)), float(random.uniform(-1.2, 1.2)))
        seen = robot.world.step(Twist(-0.1, 0.8) if seen.bumper.pressed else wanted, DT)
        has_scanned, scans = seen.scans != scans, seen.scans
        yield seen, robot.world.ranges if has_scanned else None


def twins() -> tuple[Located, Localizer]:
    """A robot that knows its place, and another localizer that was told the same."""
    robot = Located(TWO_ROOMS, START)
    twin = Localizer(TWO_ROOMS.map, LOCALIZATION, GYRO, CONFIG.body.radius, START)
    for seen, ranges in ticks(robot, 1.0):
        for localizer in (robot.localizer, twin):
            tell(localizer, seen, ranges)
    assert twin.is_calm
    return robot, twin


def tell(localizer: Localizer, seen: Observation, ranges: Ranges | None) -> None:
    localizer.move(seen.time, seen.odometry, seen.angular_velocity)
    if ranges is not None:
        localizer.see(seen.time, ranges, LIDAR)


def test_kernels_do_what_the_classes_do_tick_by_tick_and_the_classes_go_on_from_there() -> None:
    robot, twin = twins()
    kernels = Kernels(twin)
    for seen, ranges in ticks(robot, 20.0):
        tell(robot.localizer, seen, ranges)
        assert kernels.tick(seen, ranges)
        one, other = robot.localizer.belief[0], twin.belief[0]
        for name in ("pose", "covariance", "reckoned", "fit", "agree", "usual_agree", "bias"):
            assert np.abs(one[name] - other[name]).max() < 1e-9, name
        assert one["beams"] == other["beams"]
    twin.resumed(seen.time)
    assert twin.is_calm
    for seen, ranges in ticks(robot, 3.0):
        for localizer in (robot.localizer, twin):
            tell(localizer, seen, ranges)
        one_estimate, other_estimate = robot.localizer.estimate, twin.estimate
        assert one_estimate.knowledge is other_estimate.knowledge is Knowledge.KNOWN
        assert one_estimate.pose.distance_to(other_estimate.pose.x, other_estimate.pose.y) < 1e-9
        assert one_estimate.agreement == other_estimate.agreement
    assert twin.view is not None
    assert robot.localizer.view is not None
    assert (twin.view.ends == robot.localizer.view.ends).all()


@pytest.mark.parametrize("every", [2, 3, 4])
def test_some_scans_are_enough(every: int) -> None:
    robot, twin = twins()
    kernels = Kernels(twin, every)
    for seen, ranges in ticks(robot, 30.0):
        assert kernels.tick(seen, ranges)
        x, y, theta = kernels.belief[0]["pose"].tolist()
        assert seen.pose.distance_to(x, y) < 0.01
        assert abs(wrap_angle(theta - seen.pose.theta)) < math.radians(1.5)


@pytest.mark.parametrize("every", [1, 3, 4])
def test_a_robot_that_is_carried_off_is_noticed_and_found_again(every: int) -> None:
    robot, twin = twins()
    robot.localizer, kernels = twin, Kernels(twin, every)
    robot.world.put(Pose(6.0, 1.2, 2.0))
    before = robot.world.time
    for seen, ranges in ticks(robot, 3.0):
        if not kernels.tick(seen, ranges):
            break
    assert seen.time - before <= 1.3
    twin.resumed(seen.time)
    twin.reconsider(seen.time, robot.world.ranges, LIDAR)
    assert not twin.is_calm
    # The scan that made the doubt decides.
    assert twin.estimate.knowledge is Knowledge.SEARCHING
    assert "does not fit" in twin.estimate.reason
    look_until_known(robot, 15.0)
    assert robot.error < WORST_ERROR


def test_however_often_it_sees_the_same_it_is_not_surer_than_the_map() -> None:
    robot, twin = twins()
    kernels, seen, ranges = Kernels(twin), robot.world.observe(), robot.world.ranges
    for _ in range(300):
        kernels.tick(seen, ranges)
    assert 0.0005 < deviation(twin.belief[0]["covariance"]) < 0.003


def test_one_scan_that_fits_badly_makes_no_doubts_however_few_are_looked_at() -> None:
    for every in (1, 2, 4, 8):
        robot, twin = twins()
        kernels = Kernels(twin, every)
        seen = robot.world.observe()
        ranges = robot.world.ranges
        ranges[:180] = 0.3
        assert kernels.tick(seen, ranges)
        assert kernels.belief[0]["fit"][0] == pytest.approx(0.5, abs=0.05)


def test_after_kernels_a_scan_that_comes_late_counts_as_after_the_classes() -> None:
    robot, twin = twins()
    kernels = Kernels(twin)
    late = robot.world.observe().time, robot.world.ranges.copy()
    for seen, ranges in ticks(robot, 2.0):
        tell(robot.localizer, seen, ranges)
        kernels.tick(seen, ranges)
        if seen.time < late[0] + 1.6:
            late = seen.time, robot.world.ranges.copy()
    twin.resumed(seen.time)
    before = twin.estimate.pose
    for localizer in (robot.localizer, twin):
        localizer.see(*late, LIDAR)
    assert before.distance_to(twin.estimate.pose.x, twin.estimate.pose.y) > 0.0
    one, other = robot.localizer.estimate.pose, twin.estimate.pose
    assert one.distance_to(other.x, other.y) < 1e-9
    assert one.theta == pytest.approx(other.theta, abs=1e-9)


def test_a_blind_lidar_is_not_calm_and_a_silent_one_not_for_long() -> None:
    robot, twin = twins()
    kernels, seen = Kernels(twin), robot.world.observe()
    assert kernels.tick(seen, robot.world.ranges)
    silent = seen.time + LocalizationConfig().scan_timeout
    assert is_calm(twin.belief, kernels.numbers, silent - 0.01)
    assert not is_calm(twin.belief, kernels.numbers, silent + 0.01)
    assert not kernels.tick(seen, np.full(360, np.inf, np.float32))
    twin.resumed(seen.time)
    twin.reconsider(seen.time, np.full(360, np.inf, np.float32), LIDAR)
    assert twin.estimate.knowledge is Knowledge.ROUGH
    assert "sees next to nothing" in twin.estimate.reason


def test_an_unsure_pose_is_not_calm() -> None:
    robot, twin = twins()
    twin.belief[0]["covariance"][0, 0] = 0.07**2
    assert not twin.is_calm
    assert twin.estimate.knowledge is Knowledge.ROUGH
    assert robot.localizer.is_calm


def test_a_place_that_waits_for_something_is_not_calm() -> None:
    robot = started()
    localizer = robot.localizer
    assert localizer.is_calm
    localizer.lift(True)
    assert not localizer.is_calm
    robot = started()
    robot.localizer.told(robot.world.pose, (0.01, 0.01))
    assert not robot.localizer.is_calm
    robot.stay(0.3)
    assert robot.localizer.is_calm
    robot.localizer.forget("it was told so")
    assert not robot.localizer.is_calm
    assert not Localizer(None, LOCALIZATION, GYRO, 0.17, START).is_calm


def test_each_robot_has_a_belief_of_its_own() -> None:
    one, other = started(), started()
    before = other.localizer.belief.copy()
    one.step(Twist(0.2, 0.0))
    assert (other.localizer.belief == before).all()


def test_a_scan_that_stands_for_many_counts_as_many_but_never_all() -> None:
    assert share_of(SMOOTHING, 1, 0.7) == SMOOTHING
    assert share_of(ADAPTING, 3, 1.0) == pytest.approx(1.0 - (1.0 - ADAPTING) ** 3)
    assert share_of(SMOOTHING, 9, 0.7) == 0.7
