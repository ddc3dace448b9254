"""Bags of ROS 1 and 2 (a folder with metadata.yaml, .db3, .mcap), read without ROS by rosbags.

Only standard messages are needed, and their fields are the same in all versions of ROS: what a bag
says about the types of its messages is not read.
"""

from __future__ import annotations

import heapq
import operator
import struct
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from rosbags.rosbag1 import Reader as Reader1
from rosbags.rosbag2 import Reader as Reader2
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from roomba.perception.matching.mounts import FrameTransform, frame_name
from roomba.recordings.bag_values import LidarBook, decoded, transforms_in
from roomba.recordings.log import Arrival, Channel, MountOf
from roomba.recordings.packed import Unpacked
from roomba.recordings.readings import Kind, LogError, Refused, Value

_KINDS: Final[dict[str, Kind]] = {
    "sensor_msgs/LaserScan": Kind.SCAN,
    "nav_msgs/Odometry": Kind.ODOMETRY,
    "sensor_msgs/Imu": Kind.GYRO,
}
_TRUE_POSES: Final = ("ground_truth/pose", "geometry_msgs/PoseStamped")
"""End of a topic's name, and its type."""
_TRANSFORMS: Final = ("tf2_msgs/TFMessage", "tf/tfMessage")
_TRANSFORM_FIELDS: Final = "geometry_msgs/TransformStamped[] transforms"
_FIXED_MESSAGES: Final = 1000
_MOVING_MESSAGES: Final = 300
"""Messages of /tf_static and /tf that are searched for the mounts of sensors."""
_ODOMETRY_FRAME: Final = "odom"
_SKIPPED: Final = 10**9
"""ns; after what cannot be read it goes on so much later."""
_MOST_SKIPS: Final = 1000
_STAMP: Final = struct.Struct("<4xII")
"""Of a message with a header: its stamp, s and ns, after a number (ROS 1) or what tells how the
message is encoded (ROS 2).
"""

_Raw = tuple[int, bytes]
"""When it was recorded, ns, and the message."""


