"""The index of a bag that was cut short, made of its chunks: its recorder was killed, or its copy
was not whole. The torn part of the last chunk is cut off."""

from __future__ import annotations

import bz2
import fcntl
import io
import os
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Final

import lz4.frame

from roomba.errors import RoombaError
from roomba.recordings.bag_format.records import (
    MAGIC,
    ChunkInfo,
    Op,
    bag_record,
    index_record,
    nanoseconds_of,
    parsed_fields,
    record,
    u32,
)

_LARGEST: Final = 1 << 30
"""Bytes of a record; larger ones are torn."""
_UNPACKED: Final[dict[bytes, Callable[[bytes], bytes]]] = {
    b"none": bytes,
    b"bz2": bz2.decompress,
    b"lz4": lz4.frame.decompress,
}
"""Functions that unpack a chunk's data, by its field ``compression``; rosbags brings lz4."""
_BROKEN: Final = (
    LookupError,
    ValueError,
    ArithmeticError,
    OSError,
    RuntimeError,
    MemoryError,
    struct.error,
)
"""Errors that readers raise for a chunk that is broken within."""


class BagError(RoombaError):
    """A bag that cannot be mended; the message says what was expected, and came."""


@dataclass(frozen=True, slots=True)
class Mended:
    """How many chunks and messages a mended bag has, and how many bytes its torn end had."""

    chunks: int
    messages: int
    torn: int


@dataclass(frozen=True, slots=True)
class _Record:
    """A record: where it begins and ends, its kind, fields and data."""

    begin: int
    end: int
    op: int
    fields: dict[str, bytes]
    data: bytes


@dataclass(frozen=True, slots=True)
class _Content:
    """What a chunk has: times, ns, and offsets of messages by their connection, and records of
    connections; ``size`` is how many bytes these are, unpacked.
    """

    entries: dict[int, list[tuple[int, int]]]
    connections: dict[int, bytes]
    size: int

    def indexes(self) -> bytes:
        """Return the records that come after the chunk."""
        return b"".join(index_record(number, rows) for number, rows in self.entries.items())

    def info(self, at: int) -> ChunkInfo:
        """Return what the bag's index says of the chunk, which begins at a byte of the file."""
        times = [time for rows in self.entries.values() for time, _ in rows]
        counts = {number: len(rows) for number, rows in self.entries.items()}
        return ChunkInfo(at, min(times), max(times), counts)


class _WholeChunks:
    """The chunks of a bag that are whole, and where the last of them and its index end.

    A chunk that is broken within stays in the file, but the index does not name it. The connections
    that it tells before the break count for the chunks that follow.
    """

    def __init__(self, file: BinaryIO) -> None:
        """Go through the file."""
        self.infos: list[ChunkInfo] = []
        self.connections: dict[int, bytes] = {}
        self.end = 0
        chunk: tuple[int, _Content] | None = None
        wanted = 0
        for each in _records(file):
            if each.op == Op.CHUNK:
                content, is_whole = _content_of(each)
                chunk = (each.begin, content) if is_whole else None
                wanted = len(content.entries) if is_whole else 0
                self.connections = content.connections | self.connections
            elif each.op == Op.INDEX:
                wanted -= 1
            elif each.op != Op.BAG:
                break
            if wanted > 0:
                continue
            if chunk is not None:
                self.add(*chunk)
            chunk, self.end = None, each.end

    def add(self, at: int, content: _Content) -> None:
        """Count a chunk that begins at a byte of the file."""
        self.infos.append(content.info(at))
        self.connections = content.connections | self.connections

    @property
    def messages(self) -> int:
        """How many messages of known connections the chunks have."""
        return sum(
            count
            for info in self.infos
            for number, count in info.counts.items()
            if number in self.connections
        )


def needs_mending(path: Path) -> bool:
    """Whether a file is a bag of ROS 1 whose index is missing, or not whole."""
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            return False
        first = next(_records(file), None)
        if first is None or "index_pos" not in first.fields:
            return False
        at, connections, chunks = (
            int.from_bytes(first.fields.get(name, b""), "little")
            for name in ("index_pos", "conn_count", "chunk_count")
        )
        if not 0 < at <= os.fstat(file.fileno()).st_size:
            return True
        file.seek(at)
        return sum(1 for _ in _records(file)) < connections + chunks


