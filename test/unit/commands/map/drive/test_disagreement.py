"""When the map and odometry give different lengths of the way."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.arrays import Floats
from roomba.commands.map.drive.disagreement import (
    Disagreement,
    disagreements,
    told_disagreements,
)

SPEED = 0.5
"""m/s."""
STAMPS = np.arange(0.0, 60.0, 0.1) + 1000.0


def drive(*stands: tuple[float, float], scale: float = 1.0, turned: float = 0.0) -> Floats:
    """Return rows of a drive straight on that ``stands`` from one time to another, s."""
    passed = STAMPS - STAMPS[0]
    speeds = np.full(len(passed), scale * SPEED)
    for begin, end in stands:
        speeds[(passed >= begin) & (passed < end)] = 0.0
    way = np.cumsum(speeds) * 0.1
    heading = np.full(len(way), turned)
    return np.column_stack((STAMPS, way * np.cos(turned), way * np.sin(turned), heading))


def test_a_map_that_stands_while_odometry_drives_is_found() -> None:
    (found,) = disagreements(drive((10.0, 18.0)), drive())
    assert found.begin == pytest.approx(10.0, abs=2.0)
    assert found.end == pytest.approx(18.0, abs=2.0)
    assert found.by_odometry - found.by_map == pytest.approx(8.0 * SPEED, abs=0.1)


def test_odometry_that_stands_while_the_map_drives_is_found() -> None:
    (found,) = disagreements(drive(), drive((30.0, 34.0)))
    assert found.by_map - found.by_odometry == pytest.approx(4.0 * SPEED, abs=0.1)


def test_of_odometry_that_drives_in_circles_the_way_counts_and_not_where_it_ends() -> None:
    angles = np.cumsum(np.full(len(STAMPS), 0.05))
    circles = np.column_stack((STAMPS, np.cos(angles), np.sin(angles), angles))
    standing = np.column_stack((STAMPS, np.zeros((len(STAMPS), 3))))
    (found,) = disagreements(standing, circles)
    assert found.by_map == 0.0
    # Chords of three seconds, which are turns by 1.5 rad.
    assert found.by_odometry == pytest.approx(20 * 2.0 * np.sin(0.75), rel=0.1)


def test_odometry_of_another_frame_that_is_a_tenth_off_agrees() -> None:
    assert disagreements(drive(), drive(scale=0.9, turned=1.0)) == []


def test_a_slip_of_a_moment_is_no_disagreement() -> None:
    assert disagreements(drive(), drive((10.0, 10.8))) == []


def test_only_scans_that_both_have_count_and_times_begin_with_odometry() -> None:
    later, earlier = drive()[100:], drive()[:-100]
    assert disagreements(later, earlier) == []
    assert disagreements(later[:1], earlier) == []
    assert disagreements(later, later[:0]) == []
    (found,) = disagreements(later, drive((20.0, 28.0)))
    assert found.begin == pytest.approx(20.0, abs=2.0)


def test_it_is_told_from_when_to_when_and_how_far() -> None:
    assert told_disagreements([]) == []
    (told,) = told_disagreements([Disagreement(14.2, 22.4, 1.7, 3.9)])
    assert "14 to 22 s (1.7 m on the map, 3.9 m by odometry)" in told
    assert "more" not in told


def test_of_many_the_largest_are_told_in_the_order_of_time() -> None:
    many = [Disagreement(float(at), at + 4.0, 0.1 * at, 0.0) for at in (10, 20, 50, 30, 40)]
    (told,) = told_disagreements(many)
    assert told.index("30 to 34 s") < told.index("40 to 44 s") < told.index("50 to 54 s")
    assert "20 to 24 s" not in told
    assert "and 2 times more" in told
