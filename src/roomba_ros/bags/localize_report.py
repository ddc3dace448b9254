"""The report of a localized drive: figures, for people and for programs."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import asdict, dataclass, field
from typing import Any, Final

import numpy as np

from roomba.geometry import Pose
from roomba.perception.localization.estimate import Knowledge
from roomba_ros.bags.localize_recording import Heard
from roomba_ros.bags.localize_replay import Row
from roomba_ros.convert.common import pose_of
from roomba_ros.convert.errors import MessageError

_MOST_ROWS: Final = 40_000
"""Rows that are kept of a drive, however long it is."""
_MOST_LOSSES: Final = 200
_SHOWN_LOSSES: Final = 8
_NEAR: Final = 0.5
"""s; poses of the robot itself are compared between two rows that are not further apart."""


class Thinned:
    """Rows evenly spread over a drive: when there are too many, every other one goes."""

    def __init__(self, most: int = _MOST_ROWS) -> None:
        """Keep so many at most."""
        self.rows: list[Any] = []
        self._most, self._stride, self._count = most, 1, 0

    def append(self, row: Any) -> None:
        """Take one, or leave it out."""
        if self._count % self._stride == 0:
            self.rows.append(row)
            if len(self.rows) > self._most:
                self.rows = self.rows[::2]
                self._stride *= 2
        self._count += 1


@dataclass(slots=True)
class Loss:
    """The place was not known any more: when (s since the start, and stamp), where, m, and why.

    ``seconds`` says for how long; None: to the end.
    """

    elapsed: float
    stamp: float
    x: float
    y: float
    reason: str
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Difference:
    """How far the robot's own poses on a topic are from those found here, m."""

    topic: str
    count: int
    median: float
    percentile_99: float


