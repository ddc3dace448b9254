"""The clock of a body stands while the robot cannot be reached."""

from __future__ import annotations

from roomba.drivers.body_clock import BodyClock


def test_it_stands_and_goes_on_from_where_it_stood() -> None:
    wall = [100.0]
    clock = BodyClock(lambda: wall[0])
    wall[0] = 101.0
    assert clock() == 1.0
    clock.stand()
    wall[0] = 161.0
    clock.stand()
    assert clock() == 1.0
    clock.go_on()
    clock.go_on()
    wall[0] = 161.5
    assert clock() == 1.5
