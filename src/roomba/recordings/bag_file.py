"""The raw messages of a bag, whole or damaged, in the order of their recording."""

from __future__ import annotations

import bisect
import heapq
import itertools
import operator
import shlex
import struct
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from rosbags.rosbag1 import Reader as Reader1
from rosbags.rosbag2 import Reader as Reader2

from roomba.recordings.bag_format.index_sizes import has_wrong_sizes, mend_sizes
from roomba.recordings.bag_format.mending import BagError, mend_bag, needs_mending
from roomba.recordings.packed import Unpacked, plain_name
from roomba.recordings.readings import LogError
from roomba.recordings.times.set_back import clock_shifts

_SKIPPED: Final = 10**9
"""ns that are skipped after what cannot be read."""
_MOST_SKIPS: Final = 1000
_RECOVER: Final = {
    "end magic": ("mcap", "mcap recover {} -o whole.mcap"),
    "malformed": ("db3", "sqlite3 {} .recover | sqlite3 whole.db3"),
}
"""By what a reader says of cut files of ROS 2: their form, and the tool that repairs that form."""
_UNNAMED: Final = (
    AssertionError,
    LookupError,
    ArithmeticError,
    ValueError,
    TypeError,
    struct.error,
)
"""What the reader raises where it does not know itself what is wrong."""

_Place = tuple[int, int]
"""Where a message is in a bag: its chunk, and the place in that."""


class Raw(NamedTuple):
    """A message: when it was recorded, ns, the number of its topic, and its bytes."""

    recorded: int
    number: int
    data: bytes


class _ClockRun(NamedTuple):
    """A part of a bag in which the clock went on: its borders, and what to add to times, ns."""

    begin: _Place
    end: _Place
    shift: int


_WHOLE: Final = _ClockRun((-1, -1), (2**63, 0), 0)


class BagFile:
    """A bag that is open for reading, and unpacked if it was packed."""

    def __init__(self, path: Path) -> None:
        """Open; raises LogError."""
        self.path = path
        self.notes: list[str] = []
        self._file = Unpacked(path)
        self._readers: list[Any] = []
        self.is_of_ros_1 = path.is_file() and self._file.path.suffix == ".bag"
        try:
            self._mend_index()
            self._first = self._opened()
        except LogError:
            self.close()
            raise
        self.topics: dict[str, tuple[str, int]] = {
            name: (str(info.msgtype).replace("/msg/", "/"), info.msgcount)
            for name, info in self._first.topics.items()
            if info.msgcount
        }
        """Type and number of the messages of each topic."""
        if not self.topics:
            self.close()
            raise LogError(f"{path}: the bag is empty: it has no messages")
        self._runs = self._found_runs()
        self._lengths: dict[str, int] = {}

    def messages(self, topic: str) -> Iterator[bytes]:
        """Yield the messages of a topic."""
        return (raw.data for raw in self._of_topic(self._first, topic, 0))

    def merged(self, topics: Sequence[str]) -> Iterator[Raw]:
        """Yield the messages of topics, numbered as these are, in the order of their recording.

        Each topic has a reader of its own, for a reader keeps one chunk of a bag at a time, and
        some programs write bags topic by topic. Messages that are recorded meanwhile are left out:
        once a topic was read to its end, it has as many messages the next time.
        """
        readers = [self._opened() for _ in topics]
        streams = [
            self._counted(topic, self._of_topic(reader, topic, number))
            for number, (reader, topic) in enumerate(zip(readers, topics, strict=True))
        ]
        try:
            yield from heapq.merge(*streams, key=operator.itemgetter(0, 1))
        finally:
            for reader in readers:
                reader.close()
                self._readers.remove(reader)

    def close(self) -> None:
        """Close the bag, and remove what was unpacked of it."""
        for reader in self._readers:
            reader.close()
        self._readers.clear()
        self._file.close()

    def _counted(self, topic: str, messages: Iterator[Raw]) -> Iterator[Raw]:
        """Yield as many messages of a topic as it had when it was first read to its end."""
        count = 0
        for raw in itertools.islice(messages, self._lengths.get(topic)):
            count += 1
            yield raw
        self._lengths[topic] = count

    def _of_topic(self, reader: Any, topic: str, number: int) -> Iterator[Raw]:
        """Yield the messages of a topic, run by run; a reader itself mixes runs, by times."""
        connections = [each for each in reader.connections if each.topic == topic]
        if len(self._runs) == 1:
            for recorded, data in self._whole(reader, connections):
                yield Raw(recorded, number, data)
            return
        index = _index(reader, connections)
        times = [time for time, _ in index]
        for run in self._runs:
            taken: dict[int, int] = {}
            for recorded, data in self._whole(reader, connections):
                nth = taken[recorded] = taken.get(recorded, -1) + 1
                place = index[bisect.bisect_left(times, recorded) + nth][1]
                if run.begin <= place < run.end:
                    yield Raw(recorded + run.shift, number, data)

    def _whole(self, reader: Any, connections: Sequence[Any]) -> Iterator[tuple[int, bytes]]:
        """Yield times, ns, and messages; goes on a second later after what cannot be read."""
        start: int | None = None
        skips, reason, topic = 0, "", connections[0].topic
        while True:
            try:
                for _, recorded, data in reader.messages(connections=connections, start=start):
                    start = recorded + 1
                    yield recorded, bytes(data)
                break
            except Exception as error:  # rosbags raises many kinds of errors of a damaged bag
                start = (start or reader.start_time) + _SKIPPED
                skips += 1
                reason = f"{type(error).__name__}: {error}"
                if start > reader.end_time or skips > _MOST_SKIPS:
                    break
                # Otherwise the reader would take for read what it only began to read.
                reader.close()
                reader.open()
                connections = [each for each in reader.connections if each.topic == topic]
        if skips:
            self._note(f"{topic}: the bag is damaged, {skips} s are missing: {reason}")

    def _found_runs(self) -> list[_ClockRun]:
        """Return the runs of a bag: another one begins where the recorder's clock was set back."""
        if not self.is_of_ros_1:
            return [_WHOLE]
        most = max(self._first.connections, key=lambda each: len(self._first.indexes[each.id]))
        rows = sorted((place, time) for time, place in _index(self._first, [most]))
        times = np.array([time for _, time in rows])
        shifts = clock_shifts(1e-9 * (times - times[0]), [most.id] * len(times))
        runs = [_WHOLE]
        for number in np.flatnonzero(np.diff(shifts)) + 1:
            place, shift = rows[number][0], round(1e9 * shifts[number])
            runs[-1] = runs[-1]._replace(end=place)
            runs.append(_ClockRun(place, _WHOLE.end, shift))
            self._note("the recorder's clock was set back on the way: the time goes on there")
        return runs

    def _mend_index(self) -> None:
        """Read a copy with a good index in place of a bag with none, or a bad one.

        Raises LogError.
        """
        if not self.is_of_ros_1:
            return
        if has_wrong_sizes(self._file.path):
            self._take_copy("its index tells wrong sizes")
            mend_sizes(self._file.path)
        if needs_mending(self._file.path):
            self._take_copy("it was cut short")
            self._mend_cut()

    def _take_copy(self, reason: str) -> None:
        """Go on with a copy of the bag, for a reason; raises LogError."""
        try:
            self._file.take_copy()
        except OSError as error:
            raise LogError(
                f"{self.path}: {reason}, and a copy of it, to read what is whole, cannot "
                f"be made in {tempfile.gettempdir()}: {error.strerror}; TMPDIR names another place"
            ) from None

    def _mend_cut(self) -> None:
        """Give the copy of a bag without an index one; raises LogError."""
        try:
            mended = mend_bag(self._file.path, self.path)
        except BagError as error:
            raise LogError(f"{error}: its recording or copying was cut short") from None
        self._note(
            f"{self.path.name}: its recording or copying was cut short, or it is still being "
            f"recorded: read is what is whole, {mended.torn} bytes at its end are left out"
        )

    def _opened(self) -> Any:
        """Return a new reader that is open; raises LogError."""
        try:
            reader = (Reader1 if self.is_of_ros_1 else Reader2)(self._file.path)
            reader.open()
        except Exception as error:  # rosbags raises many kinds of errors of no bag
            raise LogError(_told(self.path, error)) from None
        self._readers.append(reader)
        return reader

    def _note(self, note: str) -> None:
        if note not in self.notes:
            self.notes.append(note)


