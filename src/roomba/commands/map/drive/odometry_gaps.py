"""Gaps in a drive's odometry: it is missing, or stands still while scans show motion."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

from roomba.geometry import Pose
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import LidarScan, Odometry, Reading

_MISSING: Final = 1.0
_LATER: Final = 3.0
"""Odometry is missing after this time, s, and after this many times its usual spacing."""
_KNOWN: Final = 3
"""Spacings of odometry messages from which the usual one is known."""
_UNSEEN: Final = 1.5
"""s; with scans farther apart than this, scans cannot show the robot's motion either."""
_LATE: Final = 0.5
"""s by which stamps of scans may be late: such scans are from before odometry stood still."""
_CHANGED: Final = 0.15
"""m; a beam whose range changes by more sees something else."""
_SHARE: Final = 0.5
"""Share of beams that see something else once the robot has moved; people cover fewer."""


class OdometryGap(NamedTuple):
    """A gap: from the last useful odometry, ``begin``, s, to the last useless or missing one."""

    begin: float
    end: float


ALWAYS: Final = OdometryGap(-math.inf, math.inf)
"""That of a drive without odometry."""


class GapsInOrder:
    """The gaps of a drive, looked up in the order of time."""

    def __init__(self, gaps: Iterable[OdometryGap]) -> None:
        """Begin before the first one."""
        self._gaps = list(gaps)

    def has(self, stamp: float) -> bool:
        """Whether a time, s, is in a gap."""
        while self._gaps and stamp > self._gaps[0].end:
            self._gaps.pop(0)
        return bool(self._gaps) and stamp > self._gaps[0].begin

    @property
    def begin(self) -> float:
        """The begin, s, of the gap that the last time asked for is in."""
        return self._gaps[0].begin


def gaps_of(drive: LoggedDrive) -> Sequence[OdometryGap]:
    """Return the gaps in a drive's odometry, and add a remark about them to the drive."""
    if not drive.chosen.has_odometry:
        return (ALWAYS,)
    gaps = odometry_gaps(drive.readings())
    if gaps:
        drive.remark(told_gaps(gaps))
    return gaps


def odometry_gaps(readings: Iterable[Reading]) -> list[OdometryGap]:
    """Return the gaps of a drive that has odometry, in the order of time."""
    seeker = _GapSeeker()
    for stamp, value, _ in readings:
        if isinstance(value, Odometry):
            seeker.hear(stamp, value.pose)
        elif isinstance(value, LidarScan):
            seeker.see(stamp, value)
    return seeker.finished()


def told_gaps(gaps: Sequence[OdometryGap]) -> str:
    """Return in words what is done in some gaps."""
    between = sum(gap.end - gap.begin for gap in gaps if math.isfinite(gap.end - gap.begin))
    told = [f"it stands still or is missing for {between:.0f} s while scans move"] * (between > 0.0)
    told += ["it begins later than the scans do"] * any(gap.begin == -math.inf for gap in gaps)
    told += ["it ends before the scans do"] * any(gap.end == math.inf for gap in gaps)
    return f"odometry is not used where {' and '.join(told)}: there scans alone were followed"


class _GapSeeker:
    """Finds gaps; ``_since`` is when odometry last changed, ``_newest`` when it last came.

    ``_unseen``, s, is the longest time without a scan since ``_newest``.
    """

    def __init__(self) -> None:
        self._gaps: list[OdometryGap] = []
        self._steps: list[float] = []
        self._pose: Pose | None = None
        self._since = self._newest = self._scanned = -math.inf
        self._first_scan = math.inf
        self._unseen = 0.0
        self._seen: LidarScan | None = None
        self._has_moved = False

    def hear(self, stamp: float, pose: Pose) -> None:
        """Take a message of odometry."""
        since = self._first_scan if self._pose is None else self._newest
        # Checked second: the usual spacing takes a while to compute, and is seldom needed.
        is_missing = stamp - since > _MISSING and stamp - since > self._longest()
        if is_missing and max(self._unseen, stamp - self._scanned) <= _UNSEEN:
            self._end_standstill()
            self._gaps.append(OdometryGap(self._newest, np.nextafter(stamp, -math.inf)))
            self._since = stamp
        if self._pose is not None:
            self._steps.append(stamp - self._newest)
        if pose != self._pose:
            self._end_standstill()
            self._pose, self._since = pose, stamp
        self._newest, self._unseen = stamp, 0.0

    def see(self, stamp: float, scan: LidarScan) -> None:
        """Take a scan."""
        self._first_scan = min(self._first_scan, stamp)
        self._unseen = max(self._unseen, stamp - max(self._scanned, self._newest, self._first_scan))
        self._scanned = stamp
        if stamp <= self._since + _LATE or self._newest <= self._since:
            return
        if self._seen is None or not _is_comparable(self._seen, scan):
            self._seen = scan
        elif not self._has_moved:
            self._has_moved = _is_another(self._seen, scan)

    def finished(self) -> list[OdometryGap]:
        """Return all gaps, the drive being over."""
        self._end_standstill()
        if self._pose is not None and self._scanned - self._newest > self._longest():
            self._gaps.append(OdometryGap(self._newest, math.inf))
        return self._gaps

    def _longest(self) -> float:
        """Return the time without odometry after which it is missing, s, by what came so far."""
        if self._pose is None:
            return _MISSING
        if len(self._steps) < _KNOWN:
            return math.inf
        return max(_MISSING, _LATER * float(np.median(self._steps)))

    def _end_standstill(self) -> None:
        if self._has_moved:
            self._gaps.append(OdometryGap(self._since, self._newest))
        self._seen, self._has_moved = None, False


def _is_comparable(before: LidarScan, scan: LidarScan) -> bool:
    """Whether most beams of both scans hit something: a lidar that spins up measures nothing."""
    if before.ranges.shape != scan.ranges.shape:
        return False
    met = [np.isfinite(each.ranges) for each in (before, scan)]
    both = int(np.count_nonzero(met[0] & met[1]))
    return both > _SHARE * max(int(np.count_nonzero(each)) for each in met)


def _is_another(before: LidarScan, scan: LidarScan) -> bool:
    """Whether most of the beams that hit something in both scans see something else now."""
    both = np.isfinite(before.ranges) & np.isfinite(scan.ranges)
    changed = np.abs(scan.ranges[both] - before.ranges[both]) > _CHANGED
    return bool(np.count_nonzero(changed) > _SHARE * len(changed))
