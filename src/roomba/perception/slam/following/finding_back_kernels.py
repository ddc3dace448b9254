"""Compiled: whether scans fit as well as usual, and how fast the robot drives."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.compilation import entry, inner_part
from roomba.perception.localization.belief.belief import Row, Rows
from roomba.perception.matching.pose_kernels import is_apart

FINDING: Final = np.dtype(
    [
        ("usual", "f8"),  # share of points that scans usually agree in
        ("pace", "f8"),  # m/s; the fastest one of late
        ("stamp", "f8"),  # s; of the newest scan
        ("way", "f8"),  # m; driven by then
        ("well_since", "f8"),  # s; stamp of the newest scan that agreed as usual; nan: none
        ("well_at", "f8", (3,)),  # where dead reckoning had the robot then
        ("misses", "i8"),  # scans in a row that show enough and confirm nothing
        ("doubts", "i8"),  # scans in a row that agree less than usual
        ("lost_way", "f8"),  # m; driven from the last scan that fitted to the first that did not
        ("lost_turn", "f8"),  # rad; turned meanwhile
        # what does not change: see FollowingConfig
        ("doubtful", "f8"),
        ("pace_fades", "f8"),  # s
        ("far_apart", "f8"),  # m
    ],
    align=True,
)
"""How well scans fit of late, and the parameters of that, one row."""

_AT_ONCE: Final = 2
_EVERY: Final = 3
"""Of scans in a row that do not fit, the first few are searched for, and then every third one."""
_LEARNING: Final = 0.05
"""Share of the newest scan in the usual agreement."""
_STANDS: Final = 0.03
"""m and rad; less than this is no motion of the wheels."""


@inner_part
def saw(findings: Rows, followers: Rows, stamp: float) -> None:
    """Note how well the newest scan fits, and its ``stamp``, s."""
    finding, follower = findings[0], followers[0]
    _count(findings, follower, stamp)
    elapsed = stamp - finding.stamp
    if elapsed > 0.0 and follower.is_sure:
        pace = (follower.way - finding.way) / elapsed
        finding.pace = max(math.exp(-elapsed / finding.pace_fades) * finding.pace, pace)
    finding.stamp, finding.way = stamp, follower.way


@entry
def is_due(findings: Rows) -> bool:
    """Whether to search for where the newest scan fits."""
    finding = findings[0]
    count: int = finding.misses if finding.misses > 0 else finding.doubts
    return 0 < count <= _AT_ONCE or (count > 0 and count % _EVERY == 0)


@entry
def least_usual(findings: Rows) -> float:
    """Return the least share of points that agree in a scan that agrees as usual."""
    finding = findings[0]
    share: float = finding.doubtful * finding.usual
    return share


@inner_part
def _count(findings: Rows, follower: Row, stamp: float) -> None:
    """Count the scans in a row that confirm nothing, or agree less than usual."""
    finding = findings[0]
    if not follower.is_sure:
        if follower.points >= follower.least_points:
            # The first scan of a map or a piece cannot fit yet.
            if finding.misses == 0 or math.isnan(finding.well_since):
                finding.lost_way, finding.lost_turn = follower.unsure_way, follower.unsure_turn
            finding.misses += 1
        return
    finding.misses = 0
    agreement = follower.met * follower.close
    stands = not is_apart(follower.reckoned, finding.well_at, _STANDS, _STANDS)
    # A driving robot sees new things, which raises no doubt; but scans far apart may fit wrongly.
    is_doubted = stands or follower.way - finding.way >= finding.far_apart
    if agreement < least_usual(findings) and is_doubted:
        if finding.doubts == 0:
            finding.lost_way, finding.lost_turn = follower.way - finding.way, 0.0
        finding.doubts += 1
        return
    finding.doubts = 0
    finding.usual += _LEARNING * (agreement - finding.usual)
    finding.well_since = stamp
    for axis in range(3):
        finding.well_at[axis] = follower.reckoned[axis]
