"""Bags of ROS 1 and 2 (a folder with metadata.yaml, .db3, .mcap), read without ROS by rosbags.

Only standard messages and those of this robot are needed, and their fields are the same in all
versions of ROS. So the definitions of types in a bag are not read.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from rosbags.serde import SerdeError

from roomba.perception.matching.mounts import FrameTransform, frame_name
from roomba.recordings.bag_file import BagFile
from roomba.recordings.bag_values import (
    LidarBook,
    decoded,
    transforms_in,
    with_first_echoes,
)
from roomba.recordings.log import Arrival, Channel, Frames, MountOf
from roomba.recordings.message_types import TRANSFORMS, full_name, known_types
from roomba.recordings.readings import Kind, Refused, Value

_SEVERAL_ECHOES: Final = "sensor_msgs/MultiEchoLaserScan"
_KINDS: Final[dict[str, Kind]] = {
    "sensor_msgs/LaserScan": Kind.SCAN,
    _SEVERAL_ECHOES: Kind.SCAN,
    "nav_msgs/Odometry": Kind.ODOMETRY,
    "sensor_msgs/Imu": Kind.GYRO,
    "roomba_robot/WheelDrop": Kind.LIFTED,
}
_TRUE_POSES: Final = ("ground_truth/pose", "geometry_msgs/PoseStamped")
"""End of a topic's name, and its type."""
_TOLD_NAMES, _TOLD_TYPE = ("initialpose", "amcl_pose"), "geometry_msgs/PoseWithCovarianceStamped"
_OWN_NAMES: Final = ("pose", "position", "amcl_pose")
_WITHOUT_STAMP: Final = "roomba_robot/RobotPosition"
_OWN_TYPES: Final = ("geometry_msgs/PoseStamped", _TOLD_TYPE, _WITHOUT_STAMP)
"""Names of topics, and types, of told poses, and of poses that the robot itself estimated."""
_TRANSFORMS: Final = (TRANSFORMS, "tf/tfMessage")
_FIXED_MESSAGES: Final = 1000
_MOVING_MESSAGES: Final = 300
"""Messages of /tf_static and of /tf that are searched for the mounts of sensors. If these tell
nothing of a lidar, /tf is searched further for it."""
_ODOMETRY_FRAME: Final = "odom"
_STAMP: Final = struct.Struct("<4xII")
"""The stamp of a message with a header, s and ns. Before it are a sequence number (ROS 1), or bytes
that tell how the message is encoded (ROS 2)."""