def _index(reader: Any, connections: Sequence[Any]) -> list[tuple[int, _Place]]:
    """Return times, ns, and places of messages, as a reader of ROS 1 yields them."""
    entries = heapq.merge(*(reader.indexes[each.id] for each in connections))
    return [(entry.time, (entry.chunk_pos, entry.offset)) for entry in entries]


def _told(path: Path, error: Exception) -> str:
    """Return why a bag cannot be opened, and what to do about it."""
    if isinstance(error, PermissionError):
        return f"{path}: cannot be read: {error.strerror}"
    if isinstance(error, _UNNAMED):
        return _told_unnamed(path, error)
    reason = str(error) or type(error).__name__
    told = f"{path}: expected a whole bag, it cannot be opened: {reason.rstrip('.')}"
    for sign, (form, tool) in _RECOVER.items():
        if sign in reason:
            data = next(path.glob(f"*.{form}"), path) if path.is_dir() else path
            command = tool.format(shlex.quote(str(data)))
            told += f"; if it was cut short, `{command}` saves what is whole"
    return told


def _told_unnamed(path: Path, error: Exception) -> str:
    """Return what to do about a bag in which a reader met what its authors did not foresee."""
    what = f"{type(error).__name__} {error}".strip()
    told = f"{path}: expected a bag as ROS writes it, got what its reader cannot follow ({what})"
    plain = plain_name(path)
    given = shlex.quote(str(path.with_name(plain)))
    if plain != path.name:
        told += "; unpack it first"
    if path.is_dir() or plain.endswith((".db3", ".mcap")):
        return f"{told}; `ros2 bag info {given}` tells whether ROS 2 reads it, else copy it again"
    return (
        f"{told}; `rosbag reindex {given}` of ROS 1 makes its index anew, `rosbag filter {given} "
        "new.bag True` writes what is whole into another bag"
    )
