"""The files of a localized drive: tables of numbers, and a bag."""

from __future__ import annotations

import csv
import errno
import math
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray
from rosbags.rosbag1 import Writer

from roomba.commands.localize.replay import Row
from roomba.commands.map.drive.trajectory import trajectory_line
from roomba.geometry import Pose
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.recordings.message_types import OWN_STATE, TRANSFORMS, full_name, known_types

_COLUMNS: Final = (
    "t",
    "x",
    "y",
    "theta",
    "position_deviation",
    "heading_deviation",
    "state",
)
_TYPES: Final = {
    "/pose": "geometry_msgs/PoseStamped",
    "/amcl_pose": "geometry_msgs/PoseWithCovarianceStamped",
    "/localization": OWN_STATE,
    "/tf": TRANSFORMS,
}
"""The type of the messages on each topic of the bag."""
OUTPUT_TOPICS: Final = ("/pose", "/amcl_pose", "/localization")
"""The topics that the bag has besides the transforms on /tf."""
_STATES: Final = {state: code for code, state in enumerate(Knowledge)}
"""The numbers of states, as in roomba_robot/Localization."""
_AXES: Final = (0, 1, 5)
"""Of a covariance's six axes x, y, z and the turns about them: x, y and the turn about z."""
_EARLIEST: Final = 10**6
"""ns; a bag has no time 0."""
_SAY_PERIOD: Final = 1.0
"""s between two messages of an unchanged state."""
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
    """A CSV file: t (s, by the stamps of scans), x, y (m), theta (rad), deviations, state."""

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
                f"{row.scan_stamp:.6f}",
                f"{pose.x:.5f}",
                f"{pose.y:.5f}",
                f"{pose.theta:.5f}",
                f"{estimate.position_deviation:.5f}",
                f"{estimate.heading_deviation:.5f}",
                estimate.knowledge.value,
            )
        )


class RowTrajectory:
    """A text file of lines ``t x y theta``: s, by the stamps of scans, m and rad."""

    def __init__(self, path: Path) -> None:
        """Begin the file; raises OSError."""
        self._file = path.open("w", encoding="utf-8")

    def __enter__(self) -> RowTrajectory:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the file."""
        self._file.close()

    def write(self, row: Row) -> None:
        """Write a line."""
        self._file.write(trajectory_line(row.scan_stamp, row.estimate.pose))


class RowBag:
    """A bag of ROS 1 with the live node's messages, to be played beside the recorded one."""

    def __init__(self, path: Path, odometry_frame: str) -> None:
        """Begin the bag; raises OSError."""
        self._store = known_types(is_first=True)
        self._odometry_frame = odometry_frame
        self._rows = 0
        self._said: tuple[Knowledge, str] | None = None
        self._said_at = -math.inf
        if path.exists() and not path.is_file():
            raise OSError(errno.EINVAL, "expected a file, got a pipe or a device", str(path))
        path.unlink(missing_ok=True)
        self._writer = Writer(path)
        self._writer.open()
        self._connections = {
            topic: self._writer.add_connection(topic, full_name(type_), typestore=self._store)
            for topic, type_ in _TYPES.items()
        }

    def __enter__(self) -> RowBag:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the bag, with its index."""
        self._writer.close()

    def write(self, row: Row) -> None:
        """Write a row's messages, at the time of its recording."""
        stamp, estimate = row.stamp, row.estimate
        header, pose = self._header(stamp, _MAP_FRAME), self._pose(estimate.pose)
        self._put("/pose", row, header=header, pose=pose)
        if self._rows % 2 == 0:
            sure = self._make(
                "geometry_msgs/PoseWithCovariance", pose=pose, covariance=_covariance(estimate)
            )
            self._put("/amcl_pose", row, header=header, pose=sure)
            self._put("/tf", row, transforms=[self._transform(header, row.map_to_odometry)])
        self._rows += 1
        said = (estimate.knowledge, estimate.reason)
        if said != self._said or not stamp - self._said_at < _SAY_PERIOD:
            self._said, self._said_at = said, stamp
            self._put(
                "/localization",
                row,
                header=header,
                state=_STATES[estimate.knowledge],
                position_deviation=estimate.position_deviation,
                heading_deviation=estimate.heading_deviation,
                agreement=estimate.agreement,
                message=estimate.reason,
            )

    def _put(self, topic: str, row: Row, **fields: Any) -> None:
        type_ = _TYPES[topic]
        data = self._store.serialize_ros1(self._make(type_, **fields), full_name(type_))
        arrival = max(round(1e9 * row.arrival), _EARLIEST)
        self._writer.write(self._connections[topic], arrival, data)

    def _make(self, type_: str, **fields: Any) -> Any:
        return self._store.types[full_name(type_)](**fields)

    def _header(self, stamp: float, frame: str) -> Any:
        seconds, nanoseconds = divmod(round(1e9 * stamp), 10**9)
        time = self._make("builtin_interfaces/Time", sec=seconds, nanosec=nanoseconds)
        return self._make("std_msgs/Header", seq=0, stamp=time, frame_id=frame)

    def _pose(self, pose: Pose) -> Any:
        place = self._make("geometry_msgs/Point", x=pose.x, y=pose.y, z=0.0)
        return self._make("geometry_msgs/Pose", position=place, orientation=self._turn(pose.theta))

    def _turn(self, theta: float) -> Any:
        z, w = math.sin(0.5 * theta), math.cos(0.5 * theta)
        return self._make("geometry_msgs/Quaternion", x=0.0, y=0.0, z=z, w=w)

    def _transform(self, header: Any, pose: Pose) -> Any:
        """Return where the frame of odometry is on the map."""
        shift = self._make("geometry_msgs/Vector3", x=pose.x, y=pose.y, z=0.0)
        moved = self._make(
            "geometry_msgs/Transform", translation=shift, rotation=self._turn(pose.theta)
        )
        return self._make(
            "geometry_msgs/TransformStamped",
            header=header,
            child_frame_id=self._odometry_frame,
            transform=moved,
        )


def _covariance(estimate: Estimate) -> NDArray[np.float64]:
    """Return a covariance of six axes, [36], from that of the planar pose."""
    of_all = np.zeros((6, 6))
    of_all[np.ix_(_AXES, _AXES)] = estimate.covariance
    return of_all.ravel()
