"""A body whose driver has faults: they are reported, and the driver is started again."""

from __future__ import annotations

import logging
import time

import pytest
from fixtures.waiting import wait_until

from roomba.drivers.body_clock import BodyClock
from roomba.drivers.create2.obedience import DisobeyedError
from roomba.drivers.line import LineError
from roomba.drivers.line_body import LineBody
from roomba.drivers.neato.questions import UntoldError
from roomba.robot.command import Command
from roomba.robot.readings import Readings, ScanReading
from roomba.vocabulary import Hindrance


class FaultyDriver:
    """A driver with a fault: its methods on the line raise these, the first one first."""

    def __init__(self, served: list[Exception], begun: list[Exception]) -> None:
        self.served, self.begun = served, begun
        self.begins = self.serves = 0

    def read(self) -> Readings:
        raise NotImplementedError

    def newest_scan(self) -> ScanReading | None:
        return None

    def act(self, command: Command) -> None:
        """Do nothing."""

    def locate(self) -> None:
        """Do nothing."""

    def begin(self) -> None:
        self.begins += 1
        if self.begins > 1 and self.begun:
            raise self.begun.pop(0)

    def serve(self) -> None:
        self.serves += 1
        time.sleep(0.001)
        if self.served:
            raise self.served.pop(0)

    def end(self) -> None:
        """Do nothing."""


class UntouchedLine:
    """A line that is always there."""

    def reopen(self) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""


def body_by(driver: FaultyDriver) -> LineBody:
    return LineBody(driver, UntouchedLine(), BodyClock(time.monotonic), 0.01)


def test_a_fault_of_the_driver_is_told_and_the_robot_taken_over_anew() -> None:
    driver = FaultyDriver([OverflowError("too large")], [KeyError("LSIDEBIT")] * 2)
    body = body_by(driver)
    body.start(has_lidar=False)
    wait_until(
        lambda: "OverflowError: too large. Please report" in body.trouble.text, 5.0, "it is told"
    )
    wait_until(
        lambda: "KeyError: 'LSIDEBIT'. Please report" in body.trouble.text, 5.0, "the next one"
    )
    wait_until(lambda: driver.begins == 4 and not body.trouble, 5.0, "it goes on by itself")
    driver.served.append(ZeroDivisionError("division by zero"))
    wait_until(lambda: driver.begins == 5 and not body.trouble, 5.0, "and so it does again")
    body.stop()


def test_a_fault_is_in_the_log_once_with_its_place(caplog: pytest.LogCaptureFixture) -> None:
    driver = FaultyDriver([KeyError("LSIDEBIT"), KeyError("RSIDEBIT")], [])
    body = body_by(driver)
    with caplog.at_level(logging.ERROR):
        body.start(has_lidar=False)
        wait_until(lambda: driver.begins == 3 and not body.trouble, 5.0, "it met both")
    body.stop()
    (record,) = caplog.records
    assert record.exc_info
    assert "in serve" in caplog.text
    assert "KeyError: 'LSIDEBIT'" in caplog.text


def test_after_a_fault_it_waits_before_it_takes_over_again() -> None:
    driver = FaultyDriver([ValueError("no number")] * 1000, [])
    body = body_by(driver)
    began = time.monotonic()
    body.start(has_lidar=False)
    wait_until(lambda: driver.begins == 3, 5.0, "it tries again")
    assert time.monotonic() - began > 0.9
    assert driver.serves <= driver.begins
    body.stop()


def test_stopped_while_it_waits_it_takes_nothing_over(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roomba.drivers.line_body._RETRY_PERIOD", 60.0)
    driver = FaultyDriver([ValueError("no number")] * 1000, [])
    body = body_by(driver)
    body.start(has_lidar=False)
    wait_until(lambda: "ValueError" in body.trouble.text, 5.0, "it is told")
    began = time.monotonic()
    body.stop()
    assert time.monotonic() - began < 4.0
    assert driver.begins == 1


def test_a_line_that_is_only_garbled_is_whole_again_at_once() -> None:
    driver = FaultyDriver([LineError("half an answer")] * 5, [])
    body = body_by(driver)
    began = time.monotonic()
    body.start(has_lidar=False)
    wait_until(lambda: driver.begins == 6, 5.0, "it goes on")
    assert time.monotonic() - began < 2.0
    body.stop()


@pytest.mark.parametrize(
    ("error", "hindrance"),
    [
        (LineError("the line is gone"), Hindrance.UNREACHABLE),
        (UntoldError("expected GetLDSScan"), Hindrance.SENSOR_SILENT),
        (DisobeyedError("it drives on"), Hindrance.DISOBEYS),
    ],
)
def test_programs_are_told_what_is_wrong_by_a_word(error: LineError, hindrance: Hindrance) -> None:
    driver = FaultyDriver([error], [error] * 1000)
    body = body_by(driver)
    body.start(has_lidar=False)
    wait_until(lambda: bool(body.trouble), 5.0, "it is told")
    assert body.trouble.hindrance is hindrance
    assert str(error) in body.trouble.text
    body.stop()
