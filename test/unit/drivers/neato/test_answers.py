"""What Neatos of several ages answer, and what a bad line makes of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.drivers.neato import answers
from roomba.drivers.neato.answers import AnswerError

XV11_TOUCHES = """Digital Sensor Name, Value
SNSR_DC_JACK_CONNECT,0
SNSR_DUSTBIN_IS_IN,1
SNSR_LEFT_WHEEL_EXTENDED,0
SNSR_RIGHT_WHEEL_EXTENDED,1
LSIDEBIT,0
LFRONTBIT,1
RSIDEBIT,0
RFRONTBIT,0""".splitlines()


def test_wheels_are_found_by_their_names_in_any_order() -> None:
    lines = ["Parameter,Value", "RightWheel_PositionInMM,-250", "LeftWheel_PositionInMM,1000"]
    found = answers.wheel_positions_of(lines)
    assert (found.left, found.right) == (1.0, -0.25)


def test_the_bumpers_of_an_older_robot() -> None:
    found = answers.touches_of(XV11_TOUCHES)
    assert (found.bumper_left, found.bumper_right) == (True, False)
    assert (found.dropped_left, found.dropped_right, found.has_bin) == (False, True, True)


@pytest.mark.parametrize(
    "lines",
    [
        ["SensorName,Unit,Value,", "DropSensorLeft,mm,19,", "DropSensorRight,mm,200,"],
        ["SensorName,Value", "LeftDropInMM,19", "RightDropInMM,200"],
    ],
)
def test_drop_sensors_with_and_without_a_unit(lines: list[str]) -> None:
    found = answers.drops_of(lines)
    assert (found.left, found.right) == (pytest.approx(0.019), pytest.approx(0.2))


def test_a_charge_that_none_has_is_refused() -> None:
    lines = ["FuelPercent,101", "ChargingActive,0", "ExtPwrPresent,0"]
    with pytest.raises(AnswerError, match="FuelPercent from 0 to 100, got 101"):
        answers.charge_of(lines)


def scan_lines() -> list[str]:
    """A scan with a range at each even degree, and errors at the others."""
    rows = [f"{angle},{1000 + angle},900,{0 if angle % 2 == 0 else '8035'}" for angle in range(360)]
    return ["AngleInDegrees,DistInMM,Intensity,ErrorCodeHEX", *rows, "ROTATION_SPEED,4.98"]


def test_a_scan_has_infinity_where_nothing_came_back() -> None:
    scan = answers.scan_of(scan_lines())
    assert scan.rotation == pytest.approx(4.98)
    assert scan.ranges[90] == pytest.approx(1.09)
    assert np.isinf(scan.ranges[1::2]).all()
    assert np.isfinite(scan.ranges[::2]).all()


def test_a_scan_that_was_cut_is_refused_and_one_without_some_lines_is_not() -> None:
    lines = scan_lines()
    with pytest.raises(AnswerError, match="expected a scan of 360 lines"):
        answers.scan_of(lines[:200])
    del lines[100:110]
    assert np.isinf(answers.scan_of(lines).ranges[99:109]).all()


@pytest.mark.parametrize("millimetres", ["9" * 400, "-1", "65536"])
def test_a_range_that_no_lidar_tells_is_none(millimetres: str) -> None:
    lines = scan_lines()
    lines[91] = f"90,{millimetres},900,0"
    scan = answers.scan_of(lines)
    assert np.isinf(scan.ranges[90])
    assert scan.ranges[88] == pytest.approx(1.088)


@given(st.lists(st.text(max_size=30), max_size=20))
def test_nonsense_is_refused_with_what_was_expected(lines: list[str]) -> None:
    for read in (
        answers.wheel_positions_of,
        answers.touches_of,
        answers.drops_of,
        answers.charge_of,
        answers.scan_of,
    ):
        with pytest.raises(AnswerError, match="expected"):
            read(lines)


@pytest.mark.parametrize("label", ["LSIDEBIT", "LFRONTBIT", "RSIDEBIT", "RFRONTBIT"])
def test_bumpers_of_which_one_is_not_told_are_refused(label: str) -> None:
    lines = [line for line in XV11_TOUCHES if not line.startswith(label)]
    with pytest.raises(AnswerError, match=f"expected {label}"):
        answers.touches_of(lines)
