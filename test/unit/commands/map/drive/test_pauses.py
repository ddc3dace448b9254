"""Pauses of a recording, by what is usual in it."""

from __future__ import annotations

import pytest

from roomba.commands.map.drive.pauses import PauseSeeker


def pauses(odometry: list[float], scans: list[float]) -> list[float]:
    """Return when pauses began, s, of messages that came at these times."""
    seeker, began = PauseSeeker(), list[float]()
    for stamp, is_scan in sorted([(at, False) for at in odometry] + [(at, True) for at in scans]):
        if is_scan:
            seeker.see(stamp)
            continue
        since = seeker.hear(stamp)
        began += [] if since is None else [since]
    return began


def steady(first: float, last: float, step: float) -> list[float]:
    """Return times from the first to the last one."""
    return [first + step * number for number in range(round((last - first) / step) + 1)]


@pytest.mark.parametrize("first_scan", [189.9, 190.05], ids=["a scan first", "odometry first"])
def test_a_pause_is_where_neither_scans_nor_odometry_came(first_scan: float) -> None:
    odometry = steady(100.0, 130.0, 0.1) + steady(190.0, 200.0, 0.1)
    scans = steady(100.05, 130.05, 0.2) + steady(first_scan, 200.0, 0.2)
    assert pauses(odometry, scans) == pytest.approx([130.05])


def test_while_either_comes_there_is_none() -> None:
    broken = steady(100.0, 130.0, 0.1) + steady(190.0, 200.0, 0.1)
    whole = steady(100.05, 200.0, 0.2)
    assert pauses(broken, whole) == []
    assert pauses(whole, broken) == []


@pytest.mark.parametrize(("step", "pause"), [(0.1, 9.0), (10.0, 60.0)])
def test_what_is_short_or_usual_is_none(step: float, pause: float) -> None:
    begin = steady(0.0, 20.0 * step, step)
    stamps = begin + steady(begin[-1] + pause, begin[-1] + pause + 5.0 * step, step)
    assert pauses(stamps, stamps) == []