def mend_bag(path: Path, named: Path | None = None) -> Mended:
    """Give a bag its index; raises BagError if that is impossible, OSError if it cannot write.

    Whole messages of a chunk that is torn are kept, unless it is packed. Errors call the bag
    ``named``, the one that it is a copy of.
    """
    name = named or path
    with path.open("r+b") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise BagError(f"{name}: it is still being recorded; end that first") from error
        if file.read(len(MAGIC)) != MAGIC:
            raise BagError(f"{name}: expected a bag of ROS 1, version 2.0")
        chunks = _WholeChunks(file)
        end, torn = chunks.end, os.fstat(file.fileno()).st_size - chunks.end
        last = _torn_chunk(file, end)
        if last is not None:
            content, chunk = last
            torn -= len(chunk)
            chunks.add(end, content)
        if not chunks.messages:
            raise BagError(f"{name}: expected a recording, it has no whole message")
        file.seek(end)
        file.truncate()
        if last is not None:
            file.write(chunk + content.indexes())
        index_at = file.tell()
        index = (*chunks.connections.values(), *(info.record() for info in chunks.infos))
        file.write(b"".join(index))
        file.flush()
        file.seek(len(MAGIC))
        file.write(bag_record(index_at, len(chunks.connections), len(chunks.infos)))
    return Mended(len(chunks.infos), chunks.messages, torn)


def _content_of(chunk: _Record) -> tuple[_Content, bool]:
    """Return what a chunk has, up to where it is broken within, and whether it is whole."""
    try:
        plain = _UNPACKED[chunk.fields["compression"]](chunk.data)
    except _BROKEN:
        return _Content({}, {}, 0), False
    content = _looked_into(plain)
    return content, content.size == len(plain) and bool(content.entries)


def _torn_chunk(file: BinaryIO, at: int) -> tuple[_Content, bytes] | None:
    """Return what is whole of a chunk that has no whole index, and its record.

    None if there is no such chunk, or nothing whole in it.
    """
    file.seek(at)
    header, told = _sized(file), file.read(4)
    try:
        fields = parsed_fields(header or b"")
        if fields["op"][0] != Op.CHUNK:
            return None
        data = file.read(min(int.from_bytes(told, "little"), _LARGEST))
        content = _looked_into(_UNPACKED[fields["compression"]](data))
    except _BROKEN:
        return None
    if not content.entries:
        return None
    if fields["compression"] == b"none":
        data = data[: content.size]
    told_of = {**_without_op(fields), "size": u32(content.size)}
    return content, record(Op.CHUNK, told_of, data)


def _looked_into(plain: bytes) -> _Content:
    """Return what the plain data of a chunk has, up to the first record that is not whole."""
    entries: dict[int, list[tuple[int, int]]] = {}
    connections: dict[int, bytes] = {}
    size = 0
    for each in _records(io.BytesIO(plain)):
        try:
            number = int.from_bytes(each.fields["conn"], "little")
            if each.op == Op.CONNECTION:
                connections[number] = record(Op.CONNECTION, _without_op(each.fields), each.data)
            else:
                time = nanoseconds_of(each.fields["time"])
                entries.setdefault(number, []).append((time, each.begin))
        except _BROKEN:
            break
        size = each.end
    return _Content(entries, connections, size)


def _without_op(fields: dict[str, bytes]) -> dict[str, bytes]:
    return {name: value for name, value in fields.items() if name != "op"}


def _records(file: BinaryIO) -> Iterator[_Record]:
    """Yield the records from here on, up to the first that is not whole."""
    while True:
        begin = file.tell()
        header, data = _sized(file), _sized(file)
        if header is None or data is None:
            return
        try:
            fields = parsed_fields(header)
            op = fields["op"][0]
        except (ValueError, KeyError, IndexError):
            return
        yield _Record(begin, file.tell(), op, fields, data)


def _sized(file: BinaryIO) -> bytes | None:
    """Return the bytes that follow their size; None where they are not all there."""
    told = file.read(4)
    size = int.from_bytes(told, "little")
    if len(told) < 4 or size > _LARGEST:
        return None
    data = file.read(size)
    return data if len(data) == size else None
