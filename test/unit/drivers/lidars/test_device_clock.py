"""A device's clock, estimated from how long its messages take."""

from __future__ import annotations

import numpy as np

from roomba.drivers.lidars.device_clock import DeviceClock


def test_what_waits_on_the_way_is_told_at_its_time_over_laps() -> None:
    random, clock = np.random.default_rng(8), DeviceClock(30_000)
    off = []
    arrived = 0.0
    for step in range(40_000):
        true = 100.0 + 0.003 * step
        arrived = max(arrived, true + random.exponential(0.01))
        told = round(1e3 * 0.003 * step) % 30_000
        off.append(clock.host_time(told, arrived) - true)
    assert np.abs(off[100:]).max() < 0.004


def test_one_that_goes_slower_or_faster_is_followed() -> None:
    for rate in (0.9999, 1.0001):
        clock = DeviceClock(30_000)
        off = [
            clock.host_time(round(1e3 * rate * now) % 30_000, now) - now
            for now in np.arange(0.0, 600.0, 0.05)
        ]
        assert np.abs(off).max() < 0.005


def test_one_that_begins_anew_is_taken_at_its_word_again() -> None:
    clock = DeviceClock(30_000)
    clock.host_time(5_000, 10.0)
    clock.host_time(6_000, 11.0)
    assert clock.host_time(3, 20.0) == 20.0
    assert abs(clock.host_time(103, 20.1) - 20.1) < 0.001