@dataclass(slots=True)
class LocalizationSummary:
    """The figures of a drive; times in s, deviations in m and rad, shares 0..1 of the time.

    ``found_after`` is when the place was first known well enough to drive by, None if never.
    """

    bag: str
    map: str
    start: str
    seconds: float
    scans: int
    processing_seconds: float
    scans_per_second: float
    times_real_time: float
    way: float
    shares: dict[str, float]
    position_deviation: float | None
    heading_deviation: float | None
    agreement: float | None
    found_after: float | None
    found_at: tuple[float, float, float] | None
    losses: list[Loss]
    loss_count: int
    differences: list[Difference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def as_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        return asdict(self)


class Tally:
    """Counts while a drive is gone through; ``rows`` are some of it, evenly spread."""

    def __init__(self, own_poses: str | None) -> None:
        """Compare with the robot's own poses on a topic, if there is one."""
        self.rows = Thinned()
        self.losses: list[Loss] = []
        self.loss_count = 0
        self.last: Row | None = None
        self.found: Row | None = None
        self._seconds = dict.fromkeys(Knowledge, 0.0)
        self._topic = own_poses
        self._own: deque[tuple[float, float, float]] = deque()
        self._differences = Thinned()
        self._compared = 0

    def take(self, row: Row) -> None:
        """Count a state."""
        before, self.last = self.last, row
        self.rows.append(row)
        is_usable = row.estimate.knowledge.is_usable
        if before is not None:
            self._seconds[before.estimate.knowledge] += row.elapsed - before.elapsed
            self._compare(before, row)
        if self.found is None:
            self.found = row if is_usable else None
        elif before is not None and before.estimate.knowledge.is_usable is not is_usable:
            if is_usable:
                self._end_loss(row)
            else:
                self._begin_loss(before, row)

    def hear_own_pose(self, heard: Heard) -> None:
        """Take where the robot itself believed to be, to be compared with the next rows."""
        place = _own_pose(heard)
        if place is not None and all(map(math.isfinite, (place.x, place.y))):
            self._own.append((heard.stamp, place.x, place.y))

    def summary(
        self, bag: str, map_: str, start: str, scans: int, processing: float
    ) -> LocalizationSummary:
        """Return the figures; ``processing`` s is what it took."""
        seconds = self.last.elapsed if self.last is not None else 0.0
        counted = sum(self._seconds.values())
        known = [row.estimate for row in self.rows.rows if row.estimate.knowledge.is_usable]
        found = self.found
        return LocalizationSummary(
            bag=bag,
            map=map_,
            start=start,
            seconds=seconds,
            scans=scans,
            processing_seconds=processing,
            scans_per_second=scans / max(processing, 1e-9),
            times_real_time=seconds / max(processing, 1e-9),
            way=self.last.way if self.last is not None else 0.0,
            shares={
                knowledge.value: spent / counted if counted > 0.0 else 0.0
                for knowledge, spent in self._seconds.items()
            },
            position_deviation=_median([each.position_deviation for each in known]),
            heading_deviation=_median([each.heading_deviation for each in known]),
            agreement=_median([each.agreement for each in known]),
            found_after=found.elapsed if found is not None else None,
            found_at=_numbers(found.estimate.pose) if found is not None else None,
            losses=self.losses,
            loss_count=self.loss_count,
            differences=self._difference(),
        )

    def _begin_loss(self, before: Row, row: Row) -> None:
        self.loss_count += 1
        if len(self.losses) < _MOST_LOSSES:
            pose = before.estimate.pose
            # What helps a robot on the spot, after the semicolon, comes too late here.
            reason = row.estimate.reason.partition(";")[0]
            self.losses.append(Loss(row.elapsed, row.stamp, pose.x, pose.y, reason))

    def _end_loss(self, row: Row) -> None:
        if self.losses and self.losses[-1].seconds is None:
            self.losses[-1].seconds = row.elapsed - self.losses[-1].elapsed

    def _compare(self, before: Row, row: Row) -> None:
        """Compare the robot's own poses between two rows with what lies between these."""
        if row.stamp <= before.stamp:
            self._own.clear()
            return
        is_known = before.estimate.knowledge.is_usable and row.estimate.knowledge.is_usable
        is_near = row.stamp - before.stamp <= _NEAR
        while self._own and self._own[0][0] <= row.stamp:
            stamp, x, y = self._own.popleft()
            if stamp < before.stamp or not is_known or not is_near:
                continue
            share = (stamp - before.stamp) / (row.stamp - before.stamp)
            one, other = before.estimate.pose, row.estimate.pose
            between_x = one.x + share * (other.x - one.x)
            between_y = one.y + share * (other.y - one.y)
            self._differences.append(math.hypot(between_x - x, between_y - y))
            self._compared += 1

    def _difference(self) -> list[Difference]:
        if self._topic is None or not self._compared:
            return []
        median, high = np.percentile(self._differences.rows, (50.0, 99.0)).tolist()
        return [Difference(self._topic, self._compared, median, high)]


def lines_of(summary: LocalizationSummary) -> list[tuple[str, str]]:
    """Return the figures as a short table for people: rows of a name and a text."""
    shares = ", ".join(f"{name} {100.0 * share:.1f} %" for name, share in summary.shares.items())
    lines = [
        ("drive", f"{summary.seconds:.1f} s, {summary.scans} scans, way {summary.way:.2f} m"),
        (
            "speed",
            f"{summary.scans_per_second:.0f} scans/s, {summary.times_real_time:.0f} times real "
            f"time ({summary.processing_seconds:.1f} s)",
        ),
        ("start", f"{summary.start}, {_found(summary)}"),
        ("place", shares),
    ]
    if summary.position_deviation is not None and summary.heading_deviation is not None:
        deviation = f"{summary.position_deviation:.3f} m, {summary.heading_deviation:.4f} rad"
        lines.append(("deviation", f"median {deviation}, while the place was known"))
    lines += [("lost", _text_of(loss)) for loss in summary.losses[:_SHOWN_LOSSES]]
    if summary.loss_count > _SHOWN_LOSSES:
        lines.append(("lost", f"and {summary.loss_count - _SHOWN_LOSSES} times more"))
    lines += [
        (
            each.topic,
            f"differs by {each.median:.3f} m (median), {each.percentile_99:.3f} m (99th "
            f"percentile) at {each.count} places",
        )
        for each in summary.differences
    ]
    return [*lines, *(("note", note) for note in summary.notes)]


def _found(summary: LocalizationSummary) -> str:
    if summary.found_after is None or summary.found_at is None:
        return "the place was never known: is this its map?"
    x, y, theta = summary.found_at
    return f"known after {summary.found_after:.1f} s at ({x:.2f}, {y:.2f}), {theta:.2f} rad"


def _text_of(loss: Loss) -> str:
    for_how_long = "to the end" if loss.seconds is None else f"for {loss.seconds:.1f} s"
    return (
        f"at {loss.elapsed:.1f} s near ({loss.x:.2f}, {loss.y:.2f}) {for_how_long}: {loss.reason}"
    )


def _own_pose(heard: Heard) -> Pose | None:
    """Return the pose that a message tells, if it is of the map."""
    message = heard.message
    if hasattr(message, "pos_x"):
        return Pose(message.pos_x, message.pos_y)
    if message.header.frame_id.lstrip("/") not in ("", "map"):
        return None
    try:
        return pose_of(message if hasattr(message.pose, "position") else message.pose)
    except MessageError:
        return None


def _numbers(pose: Pose) -> tuple[float, float, float]:
    return pose.x, pose.y, pose.theta


def _median(values: list[float]) -> float | None:
    return float(np.median(values)) if values else None
