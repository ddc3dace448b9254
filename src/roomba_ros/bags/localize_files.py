"""The files of a localized drive: a table of numbers, and a bag."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any, Final, Protocol

import rosbag
from tf2_msgs.msg import TFMessage

from roomba.perception.localization.estimate import Knowledge
from roomba_ros.bags.localize_replay import Row
from roomba_ros.convert.common import pose_message, stamp_of, transform_message
from roomba_ros.convert.localization import covariance_pose_message, localization_message

_COLUMNS: Final = (
    "t",
    "x",
    "y",
    "theta",
    "position_deviation",
    "heading_deviation",
    "state",
)
OUTPUT_TOPICS: Final = ("/pose", "/amcl_pose", "/localization")
"""What a bag has beside the transforms on /tf."""
_SAY_PERIOD: Final = 1.0
"""s between two messages of the state, if nothing of it changes."""
_MAP_FRAME: Final = "map"


class RowFile(Protocol):
    """Somewhere to write rows; a context."""

    def __enter__(self) -> RowFile:
        """Return itself."""

    def __exit__(self, *_: object) -> None:
        """Finish the file."""

    def write(self, row: Row) -> None:
        """Write a row."""


class RowTable:
    """A CSV file: t (s, the recording's stamps), x, y (m), theta (rad), deviations, state."""

    def __init__(self, path: Path) -> None:
        """Begin the file; raises OSError."""
        self._file = path.open("w", encoding="utf-8", newline="")
        self._writer = csv.writer(self._file, lineterminator="\n")
        self._writer.writerow(_COLUMNS)

    def __enter__(self) -> RowTable:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the file."""
        self._file.close()

    def write(self, row: Row) -> None:
        """Write a line."""
        estimate, pose = row.estimate, row.estimate.pose
        self._writer.writerow(
            (
                f"{row.stamp:.6f}",
                f"{pose.x:.5f}",
                f"{pose.y:.5f}",
                f"{pose.theta:.5f}",
                f"{estimate.position_deviation:.5f}",
                f"{estimate.heading_deviation:.5f}",
                estimate.knowledge.value,
            )
        )


class RowBag:
    """A bag to be played beside the recorded one, with what the live node would have told.

    ``/pose`` in each row; ``/amcl_pose`` and ``/tf`` (map -> odometry's frame) in every other one;
    ``/localization`` at a change, and once a second.
    """

    def __init__(self, path: Path, odometry_frame: str) -> None:
        """Begin the bag; raises OSError."""
        self._bag = rosbag.Bag(str(path), "w")
        self._odometry_frame = odometry_frame
        self._rows = 0
        self._said: tuple[Knowledge, str] | None = None
        self._said_at = -math.inf

    def __enter__(self) -> RowBag:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the bag, with its index."""
        self._bag.close()

    def write(self, row: Row) -> None:
        """Write a row's messages, at the time of its recording."""
        stamp, estimate = row.stamp, row.estimate
        self._put("/pose", pose_message(stamp, estimate.pose, _MAP_FRAME), row)
        if self._rows % 2 == 0:
            self._put("/amcl_pose", covariance_pose_message(stamp, estimate, _MAP_FRAME), row)
            transform = transform_message(
                stamp, row.map_to_odometry, _MAP_FRAME, self._odometry_frame
            )
            self._put("/tf", TFMessage([transform]), row)
        self._rows += 1
        said = (estimate.knowledge, estimate.reason)
        if said != self._said or not 0.0 <= stamp - self._said_at < _SAY_PERIOD:
            self._said, self._said_at = said, stamp
            self._put("/localization", localization_message(stamp, estimate, _MAP_FRAME), row)

    def _put(self, topic: str, message: Any, row: Row) -> None:
        self._bag.write(topic, message, stamp_of(row.arrival))
