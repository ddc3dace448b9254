"""A calibration is expressed in numbers of the wheels, and is carried on in another belief."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.worn import BASE, Worn, drive, measure, rooms

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.sensors import GyroConfig
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.calibration.state import (
    AHEAD,
    GYRO,
    OF_WHEELS,
    TURNED,
    begin_calibration,
    forget_wheels,
)
from roomba.perception.localization.belief.belief import Rows, unknown_belief

WORN = Worn(0.013, -0.008, 0.015, -0.012, (0.008, -0.006, math.radians(0.9)))


def belief(base: float = BASE) -> Rows:
    rows = unknown_belief()
    begin_calibration(rows[0]["calibration"], LocalizationConfig(), GyroConfig())
    rows[0]["calibration"]["base"] = base
    return rows


def measured(base: float = BASE) -> Rows:
    rows, random = belief(base), np.random.default_rng(3)
    measure(rows[0]["calibration"], drive(WORN, rooms(random), random))
    return rows


def test_wheels_are_told_with_their_deviations() -> None:
    told = {name: (value, unsure) for name, value, unsure, _ in Calibration.of(measured()).told()}
    assert told["left wheel"][0] == pytest.approx(1.3, abs=0.1)
    assert told["right wheel"][0] == pytest.approx(-0.8, abs=0.1)
    assert told["wheel distance"][0] == pytest.approx(1.5, abs=0.2)
    assert told["gyro"][0] == pytest.approx(1.2, abs=0.1)
    assert told["lidar ahead"][0] == pytest.approx(8.0, abs=1.0)
    assert told["lidar turned"][0] == pytest.approx(0.9, abs=0.1)
    for name, true in (("left wheel", 1.3), ("right wheel", -0.8), ("wheel distance", 1.5)):
        value, unsure = told[name]
        assert 0.005 < unsure < 0.5
        assert abs(value - true) < 4.0 * unsure


def test_deviations_of_wheels_are_those_of_samples() -> None:
    known = Calibration.of(measured())
    random = np.random.default_rng(0)
    samples = random.multivariate_normal(known.errors, known.covariance, 4000)
    told = [
        [value for _, value, _, _ in replace(known, errors=each).told()[:3]] for each in samples
    ]
    expected = np.std(told, axis=0)
    assert [row[2] for row in known.told()[:3]] == pytest.approx(expected, rel=0.06)


def test_without_wheels_it_tells_what_odometry_does() -> None:
    known = Calibration.of(measured(base=0.0))
    names = [name for name, *_ in known.told()]
    assert names[:3] == ["distance", "rotation", "drift"]
    assert known.told()[2][1] == pytest.approx(math.degrees(WORN.errors[2]), abs=0.3)


def test_its_line_tells_what_is_sure_alone() -> None:
    assert str(Calibration.of(belief())) == "nothing was measured yet"
    line = str(Calibration.of(measured()))
    assert "left wheel +1." in line
    assert "right wheel -0." in line
    healthy, random = belief(), np.random.default_rng(3)
    measure(healthy[0]["calibration"], drive(Worn(left=0.02), rooms(random), random))
    known = Calibration.of(healthy)
    name, value, unsure, _ = known.told()[0]
    assert (name, value) == ("left wheel", pytest.approx(2.0, abs=unsure))
    assert str(known) == f"left wheel {value:+.2f} ± {unsure:.2f} %"


def test_another_belief_goes_on_with_it() -> None:
    known, other = Calibration.of(measured()), belief()
    other[0]["calibration"]["is_open"] = True
    known.take_up(other)
    assert not other[0]["calibration"]["is_open"]
    again = Calibration.of(other)
    assert np.array_equal(again.errors, known.errors)
    assert np.array_equal(again.covariance, known.covariance)
    assert np.array_equal(again.applied, known.applied)
    assert again.windows == known.windows > 100
    assert known.applied[: GYRO + 1].any()
    assert other[0]["calibration"]["is_applied"]


@pytest.mark.parametrize(
    "change",
    [
        {"errors": np.full(7, math.nan)},
        {"errors": np.full(7, 0.7)},
        {"applied": np.full(6, 0.0)},
        {"covariance": -np.eye(7)},
        {"covariance": np.triu(np.ones((7, 7)))},
        {"windows": -1},
    ],
)
def test_what_is_no_robots_is_seen(change: dict[str, object]) -> None:
    known = Calibration.of(measured())
    assert known.is_sensible
    assert not replace(known, **change).is_sensible  # type: ignore[arg-type]


def test_errors_end_with_the_lidars_turn() -> None:
    assert len(Calibration.of(belief()).errors) == TURNED + 1


def test_of_other_wheels_nothing_is_known_but_lidar_and_gyro_are_as_they_were() -> None:
    row = measured()[0]["calibration"]
    before = row.copy()
    forget_wheels(row, LocalizationConfig(way_noise=0.2))
    assert not row["errors"][:OF_WHEELS].any()
    assert not row["applied"][:OF_WHEELS].any()
    prior = np.diag(row["prior"][:OF_WHEELS])
    assert np.array_equal(row["covariance"][:OF_WHEELS, :OF_WHEELS], prior)
    assert row["way_variance"] == pytest.approx(0.04)
    for error in (GYRO, AHEAD, TURNED):
        assert row["errors"][error] == before["errors"][error] != 0.0
        assert row["applied"][error] == before["applied"][error]
