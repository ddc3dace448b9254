"""Counts, along a drive, how well the place was known and where it was lost."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from roomba.commands.localize.replay import Row
from roomba.geometry import Pose
from roomba.perception.localization.estimate import Knowledge

_MOST_ROWS: Final = 40_000
"""Rows that are kept of a drive, however long it is."""
_MOST_LOSSES: Final = 200
_NEAR: Final = 0.5
"""s; a pose of the robot itself is compared only between two rows that are no farther apart."""


class Thinned:
    """Rows evenly spread over a drive: when there are too many, every second one is dropped."""

    def __init__(self) -> None:
        """Begin with none."""
        self.rows: list[Any] = []
        self._stride, self._count = 1, 0

    def append(self, row: Any) -> None:
        """Take one, or leave it out."""
        if self._count % self._stride == 0:
            self.rows.append(row)
            if len(self.rows) > _MOST_ROWS:
                self.rows = self.rows[::2]
                self._stride *= 2
        self._count += 1


@dataclass(slots=True)
class Loss:
    """A loss of the place: when (s since the start, and stamp), where, m, and why.

    ``seconds`` is how long it lasted; None: to the end.
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


class Tally:
    """Counts while a drive is gone through; ``rows`` are some of it, evenly spread."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.rows = Thinned()
        self.losses: list[Loss] = []
        self.loss_count = 0
        self.last: Row | None = None
        self.found: Row | None = None
        self._seconds = dict.fromkeys(Knowledge, 0.0)
        self._own: deque[tuple[float, float, float]] = deque()
        self._differences = Thinned()
        self._compared = 0

    @property
    def seconds(self) -> float:
        """How much time of the recording has passed, s."""
        return self.last.elapsed if self.last is not None else 0.0

    @property
    def shares(self) -> dict[str, float]:
        """How the place was known, as shares 0..1 of the time."""
        counted = sum(self._seconds.values())
        return {
            knowledge.value: spent / counted if counted > 0.0 else 0.0
            for knowledge, spent in self._seconds.items()
        }

    @property
    def shown_rows(self) -> list[Row]:
        """Some of the rows, evenly spread, and the last one."""
        return [*self.rows.rows, *([] if self.last is None else [self.last])]

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

    def hear_own_pose(self, stamp: float, pose: Pose) -> None:
        """Take the pose that the robot itself believed, to be compared with the next rows."""
        self._own.append((stamp, pose.x, pose.y))

    def _begin_loss(self, before: Row, row: Row) -> None:
        self.loss_count += 1
        if len(self.losses) < _MOST_LOSSES:
            pose = before.estimate.pose
            # The text after the semicolon is advice for a robot on the spot: it comes too late
            # here.
            reason = row.estimate.reason.partition(";")[0]
            self.losses.append(Loss(row.elapsed, row.stamp, pose.x, pose.y, reason))

    def _end_loss(self, row: Row) -> None:
        if self.losses and self.losses[-1].seconds is None:
            self.losses[-1].seconds = row.elapsed - self.losses[-1].elapsed

    def _compare(self, before: Row, row: Row) -> None:
        """Compare the robot's own poses between two rows with the rows' poses."""
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

    def differences(self, topic: str | None) -> list[Difference]:
        """Return how far the robot's own poses, of a topic, are from the rows; [] without any."""
        if topic is None or not self._compared:
            return []
        median, high = np.percentile(self._differences.rows, (50.0, 99.0)).tolist()
        return [Difference(topic, self._compared, median, high)]
