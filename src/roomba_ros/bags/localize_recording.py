"""Reading a recorded drive: what the robot's sensors said, in the order in which it happened.

Memory holds an index of some twenty bytes per message of the topics that are wanted, and the
messages of a second or so: a bag may be of a whole day, and full of pictures beside.
"""

from __future__ import annotations

import heapq
import math
import os
import struct
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import Any, Final

import genpy
import numpy as np
import rosbag
import rosbag.bag as rosbag_format
from numpy.typing import NDArray

from roomba.errors import RoombaError

WINDOW: Final = 1.0
"""s; so far messages are put in the order of their stamps, and so far two clocks may differ."""
_SAMPLES: Final = 9
"""Messages of a topic by which its clock is compared with that of the odometry."""
_LISTED: Final = 30
"""Topics that an error names at most."""
_UNREADABLE: Final = (
    rosbag.ROSBagException,
    genpy.DeserializationError,
    struct.error,
    OSError,
    EOFError,
    ValueError,
    KeyError,
    RuntimeError,  # of roslz4
)


class RecordingError(RoombaError):
    """A bag that cannot be used; says what was expected, what came, and what to do."""


class MessageKind(IntEnum):
    """What a message is about; of messages of the same time the first of these comes first."""

    GYRO = 0
    ODOMETRY = 1
    LIFTED = 2
    """Whether wheels hang in the air."""
    TOLD = 3
    """A pose that a person or a program told."""
    SCAN = 4
    OWN_POSE = 5
    """Where the robot itself believed to be."""


TYPES: Final[dict[MessageKind, tuple[str, ...]]] = {
    MessageKind.GYRO: ("sensor_msgs/Imu",),
    MessageKind.ODOMETRY: ("nav_msgs/Odometry",),
    MessageKind.LIFTED: ("roomba_robot/WheelDrop",),
    MessageKind.TOLD: ("geometry_msgs/PoseWithCovarianceStamped",),
    MessageKind.SCAN: ("sensor_msgs/LaserScan",),
    MessageKind.OWN_POSE: (
        "geometry_msgs/PoseStamped",
        "roomba_robot/RobotPosition",
        "geometry_msgs/PoseWithCovarianceStamped",
    ),
}


@dataclass(frozen=True, slots=True)
class Heard:
    """One message: ``stamp`` is when it was measured, by the clock of the odometry, s.

    ``arrival`` is when it was recorded, s, by the recorder's clock; ``share`` 0..1 of all is read.
    """

    stamp: float
    kind: MessageKind
    message: Any
    arrival: float
    share: float


@dataclass(frozen=True, slots=True)
class _Index:
    """Where messages are, in the order of their reading: of each the chunk, place in it, topic."""

    chunks: NDArray[np.int64]
    offsets: NDArray[np.int64]
    topics: NDArray[np.int64]


