"""The index of a bag whose recorder was killed, made of its chunks; a torn end is cut off."""

from __future__ import annotations

import fcntl
import io
import os
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Final

from roomba.recordings.bags.records import (
    MAGIC,
    ChunkInfo,
    Op,
    bag_record,
    nanoseconds_of,
    parsed_fields,
    record,
)
from roomba.recordings.readings import LogError

_LARGEST: Final = 1 << 30
"""Bytes of a record; larger ones are torn."""


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


def needs_mending(path: Path) -> bool:
    """Whether a file is a bag of ROS 1 without an index."""
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            return False
        first = next(_records(file), None)
    return first is not None and int.from_bytes(first.fields.get("index_pos", b"\1"), "little") == 0


def mend_bag(path: Path) -> Mended:
    """Give a bag its index; raises LogError if it cannot be mended, OSError if not be written.

    Chunks must not be packed, as :class:`roomba.recordings.bags.writer.BagWriter` writes them.
    """
    with path.open("r+b") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise LogError(f"{path}: it is still being recorded; end that first") from error
        if file.read(len(MAGIC)) != MAGIC:
            raise LogError(f"{path}: expected a bag of ROS 1, version 2.0")
        infos, connections, end = _scanned(path, file)
        torn = os.fstat(file.fileno()).st_size - end
        file.truncate(end)
        file.seek(end)
        file.write(b"".join((*connections.values(), *(info.record() for info in infos))))
        file.flush()
        file.seek(len(MAGIC))
        file.write(bag_record(end, len(connections), len(infos)))
    messages = sum(sum(info.counts.values()) for info in infos)
    return Mended(len(infos), messages, torn)


def _scanned(path: Path, file: BinaryIO) -> tuple[list[ChunkInfo], dict[int, bytes], int]:
    """Return chunks, connections, and where the last whole chunk with its index ends."""
    infos: list[ChunkInfo] = []
    connections: dict[int, bytes] = {}
    end, wanted = 0, 0
    for each in _records(file):
        if each.op == Op.BAG:
            end = each.end
        elif each.op == Op.CHUNK:
            if each.fields.get("compression") != b"none":
                raise LogError(
                    f"{path}: its chunks are packed; mend it by "
                    f"`./roomba exec rosbag reindex {path}`"
                )
            try:
                info, found = _looked_into(each)
            except (KeyError, ValueError, struct.error):
                break  # what is broken within is cut off with all after it
            connections = found | connections
            wanted = len(info.counts)
            infos.append(info)
        elif each.op == Op.INDEX:
            wanted -= 1
            end = each.end if wanted == 0 else end
        else:
            break
    if wanted:
        # Its index is torn, which readers need: it is not counted.
        infos.pop()
    if not infos:
        raise LogError(f"{path}: expected a recording, it has no whole chunk")
    return infos, connections, end


def _looked_into(chunk: _Record) -> tuple[ChunkInfo, dict[int, bytes]]:
    """Return what a chunk has, and the connections that it tells of, as records."""
    counts: dict[int, int] = {}
    connections: dict[int, bytes] = {}
    times: list[int] = []
    for each in _records_in(chunk.data):
        number = int.from_bytes(each.fields["conn"], "little")
        if each.op == Op.CONNECTION:
            kept = {name: value for name, value in each.fields.items() if name != "op"}
            connections[number] = record(Op.CONNECTION, kept, each.data)
        else:
            counts[number] = counts.get(number, 0) + 1
            times.append(nanoseconds_of(each.fields["time"]))
    return ChunkInfo(chunk.begin, min(times), max(times), counts), connections


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
    """Return the bytes that a size stands before; None where they are not all there."""
    told = file.read(4)
    size = int.from_bytes(told, "little")
    if len(told) < 4 or size > _LARGEST:
        return None
    data = file.read(size)
    return data if len(data) == size else None


def _records_in(chunk: bytes) -> Iterator[_Record]:
    """Yield the records of a chunk."""
    yield from _records(io.BytesIO(chunk))
