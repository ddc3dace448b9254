"""Errors of wheels, gyro and lidar are found from how the lidar was seen to move."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from fixtures.robots.worn import (
    BASE,
    TICK,
    Told,
    Worn,
    corrected_path,
    drive,
    fresh,
    measure,
    rooms,
)
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import least_squares

from roomba.configuration.sensors import GyroConfig
from roomba.perception.calibration.kernels import apply_lidar, drop_window, note_place, note_step
from roomba.perception.calibration.state import (
    AHEAD,
    DRIFT,
    GYRO,
    LEFT,
    TURN,
    TURNED,
    WAY,
)

Floats = NDArray[np.float64]

WORN = Worn(0.013, -0.008, 0.015, -0.012, (0.008, -0.006, math.radians(0.9)))
FINE = np.array([0.001, 0.001, 0.003, 0.001, 0.001, 0.001, 0.002])
"""Of each error, what is near enough."""


def _matrix(pose: Floats) -> Floats:
    x, y, theta = pose
    cosine, sine = math.cos(theta), math.sin(theta)
    return np.array([[cosine, -sine, x], [sine, cosine, y], [0.0, 0.0, 1.0]])


def _pose(matrix: Floats) -> Floats:
    return np.array([matrix[0, 2], matrix[1, 2], math.atan2(matrix[1, 0], matrix[0, 0])])


def batch(told: Told, at: list[int]) -> Floats:
    """Solve for radii, their distance, gyro and lidar at once, over all windows: slow and plain."""

    def off(unknown: Floats) -> Floats:
        left, right, base, gyro, *lidar = unknown.tolist()
        mount = _matrix(np.array(lidar))
        rows = []
        for begin, end in pairwise(at):
            ways = told.wheels[begin + 1 : end + 1] * (1.0 + left, 1.0 + right)
            moved = np.eye(3)
            for one, other in ways.tolist():
                turn = (other - one) / (BASE * (1.0 + base))
                chord = 0.5 * (one + other) * np.sinc(turn / (2.0 * np.pi))
                step = (chord * math.cos(0.5 * turn), chord * math.sin(0.5 * turn), turn)
                moved = moved @ _matrix(np.array(step))
            seen = _pose(np.linalg.inv(_matrix(told.lidar[begin])) @ _matrix(told.lidar[end]))
            expected = _pose(np.linalg.inv(mount) @ moved @ mount)
            turned = (1.0 + gyro) * told.gyro[begin + 1 : end + 1].sum()
            for one, other in ((seen[2], expected[2]), (seen[2], turned)):
                rows.append(5.0 * ((one - other + math.pi) % (2.0 * math.pi) - math.pi))
            rows += (seen[:2] - expected[:2]).tolist()
        return np.array(rows)

    found = least_squares(off, np.zeros(7)).x
    worn = Worn(*found[:3].tolist())
    return np.array([*worn.errors[:3], *found[3:]])


def test_they_are_those_that_solving_for_all_at_once_finds() -> None:
    random = np.random.default_rng(4)
    told, row = drive(WORN, rooms(random, 25), random), fresh()
    at = measure(row, told)
    assert int(row["windows"]) == len(at) - 1 > 40
    solved = batch(told, at)
    assert np.abs(solved - WORN.errors) == pytest.approx(0.0, abs=0.004)
    assert np.all(np.abs(row["errors"] - solved) < 3.0 * FINE)


@settings(max_examples=examples(25), deadline=None, derandomize=True)
@given(
    st.tuples(*[st.floats(-0.02, 0.02)] * 4),
    st.tuples(st.floats(-0.015, 0.015), st.floats(-0.015, 0.015), st.floats(-0.0175, 0.0175)),
    st.integers(0, 1000),
)
def test_any_errors_are_found(
    shares: tuple[float, float, float, float], lidar: tuple[float, float, float], seed: int
) -> None:
    random = np.random.default_rng(seed)
    worn, row = Worn(*shares, lidar=lidar), fresh()
    measure(row, drive(worn, rooms(random), random))
    off = np.abs(row["errors"] - worn.errors)
    assert np.all(off < 2.0 * FINE)
    assert np.all(off < 5.0 * np.sqrt(np.diag(row["covariance"])))


def test_what_a_straight_drive_does_not_tell_stays_as_it_was() -> None:
    random = np.random.default_rng(1)
    row = fresh()
    before = np.diag(row["covariance"]).copy()
    measure(row, drive(Worn(0.01, 0.01, 0.02, 0.01, (0.01, 0.01, 0.01)), _straight(60), random))
    told = np.sqrt(np.diag(row["covariance"]) / before)
    assert row["errors"][WAY] == pytest.approx(0.01, abs=0.003)
    assert row["errors"][TURNED] == pytest.approx(0.01, abs=0.003)
    for error in (TURN, GYRO, AHEAD, LEFT):
        assert told[error] > 0.97
        assert abs(row["errors"][error]) < 0.1 * math.sqrt(before[error])
    assert not row["applied"][[TURN, GYRO, AHEAD, LEFT]].any()


def test_turning_on_the_spot_tells_nothing_of_the_way() -> None:
    random = np.random.default_rng(1)
    # It stands between two turns, by which they are measured.
    row, turns = fresh(), np.zeros((20, 10))
    turns[:, 0], turns[:, 5] = 2.0, -2.0
    legs = np.column_stack((np.zeros(turns.size), turns.ravel()))
    measure(row, drive(Worn(0.02, 0.02, 0.0, 0.01), legs, random))
    assert abs(row["errors"][WAY]) < 0.001
    assert math.sqrt(row["covariance"][WAY, WAY]) > 0.019
    assert row["errors"][TURN] == pytest.approx(0.02, abs=0.002)
    assert row["errors"][GYRO] == pytest.approx(1.0 / 1.01 - 1.0, abs=0.002)


def test_the_bias_of_a_gyro_is_followed_while_the_robot_drives() -> None:
    """Without a change of its scale, by which turns would be off."""
    random = np.random.default_rng(7)
    told, row = drive(Worn(), rooms(random), random), fresh()
    bias = 2.0 * GyroConfig().bias
    measure(row, replace(told, gyro=told.gyro + bias * TICK))
    assert row["gyro_bias"] == pytest.approx(bias, abs=0.25 * bias)
    assert row["gyro_bias_variance"] < 0.2 * GyroConfig().bias ** 2
    assert abs(row["errors"][GYRO]) < 0.002


def test_a_scan_that_comes_late_while_it_turns_measures_no_scale() -> None:
    """A window that began or ended in a turn would be off by the delay, always the same way."""
    random = np.random.default_rng(8)
    told, row = drive(Worn(), rooms(random), random), fresh()
    measure(row, replace(told, lidar=np.roll(told.lidar, 1, axis=0)))
    assert row["errors"][TURN] == pytest.approx(0.0, abs=0.002)
    assert row["errors"][GYRO] == pytest.approx(0.0, abs=0.002)


def test_odometry_goes_by_what_is_sure() -> None:
    random = np.random.default_rng(2)
    row = fresh()
    measure(row, drive(WORN, rooms(random), random))
    legs = np.array([[4.0, 0.0], [0.0, 1.5], [3.0, 1.0], [-1.0, 0.0]])
    told = drive(WORN, legs, random, noise=0.0)
    plain = fresh()
    true = told.lidar[-1] - _beside(WORN, told)
    before, after = corrected_path(plain, told)[-1], corrected_path(row, told)[-1]
    assert math.dist(before[:2], true[:2]) > 0.3
    assert math.dist(after[:2], true[:2]) < 0.2 * math.dist(before[:2], true[:2])
    assert after[2] == pytest.approx(true[2], abs=0.02)


def test_a_healthy_robot_is_left_alone() -> None:
    for seed in range(5):
        random = np.random.default_rng(seed)
        row, worn = fresh(), Worn(*(0.001 * random.standard_normal(2)).tolist())
        measure(row, drive(worn, rooms(random), random))
        assert not row["applied"].any()
        assert not row["is_applied"]
        assert not row["is_lidar_due"]


@pytest.mark.parametrize("left", [-0.003, 0.003])
def test_a_lidar_that_sits_a_little_aside_is_corrected(left: float) -> None:
    """A robot that passes walls by 5 mm would touch them."""
    random, row = np.random.default_rng(3), fresh()
    measure(row, drive(Worn(lidar=(0.0, left, 0.0)), rooms(random), random))
    apply_lidar(row)
    assert row["applied"][LEFT] == pytest.approx(left, abs=0.001)


def test_slip_and_pushes_count_little() -> None:
    random = np.random.default_rng(5)
    told, row = drive(WORN, rooms(random), random), fresh()
    pushed = told.lidar.copy()
    for tick in random.integers(0, len(pushed), 20).tolist():
        pushed[tick:, :2] += random.uniform(-0.3, 0.3, 2)
    measure(row, Told(told.wheels, told.gyro, pushed))
    assert int(row["outliers"]) >= 15
    assert np.all(np.abs(row["errors"] - WORN.errors) < 4.0 * FINE)


def test_a_window_that_is_dropped_tells_nothing() -> None:
    row = fresh()
    note_place(row, (0.0, 0.0, 0.0), 1e-6, 1e-6)
    for _ in range(100):
        note_step(row, 0.02, 0.0, 0.0)
    drop_window(row)
    note_place(row, (9.0, 9.0, 0.0), 1e-6, 1e-6)
    assert int(row["windows"]) == 0
    for _ in range(100):
        note_step(row, 0.02, 0.0, 0.0)
    note_place(row, (11.0, 9.0, 0.0), 1e-6, 1e-6)
    assert int(row["windows"]) == 1
    assert row["errors"] == pytest.approx(np.zeros(7), abs=1e-9)


def test_a_lidar_that_is_gone_by_is_measured_the_same() -> None:
    random = np.random.default_rng(7)
    row = fresh()
    measure(row, drive(WORN, rooms(random), random))
    assert row["is_lidar_due"]
    apply_lidar(row)
    assert not row["is_lidar_due"]
    found = row["applied"][AHEAD:].copy()
    assert np.all(np.abs(found - WORN.errors[AHEAD:]) < 2.0 * FINE[AHEAD:])
    drop_window(row)
    measure(row, drive(WORN, rooms(random), random))
    assert np.all(np.abs(row["errors"] - WORN.errors) < FINE)
    apply_lidar(row)
    assert np.all(np.abs(row["applied"][AHEAD:] - found) < 2.0 * FINE[AHEAD:])


def test_what_was_measured_long_ago_counts_less() -> None:
    random = np.random.default_rng(8)
    row = fresh()
    measure(row, drive(WORN, rooms(random), random))
    other = Worn(-0.01, 0.01, 0.0, 0.01)
    for _ in range(6):
        drop_window(row)
        measure(row, drive(other, rooms(random), random))
    off = np.abs(row["errors"] - other.errors)
    assert np.all(off[[WAY, DRIFT, GYRO]] < 0.3 * np.abs(WORN.errors - other.errors)[[0, 2, 3]])


def test_a_robot_that_stood_for_long_begins_anew() -> None:
    row = fresh()
    note_place(row, (0.0, 0.0, 0.0), 1e-6, 1e-6)
    row["time"] = 61.0
    for _ in range(100):
        note_step(row, 0.02, 0.0, TICK * 0.0)
    note_place(row, (2.0, 0.0, 0.0), 1e-6, 1e-6)
    assert int(row["windows"]) == 0


def _straight(legs: int) -> Floats:
    return np.column_stack((np.ones(legs), np.zeros(legs)))


def _beside(worn: Worn, told: Told) -> Floats:
    """Return where the lidar is beside the robot at the end of a drive, in the drive's frame."""
    x, y, turned = worn.lidar
    body = told.lidar[-1, 2] - turned
    cosine, sine = math.cos(body), math.sin(body)
    return np.array([cosine * x - sine * y, sine * x + cosine * y, turned])