class BagLog:
    """A bag that is open for reading."""

    def __init__(self, path: Path) -> None:
        """Open; raises LogError."""
        self.path = path
        self._file = BagFile(path)
        self._deserialize = _deserializer(self._file.is_of_ros_1)

    @property
    def notes(self) -> Sequence[str]:
        """What is worth knowing of what was read so far."""
        return self._file.notes

    @cached_property
    def channels(self) -> Sequence[Channel]:
        """The topics; one of transforms counts as odometry if it has some and no other has."""
        channels = [
            Channel(name, kind, type_, count)
            for name, (type_, count) in self._file.topics.items()
            for kind in _kinds(name, type_)
        ]
        if any(channel.kind is Kind.ODOMETRY for channel in channels):
            return channels
        return [
            channel._replace(kind=Kind.ODOMETRY)
            if self._moving is not None and _may_move(channel)
            else channel
            for channel in channels
        ]

    def frames(self, odometry: Channel) -> Frames:
        """Return the frame of odometry, and the frame of the body whose pose it tells."""
        if odometry.type in _TRANSFORMS:
            return Frames("", "") if self._moving is None else Frames(*self._moving[:2])
        first = next(self._messages(odometry), None)
        if first is None:
            return Frames("", "")
        names = (first.header.frame_id, first.child_frame_id)
        return Frames(*(frame_name(str(name)) for name in names))

    def transforms(self) -> Iterable[FrameTransform]:
        """Return transforms that do not move; of /tf those that are not of odometry or maps.

        Some robots repeat on /tf what never changes.
        """
        fixed = list(self._transforms(_FIXED_MESSAGES, is_static=True))
        known = {each.child for each in fixed}
        base = "" if self._moving is None else self._moving.child
        sought = self._frames_of_scans() - known
        moving = list(self._transforms(_MOVING_MESSAGES, is_static=False, sought=sought))
        return [
            *(
                each
                for each in moving
                if each.child not in known and each.child != base and not _is_world(each.parent)
            ),
            *fixed,
        ]

    def entries(self, channels: Sequence[Channel]) -> Iterator[Arrival]:
        """Yield what came on topics."""
        for recorded, number, raw in self._file.merged([each.name for each in channels]):
            arrival = 1e-9 * recorded
            if channels[number].type in _TRANSFORMS:
                for stamp, each in transforms_in(self._message(channels[number], raw)):
                    if self._is_odometry(each):
                        yield Arrival(number, stamp, arrival)
                continue
            has_stamp = channels[number].type != _WITHOUT_STAMP
            yield Arrival(number, _stamp_of(raw) if has_stamp else 0.0, arrival)

    def values(
        self, channels: Sequence[Channel], wanted: NDArray[np.bool_], mount_of: MountOf
    ) -> Iterator[Value | Refused | None]:
        """Yield the values of topics."""
        lidars = LidarBook(mount_of)
        at = 0
        for _, number, raw in self._file.merged([each.name for each in channels]):
            channel = channels[number]
            if channel.type in _TRANSFORMS:
                for _, each in transforms_in(self._message(channel, raw)):
                    if self._is_odometry(each):
                        yield decoded(Kind.ODOMETRY, each, lidars) if wanted[at] else None
                        at += 1
                continue
            at += 1
            if not wanted[at - 1] or channel.kind is None:
                yield None
                continue
            message = self._message(channel, raw)
            yield (
                Refused("messages that are cut short", f"on {channel.name}")
                if message is None
                else decoded(channel.kind, message, lidars)
            )

    def close(self) -> None:
        """Close the bag, and remove what was unpacked of it."""
        self._file.close()

    @cached_property
    def _moving(self) -> FrameTransform | None:
        """The first transform of odometry; searched in the whole bag if no topic has odometry."""
        is_told = any(_KINDS.get(type_) is Kind.ODOMETRY for type_, _ in self._file.topics.values())
        found = self._transforms(_MOVING_MESSAGES if is_told else math.inf, is_static=False)
        return next((each for each in found if _ODOMETRY_FRAME in each.parent.lower()), None)

    def _is_odometry(self, transform: FrameTransform) -> bool:
        odometry = self._moving
        return odometry is not None and transform[:2] == odometry[:2]

    def _frames_of_scans(self) -> set[str]:
        """Return the frames of lidars, as the first scan of each topic tells them."""
        topics = (
            Channel(name, Kind.SCAN, type_, count)
            for name, (type_, count) in self._file.topics.items()
            if _KINDS.get(type_) is Kind.SCAN
        )
        firsts = (next(self._messages(each), None) for each in topics)
        return {frame_name(str(first.header.frame_id)) for first in firsts if first is not None}

    def _transforms(
        self, most: float, *, is_static: bool, sought: Set[str] = frozenset()
    ) -> Iterator[FrameTransform]:
        """Yield the transforms of the first messages of each topic.

        Of later ones it yields the first of each frame that is ``sought``, until all were there.
        """
        missing = set(sought)
        for name, (type_, _) in self._file.topics.items():
            if type_ not in _TRANSFORMS or _is_static(name) is not is_static:
                continue
            for number, message in enumerate(self._messages(Channel(name, None, type_, 0))):
                if number >= most and not missing:
                    break
                for _, each in transforms_in(message):
                    if number < most or each.child in missing:
                        yield each
                    missing.discard(each.child)

    def _messages(self, channel: Channel) -> Iterator[Any]:
        """Yield the messages of a topic that are not cut short."""
        decoded_ones = (self._message(channel, raw) for raw in self._file.messages(channel.name))
        return (message for message in decoded_ones if message is not None)

    def _message(self, channel: Channel, raw: bytes) -> Any:
        """Return a message; None for one that is cut short."""
        type_ = _TRANSFORMS[0] if channel.type in _TRANSFORMS else channel.type
        try:
            message = self._deserialize(raw, full_name(type_))
        except SerdeError:
            return None
        return with_first_echoes(message) if type_ == _SEVERAL_ECHOES else message


def _deserializer(is_first: bool) -> Callable[[bytes, str], Any]:
    """Return the function that decodes bytes of a named type, of ROS 1 or else of ROS 2."""
    store = known_types(is_first=is_first)
    made: Callable[[bytes, str], Any] = (
        store.deserialize_ros1 if is_first else store.deserialize_cdr
    )
    return made


def _kinds(name: str, type_: str) -> list[Kind | None]:
    """Return what a topic tells: one topic may have told poses and the robot's own ones."""
    end, true_type = _TRUE_POSES
    if type_ == true_type and name.endswith(end):
        return [Kind.TRUTH]
    last = name.rpartition("/")[2]
    kinds: list[Kind | None] = []
    if type_ == _TOLD_TYPE and last in _TOLD_NAMES:
        kinds.append(Kind.TOLD)
    if type_ in _OWN_TYPES and last in _OWN_NAMES:
        kinds.append(Kind.OWN_POSE)
    return kinds or [_KINDS.get(type_)]


def _may_move(channel: Channel) -> bool:
    return channel.type in _TRANSFORMS and not _is_static(channel.name)


def _is_static(topic: str) -> bool:
    return "static" in topic


def _is_world(frame: str) -> bool:
    return frame in ("map", "world") or _ODOMETRY_FRAME in frame.lower()


def _stamp_of(raw: bytes) -> float:
    """Return a message's stamp, s; 0 of one that is cut short."""
    if len(raw) < _STAMP.size:
        return 0.0
    seconds, nanoseconds = _STAMP.unpack_from(raw)
    return float(seconds + 1e-9 * nanoseconds)
