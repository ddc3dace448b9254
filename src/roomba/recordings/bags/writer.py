"""A bag of ROS 1 that a kill leaves whole: it grows by chunks, each written at once.

What was flushed is in the file, even if the program is killed. Only the index at the end is written
by :meth:`BagWriter.close`; after a kill :mod:`roomba.recordings.bag_format.mending` makes it of the
chunks.
"""

from __future__ import annotations

import fcntl
import os
from pathlib import Path
from typing import Final

from roomba.recordings.bag_format.records import (
    BEGIN,
    MAGIC,
    ChunkInfo,
    MessageSource,
    Op,
    bag_record,
    connection_record,
    index_record,
    message_record,
    record,
    u32,
)

_LARGEST_CHUNK: Final = 1 << 20
"""Bytes from which on a chunk is written before it is flushed."""


class BagWriter:
    """One bag; a context that closes it. Times are in ns, and messages as ROS 1 serializes them."""

    def __init__(self, path: Path) -> None:
        """Begin a bag; raises OSError, FileExistsError where there is a file already."""
        self.path = path
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC
        self._file = os.open(path, flags, 0o600)
        # Who mends a bag sees by this that it is still being written.
        fcntl.flock(self._file, fcntl.LOCK_EX)
        self._sources: dict[MessageSource, int] = {}
        self._infos: list[ChunkInfo] = []
        self._at = 0
        self._clear()
        self._append(MAGIC + bag_record(0, 0, 0))

    def __enter__(self) -> BagWriter:
        """Return it."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    @property
    def size(self) -> int:
        """Bytes that are in the file."""
        return self._at

    def write(self, source: MessageSource, nanoseconds: int, raw: bytes) -> None:
        """Add a message to the chunk that is open; raises OSError."""
        number = self._sources.get(source)
        if number is None:
            number = self._sources[source] = len(self._sources)
            self._put(connection_record(number, source))
        self._entries.setdefault(number, []).append((nanoseconds, self._size))
        self._put(message_record(number, nanoseconds, raw))
        if self._size >= _LARGEST_CHUNK:
            self.flush()

    def flush(self) -> None:
        """Put what was added into the file; raises OSError."""
        if not self._entries:
            return
        chunk = b"".join(self._parts)
        indexes = (index_record(number, rows) for number, rows in self._entries.items())
        fields = {"compression": b"none", "size": u32(len(chunk))}
        times = [time for rows in self._entries.values() for time, _ in rows]
        counts = {number: len(rows) for number, rows in self._entries.items()}
        info = ChunkInfo(self._at, min(times), max(times), counts)
        self._append(record(Op.CHUNK, fields, chunk) + b"".join(indexes))
        self._infos.append(info)
        self._clear()

    def close(self) -> None:
        """Flush, write the index, and close the file; raises OSError."""
        if self._file < 0:
            return
        try:
            self.flush()
            index_at = self._at
            records = [connection_record(each, source) for source, each in self._sources.items()]
            self._append(b"".join((*records, *(info.record() for info in self._infos))))
            header = bag_record(index_at, len(self._sources), len(self._infos))
            os.pwrite(self._file, header, len(MAGIC))
        finally:
            os.close(self._file)
            self._file = -1

    def _put(self, part: bytes) -> None:
        self._parts.append(part)
        self._size += len(part)

    def _clear(self) -> None:
        self._parts: list[bytes] = []
        self._entries: dict[int, list[tuple[int, int]]] = {}
        self._size = 0

    def _append(self, data: bytes) -> None:
        """Write to the end; if the disk becomes full, the part that was written is taken back."""
        at = self._at
        try:
            for begin in range(0, len(data), _LARGEST_CHUNK):
                part = data[begin : begin + _LARGEST_CHUNK]
                while part:
                    written = os.pwrite(self._file, part, at)
                    at, part = at + written, part[written:]
        except OSError:
            os.ftruncate(self._file, self._at)
            raise
        self._at = at


assert len(MAGIC) + len(bag_record(0, 0, 0)) == BEGIN