class RecordedBag:
    """A bag that is open for reading; a context.

    It is read by its chunks, as :mod:`rosbag` finds them: that module itself would keep an object
    for each message of each topic, and would mix up what was recorded before and after a clock was
    set back.
    """

    def __init__(self, path: Path) -> None:
        """Open; raises RecordingError."""
        self.path = path
        self.notes: list[str] = []
        """What is worth knowing of what was read so far."""
        self._bag = _opened(path)
        self.types: dict[str, str] = {
            connection.topic: connection.datatype
            for connection in self._bag._get_connections()
            if any(connection.id in chunk.connection_counts for chunk in self._bag._chunks)
        }
        if not self.types:
            self._bag.close()
            raise RecordingError(f"{path}: the bag is empty: it has no messages")
        self._broken_chunks: set[int] = set()
        self._broken = self._late = 0
        self._why_broken = ""

    def __enter__(self) -> RecordedBag:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the bag."""
        self._bag.close()

    def require(self, topic: str, kind: MessageKind, option: str) -> str:
        """Return a topic's name if such messages are on it; raises RecordingError."""
        expected = TYPES[kind][0]
        name = topic if topic in self.types else f"/{topic.strip('/')}"
        found = self.types.get(name)
        if found == expected:
            return name
        got = f"it is {found}" if found else "there is none"
        listed = [f"{other} ({self.types[other]})" for other in sorted(self.types)]
        if len(listed) > _LISTED:
            listed = [*listed[:_LISTED], f"and {len(listed) - _LISTED} more"]
        fitting = sorted(other for other, type_ in self.types.items() if type_ == expected)
        hint = " or ".join(f"{option} {other}" for other in fitting)
        hint = f"try {hint}" if fitting else f"no other topic is {expected} either"
        raise RecordingError(
            f"{self.path}: expected {expected} on {name}, {got}; {hint}. "
            f"The bag has {', '.join(listed)}"
        )

    def beside(self, topic: str, name: str, kind: MessageKind) -> str | None:
        """Return the topic ``name`` of the same robot as ``topic``, if such messages are on it."""
        namespace = topic.rpartition("/")[0]
        for candidate in (f"{namespace}/{name}", f"/{name}"):
            if self.types.get(candidate) in TYPES[kind]:
                return candidate
        return None

    def first(self, topics: Collection[str], count: int) -> list[Any]:
        """Return the first messages, at most ``count``, of topics."""
        known = [topic for topic in topics if topic in self.types]
        if not known:
            return []
        index = self._index(known, known[0])
        read = (self._read(index, at) for at in range(min(count, len(index.chunks))))
        return [found[1] for found in read if found is not None]

    def messages(self, kinds: dict[str, MessageKind]) -> Iterator[Heard]:
        """Yield the messages of topics, each with its kind, in the order of their stamps.

        One of the topics is of odometry. Where that clock is set back all begins anew; other
        messages that come more than a second late are left out, and counted in the notes.
        """
        odometry = next(topic for topic, kind in kinds.items() if kind is MessageKind.ODOMETRY)
        topics = list(kinds)
        index = self._index(topics, odometry)
        clocks = self._clocks(index, topics, odometry)
        waiting: list[tuple[float, MessageKind, int, Heard]] = []
        newest = -math.inf
        for at in range(len(index.chunks)):
            found = self._read(index, at)
            if found is None:
                self._broken += 1
                continue
            topic = topics[index.topics[at]]
            kind, (arrival, message) = kinds[topic], found
            stamp = clocks[topic].stamp(message, arrival)
            if stamp < newest - WINDOW:
                if kind is not MessageKind.ODOMETRY:
                    self._late += 1
                    continue
                while waiting:
                    yield heapq.heappop(waiting)[3]
                newest = stamp
                self._note_once("the clock was set back on the way")
            newest = max(newest, stamp)
            heard = Heard(stamp, kind, message, arrival, at / len(index.chunks))
            heapq.heappush(waiting, (stamp, kind, at, heard))
            while waiting[0][0] < newest - WINDOW:
                yield heapq.heappop(waiting)[3]
        while waiting:
            yield heapq.heappop(waiting)[3]
        if self._late:
            self.notes.append(f"{self._late} messages came more than {WINDOW:g} s late: left out")
        if self._broken:
            self.notes.append(
                f"{self._broken} messages cannot be read, the bag is damaged there: "
                f"{self._why_broken}"
            )

    def _index(self, topics: list[str], odometry: str) -> _Index:
        """Return where the messages of topics are, in the order in which to read them."""
        numbers = {
            connection.id: topics.index(connection.topic)
            for connection in self._bag._get_connections(topics)
        }
        parts = [
            (number, chunk.pos, entries)
            for chunk in self._bag._chunks
            for number, entries in self._entries(chunk, numbers)
        ]
        if not parts:
            nothing = np.empty(0, np.int64)
            return _Index(nothing, nothing, nothing)
        sizes = [len(entries) for *_, entries in parts]
        of_topic = np.repeat(np.array([number for number, *_ in parts], np.int64), sizes)
        chunks = np.repeat(np.array([chunk for _, chunk, _ in parts], np.int64), sizes)
        table = np.concatenate([entries for *_, entries in parts]).astype(np.int64)
        times, offsets = table[:, 0] * 1_000_000_000 + table[:, 1], table[:, 2]
        order = np.lexsort((offsets, chunks))
        driven = times[order][of_topic[order] == topics.index(odometry)]
        # Of a clock that was set back only the order of arrival tells what was before and what
        # after. Otherwise the time counts: some programs write bags topic by topic.
        if not (np.diff(driven) < -WINDOW * 1e9).any():
            order = order[np.argsort(times[order], kind="stable")]
        return _Index(chunks[order], offsets[order], of_topic[order])

    def _entries(
        self, chunk: Any, numbers: dict[int, int]
    ) -> Iterator[tuple[int, NDArray[np.uint32]]]:
        """Yield topic and entries (s, ns, place in the chunk) of each connection of a chunk."""
        if not numbers.keys() & chunk.connection_counts.keys():
            return
        file = self._bag._file
        try:
            file.seek(chunk.pos)
            rosbag_format._skip_record(file)
            for _ in range(len(chunk.connection_counts)):
                header = rosbag_format._read_header(file, rosbag_format._OP_INDEX_DATA)
                connection = rosbag_format._read_uint32_field(header, "conn")
                count = rosbag_format._read_uint32_field(header, "count")
                if count != chunk.connection_counts.get(connection):
                    raise rosbag.ROSBagException("the index of a chunk is damaged")
                rosbag_format._read_uint32(file)  # the record's size, wrong in very old bags
                entries = np.frombuffer(rosbag_format._read(file, 12 * count), "<u4")
                if connection in numbers and count:
                    yield numbers[connection], entries.reshape(-1, 3)
        except _UNREADABLE as error:
            self._why_broken = self._why_broken or str(error)
            lost = (chunk.connection_counts.get(connection, 0) for connection in numbers)
            self._broken += sum(lost)

    def _read(self, index: _Index, at: int) -> tuple[float, Any] | None:
        """Return when a message was recorded, s, and the message; None for a broken one."""
        chunk = int(index.chunks[at])
        if chunk in self._broken_chunks:
            return None
        try:
            _, message, time = self._bag._read_message((chunk, int(index.offsets[at])))
        except _UNREADABLE as error:
            self._why_broken = self._why_broken or str(error)
            self._broken_chunks.add(chunk)
            return None
        return time.to_sec(), message

    def _note_once(self, note: str) -> None:
        if note not in self.notes:
            self.notes.append(note)

    def _clocks(self, index: _Index, topics: list[str], odometry: str) -> dict[str, _Clock]:
        """Return how to come from a topic's stamps to times by the clock of the odometry."""
        delays = {
            topic: self._delay(index, number)
            for number, topic in enumerate(topics)
            if (index.topics == number).any()
        }
        reference = delays.get(odometry)
        clocks = {}
        for topic, delay in delays.items():
            if reference is None:
                clocks[topic] = _Clock(0.0, uses_stamps=False)
                continue
            differs = delay is None or abs(delay - reference) > WINDOW
            if differs and delay is not None:
                self.notes.append(
                    f"the clock of {topic} is {reference - delay:+.1f} s off that of {odometry}: "
                    "the times of recording count instead"
                )
            clocks[topic] = _Clock(reference, uses_stamps=not differs)
        return clocks

    def _delay(self, index: _Index, number: int) -> float | None:
        """Return how long after its stamp a message of a topic is recorded, s.

        None for messages without stamps.
        """
        places = np.flatnonzero(index.topics == number)
        delays = []
        for at in np.unique(np.linspace(0, len(places) - 1, _SAMPLES).astype(np.int64)):
            found = self._read(index, int(places[at]))
            stamp = _stamp_of(found[1]) if found is not None else 0.0
            if found is not None and stamp != 0.0:
                delays.append(found[0] - stamp)
        return float(np.median(delays)) if delays else None


