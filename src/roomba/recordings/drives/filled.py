"""Odometry that is rarer than scans, filled in: where the robot was at each scan in between."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from roomba.geometry import Pose, wrap_angle
from roomba.recordings.readings import LidarScan, Odometry, Reading

_FEWEST: Final = 2
"""Scans between two poses of odometry, from which on it is filled in."""
_LONGEST: Final = 2.0
"""s; over a longer time a robot may have done anything."""


def filled(readings: Iterable[Reading]) -> Iterator[Reading]:
    """Yield readings, in the order of time, and odometry at scans where it is rarer than these.

    Between two poses the robot is taken to go on evenly. Where odometry is as frequent as scans
    nothing is added.
    """
    before: Reading | None = None
    held: list[Reading] = []
    for reading in readings:
        is_odometry = isinstance(reading.value, Odometry)
        if before is not None and is_odometry:
            yield from _with_odometry(before, held, reading)
            held = []
        elif before is not None and reading.stamp <= before.stamp + _LONGEST:
            held.append(reading)
            continue
        yield from held
        held = []
        yield reading
        before = reading if is_odometry else before
    yield from held


def _with_odometry(before: Reading, held: list[Reading], after: Reading) -> Iterator[Reading]:
    """Yield what was held back between two readings of odometry, and odometry at its scans."""
    scans = sum(isinstance(each.value, LidarScan) for each in held)
    spent = after.stamp - before.stamp
    is_rare = scans >= _FEWEST and spent <= _LONGEST
    for each in held:
        if is_rare and isinstance(each.value, LidarScan) and each.stamp > before.stamp:
            share = (each.stamp - before.stamp) / spent
            pose = _between(_pose_of(before), _pose_of(after), share)
            yield each._replace(value=Odometry(pose))
        yield each


def _pose_of(reading: Reading) -> Pose:
    assert isinstance(reading.value, Odometry)
    return reading.value.pose


def _between(one: Pose, other: Pose, share: float) -> Pose:
    """Return the pose at a share, 0..1, of the way from one to the other."""
    turned = wrap_angle(other.theta - one.theta)
    return Pose(
        one.x + share * (other.x - one.x),
        one.y + share * (other.y - one.y),
        wrap_angle(one.theta + share * turned),
    )
