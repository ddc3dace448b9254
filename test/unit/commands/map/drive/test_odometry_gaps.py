"""When odometry tells nothing: missing, ended, or still while scans move; and what is no gap."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.commands.map.drive.odometry_gaps import ALWAYS, odometry_gaps, told_gaps
from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.readings import LidarScan, Odometry, Reading

LIDAR = LidarModel.all_around(36, 0.1, 10.0)
RANGES = 2.0 + 0.3 * np.sin(np.arange(36))


def scan(ranges: NDArray[np.float64]) -> LidarScan:
    return LidarScan(ranges.astype(np.float32), LIDAR)


def drive(
    *, odometry_until: float = 60.0, still: tuple[float, float] = (99.0, 99.0), seen: bool = True
) -> Iterator[Reading]:
    """A minute, with odometry 10 and scans 5 times a second; the robot drives all the time.

    Odometry stands still for a while; ``seen``: scans show that it drives then.
    """
    pose = Pose()
    for tick in range(600):
        now = 0.1 * tick
        is_still = still[0] <= now < still[1]
        if not is_still:
            pose = Pose(0.03 * tick)
        if now <= odometry_until:
            yield Reading(now, Odometry(pose), 0)
        if tick % 2 == 0:
            moved = 0.03 * tick if seen or not is_still else 0.0
            yield Reading(now, scan(RANGES + 0.2 * math.sin(3.0 * moved) + moved % 2.0), 0)


def test_odometry_that_moves_has_no_gap() -> None:
    assert odometry_gaps(drive()) == []
    assert odometry_gaps([]) == []


def test_odometry_that_stands_still_while_scans_move_is_a_gap() -> None:
    (gap,) = odometry_gaps(drive(still=(20.0, 35.0)))
    assert gap.begin == pytest.approx(19.9)
    assert gap.end == pytest.approx(34.9)
    assert "it stands still or is missing for 15 s while scans move" in told_gaps([gap])


def test_a_robot_that_stands_has_no_gap() -> None:
    assert odometry_gaps(drive(still=(20.0, 35.0), seen=False)) == []


def test_people_beside_a_robot_that_stands_are_no_gap() -> None:
    readings: list[Reading] = []
    for tick in range(100):
        readings.append(Reading(0.1 * tick, Odometry(Pose()), 0))
        ranges = RANGES.copy()
        ranges[tick % 36 : tick % 36 + 8] = 0.6
        readings.append(Reading(0.1 * tick, scan(ranges), 0))
    assert odometry_gaps(readings) == []


def test_odometry_that_ends_is_a_gap_without_end() -> None:
    (gap,) = odometry_gaps(drive(odometry_until=30.0))
    assert gap.begin == pytest.approx(30.0)
    assert gap.end == math.inf
    assert told_gaps([gap]) == (
        "odometry is not used where it ends before the scans do: there scans alone were followed"
    )


def test_odometry_that_is_missing_for_a_while_is_a_gap_that_ends_before_it_comes_again() -> None:
    missing = [
        reading
        for reading in drive()
        if not (isinstance(reading.value, Odometry) and 20.0 < reading.stamp < 25.0)
    ]
    (gap,) = odometry_gaps(missing)
    assert gap.begin == pytest.approx(20.0)
    assert 24.9 < gap.end < 25.0


@pytest.mark.parametrize("scans_from", [25.0, 24.0])
def test_a_recording_that_was_paused_has_no_gap(scans_from: float) -> None:
    """Wheels go on counting meanwhile; the first scans may come before the first odometry."""
    paused = [
        each
        for each in drive()
        if not 20.0 < each.stamp < (25.0 if isinstance(each.value, Odometry) else scans_from)
    ]
    assert odometry_gaps(paused) == []


def test_without_odometry_the_gap_is_all_of_the_drive() -> None:
    assert ALWAYS.begin == -math.inf
    assert ALWAYS.end == math.inf


def test_odometry_that_begins_late_is_missing_before() -> None:
    late = [e for e in drive() if not (isinstance(e.value, Odometry) and e.stamp < 20.0)]
    (gap,) = odometry_gaps(late)
    assert gap.begin == -math.inf
    assert 19.9 < gap.end < 20.0
    assert "it begins later than the scans do: there" in told_gaps([gap])
    soon = [e for e in drive() if not (isinstance(e.value, Odometry) and e.stamp < 0.5)]
    assert odometry_gaps(soon) == []


def test_a_lidar_that_spins_up_while_the_robot_stands_is_no_gap() -> None:
    readings: list[Reading] = []
    for tick in range(100):
        readings.append(Reading(0.1 * tick, Odometry(Pose()), 0))
        ranges = RANGES if tick > 30 else np.full(36, math.inf)
        readings.append(Reading(0.1 * tick, scan(ranges), 0))
    assert odometry_gaps(readings) == []


def test_a_time_that_is_missing_counts_once() -> None:
    """Odometry stands for 10 s, is missing for 5, and stands again; the robot drives on."""
    readings = [
        each
        for each in drive(still=(10.0, 30.0))
        if not (isinstance(each.value, Odometry) and 20.0 < each.stamp < 25.0)
    ]
    gaps = odometry_gaps(readings)
    assert sum(gap.end - gap.begin for gap in gaps) == pytest.approx(20.0, abs=0.3)
    assert all(one.end <= other.begin for one, other in pairwise(gaps))


@pytest.mark.parametrize("period", [1.0, 1.3])
def test_odometry_that_is_rare_is_not_missing(period: float) -> None:
    """It comes so seldom as a rule; three times as long it is missing."""
    rare, last = [], -math.inf
    for each in drive():
        if not isinstance(each.value, Odometry):
            rare.append(each)
        elif each.stamp >= last + period - 1e-9:
            rare.append(each)
            last = each.stamp
    assert odometry_gaps(rare) == []
    missing = [e for e in rare if not (isinstance(e.value, Odometry) and 20.0 < e.stamp < 27.0)]
    assert len(odometry_gaps(missing)) == 1


def test_odometry_that_is_rare_and_stands_still_is_a_gap() -> None:
    rare = [e for e in drive(still=(20.0, 45.0)) if not isinstance(e.value, Odometry)]
    rare += [
        e
        for e in drive(still=(20.0, 45.0))
        if isinstance(e.value, Odometry) and round(10.0 * e.stamp) % 12 == 0
    ]
    (gap,) = odometry_gaps(sorted(rare, key=lambda reading: reading.stamp))
    assert gap.begin == pytest.approx(19.2, abs=1.3)
    assert gap.end == pytest.approx(45.0, abs=1.3)