@dataclass(frozen=True, slots=True)
class _Clock:
    """Tells when a message was measured: by its stamp, or ``delay`` s before its recording."""

    delay: float
    uses_stamps: bool

    def stamp(self, message: Any, arrival: float) -> float:
        return (self.uses_stamps and _stamp_of(message)) or arrival - self.delay


def _stamp_of(message: Any) -> float:
    """Return a message's stamp, s; 0 if it has none."""
    header = getattr(message, "header", None)
    return float(header.stamp.to_sec()) if header is not None else 0.0


def _opened(path: Path) -> rosbag.Bag:
    """Open a bag for reading; raises RecordingError."""
    if not path.exists():
        raise RecordingError(f"{path}: no such file; expected a bag")
    if not path.is_file():
        raise RecordingError(f"{path}: expected a bag, got a folder or a device")
    if os.stat(path).st_size == 0:
        raise RecordingError(f"{path}: expected a bag, the file is empty")
    try:
        bag = rosbag.Bag(str(path), skip_index=True)
    except rosbag.ROSBagUnindexedException:
        raise RecordingError(
            f"{path}: the bag has no index: its recording or copying was cut short; mend it by "
            f"`./roomba exec rosbag reindex {path}`, which keeps the old one as .orig.bag"
        ) from None
    except PermissionError as error:
        raise RecordingError(f"{path}: cannot be read: {error.strerror}") from None
    except _UNREADABLE as error:
        raise RecordingError(
            f"{path}: expected a bag of ROS 1, got something else: {error}"
        ) from None
    if bag.version != 200:
        bag.close()
        raise RecordingError(
            f"{path}: expected a bag of version 2.0, got {bag.version / 100:.1f}; make a newer one "
            f"by `./roomba exec rosbag filter {path} NEW.bag True`"
        )
    return bag