class BagLog:
    """A bag that is open for reading, and unpacked if it was packed."""

    def __init__(self, path: Path) -> None:
        """Open; raises LogError."""
        self.path = path
        self.notes: list[str] = []
        self._file = Unpacked(path)
        self._readers: list[Any] = []
        self._is_first = path.is_file() and self._file.path.suffix == ".bag"
        self._deserialize = _deserializer(self._is_first)
        try:
            self._first = self._opened()
        except LogError:
            self.close()
            raise
        self._types = {
            name: str(info.msgtype).replace("/msg/", "/")
            for name, info in self._first.topics.items()
            if info.msgcount
        }
        if not self._types:
            self.close()
            raise LogError(f"{path}: the bag is empty: it has no messages")

    @cached_property
    def channels(self) -> Sequence[Channel]:
        """The topics; one of transforms is of odometry if no other one is, and it tells of it."""
        topics = self._first.topics
        channels = [
            Channel(name, _kind(name, type_), type_, topics[name].msgcount)
            for name, type_ in self._types.items()
        ]
        if any(channel.kind is Kind.ODOMETRY for channel in channels):
            return channels
        return [
            channel._replace(kind=Kind.ODOMETRY)
            if self._moving is not None and _may_move(channel)
            else channel
            for channel in channels
        ]

    def base(self, odometry: Channel) -> str:
        """Return the frame that odometry tells of."""
        if odometry.type in _TRANSFORMS:
            return self._moving.child if self._moving is not None else ""
        first = next(self._messages(odometry), None)
        return "" if first is None else frame_name(str(first[1].child_frame_id))

    def transforms(self) -> Iterable[FrameTransform]:
        """Return what does not move; of /tf what others than odometry and maps say.

        Some robots tell again and again on /tf what never changes.
        """
        fixed = [each for _, each in self._transforms(_FIXED_MESSAGES, is_static=True)]
        known = {each.child for each in fixed}
        base = "" if self._moving is None else self._moving.child
        moving = (each for _, each in self._transforms(_MOVING_MESSAGES, is_static=False))
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
        for recorded, number, raw in self._merged(channels):
            arrival = 1e-9 * recorded
            if channels[number].type in _TRANSFORMS:
                for stamp, each in transforms_in(self._message(channels[number], raw)):
                    if self._is_odometry(each):
                        yield Arrival(number, stamp, arrival)
                continue
            yield Arrival(number, _stamp_of(raw), arrival)

    def values(
        self, channels: Sequence[Channel], wanted: NDArray[np.bool_], mount_of: MountOf
    ) -> Iterator[Value | Refused | None]:
        """Yield the values of topics."""
        lidars = LidarBook(mount_of)
        at = 0
        for _, number, raw in self._merged(channels):
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
        for reader in self._readers:
            reader.close()
        self._readers.clear()
        self._file.close()

    @cached_property
    def _moving(self) -> FrameTransform | None:
        """The first transform that is odometry."""
        found = (each for _, each in self._transforms(_MOVING_MESSAGES, is_static=False))
        return next((each for each in found if _ODOMETRY_FRAME in each.parent.lower()), None)

    def _is_odometry(self, transform: FrameTransform) -> bool:
        odometry = self._moving
        return odometry is not None and transform[:2] == odometry[:2]

    def _transforms(self, most: int, *, is_static: bool) -> Iterator[tuple[float, FrameTransform]]:
        """Yield stamps and transforms of the first messages of them."""
        for name, type_ in self._types.items():
            if type_ not in _TRANSFORMS or _is_static(name) is not is_static:
                continue
            messages = self._messages(Channel(name, None, type_, 0))
            for (_, message), _ in zip(messages, range(most), strict=False):
                yield from transforms_in(message)

    def _messages(self, channel: Channel) -> Iterator[tuple[int, Any]]:
        """Yield time of recording, ns, and message of a topic; none that is cut short."""
        for recorded, raw in self._raw(self._first, channel):
            message = self._message(channel, raw)
            if message is not None:
                yield recorded, message

    def _message(self, channel: Channel, raw: bytes) -> Any:
        """Return a message; None for one that is cut short."""
        type_ = _TRANSFORMS[0] if channel.type in _TRANSFORMS else channel.type
        try:
            return self._deserialize(raw, type_.replace("/", "/msg/"))
        except SerdeError:
            return None

    def _merged(self, channels: Sequence[Channel]) -> Iterator[tuple[int, int, bytes]]:
        """Yield time of recording, ns, number of its channel, and each message, by that time.

        Each channel has a reader of its own, for a reader keeps one chunk of a bag at a time, and
        some programs write bags topic by topic.
        """
        readers = [self._opened() for _ in channels]
        streams = [
            self._numbered(number, reader, channel)
            for number, (reader, channel) in enumerate(zip(readers, channels, strict=True))
        ]
        try:
            yield from heapq.merge(*streams, key=operator.itemgetter(0, 1))
        finally:
            for reader in readers:
                reader.close()
                self._readers.remove(reader)

    def _numbered(
        self, number: int, reader: Any, channel: Channel
    ) -> Iterator[tuple[int, int, bytes]]:
        return ((recorded, number, raw) for recorded, raw in self._raw(reader, channel))

    def _raw(self, reader: Any, channel: Channel) -> Iterator[_Raw]:
        """Yield the messages of a topic; goes on a second later after what cannot be read."""
        connections = [each for each in reader.connections if each.topic == channel.name]
        start: int | None = None
        skips, reason = 0, ""
        while True:
            try:
                for _, recorded, raw in reader.messages(connections=connections, start=start):
                    start = recorded + 1
                    yield recorded, bytes(raw)
                break
            except Exception as error:  # whatever rosbags raises of a damaged bag
                start = (start or reader.start_time) + _SKIPPED
                skips += 1
                reason = str(error) or type(error).__name__
                if start > reader.end_time or skips > _MOST_SKIPS:
                    break
        if skips:
            self._note(f"{channel.name}: the bag is damaged, {skips} s are missing: {reason}")

    def _opened(self) -> Any:
        """Return a new reader that is open; raises LogError."""
        try:
            reader = (Reader1 if self._is_first else Reader2)(self._file.path)
            reader.open()
        except Exception as error:  # whatever rosbags raises of what is no bag
            raise LogError(_told(self.path, error)) from None
        self._readers.append(reader)
        return reader

    def _note(self, note: str) -> None:
        if note not in self.notes:
            self.notes.append(note)


def _deserializer(is_first: bool) -> Callable[[bytes, str], Any]:
    """Return what makes messages of ROS 1, or else 2, of bytes and the name of a type."""
    store = get_typestore(Stores.ROS1_NOETIC if is_first else Stores.ROS2_HUMBLE)
    if is_first:
        store.register(get_types_from_msg(_TRANSFORM_FIELDS, _TRANSFORMS[0].replace("/", "/msg/")))
    made: Callable[[bytes, str], Any] = (
        store.deserialize_ros1 if is_first else store.deserialize_cdr
    )
    return made


def _told(path: Path, error: Exception) -> str:
    """Return why a bag cannot be opened, and what to do about it."""
    reason = str(error) or type(error).__name__
    if "reindex" in reason:
        return (
            f"{path}: the bag has no index: its recording or copying was cut short; mend it by "
            f"`./roomba exec rosbag reindex {path}`, which keeps the old one as .orig.bag"
        )
    if isinstance(error, PermissionError):
        return f"{path}: cannot be read: {error.strerror}"
    return f"{path}: expected a whole bag, it cannot be opened: {reason}"


def _kind(name: str, type_: str) -> Kind | None:
    end, true_type = _TRUE_POSES
    if type_ == true_type and name.endswith(end):
        return Kind.TRUTH
    return _KINDS.get(type_)


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
