"""The records of a bag of ROS 1, version 2.0, as http://wiki.ros.org/Bags/Format/2.0 has them."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

MAGIC: Final = b"#ROSBAG V2.0\n"
HEADER_SIZE: Final = 4096
"""Bytes of the first record, which is filled up with spaces: so it can be written anew in place."""
BEGIN: Final = len(MAGIC) + HEADER_SIZE
"""Where the first chunk is."""
_U32: Final = struct.Struct("<I")
_U64: Final = struct.Struct("<Q")
_TIME: Final = struct.Struct("<II")


class Op(IntEnum):
    """What a record is."""

    MESSAGE = 2
    BAG = 3
    INDEX = 4
    CHUNK = 5
    CHUNK_INFO = 6
    CONNECTION = 7


@dataclass(frozen=True, slots=True)
class MessageSource:
    """Where messages come from: a topic of a node, and the type of its messages."""

    topic: str
    type: str
    md5: str
    definition: str
    node: str = ""
    is_latched: bool = False


def u32(value: int) -> bytes:
    """Return a number as four bytes."""
    return _U32.pack(value)


def u64(value: int) -> bytes:
    """Return a number as eight bytes."""
    return _U64.pack(value)


def time_of(nanoseconds: int) -> bytes:
    """Return a time."""
    return _TIME.pack(*divmod(nanoseconds, 1_000_000_000))


def nanoseconds_of(time: bytes) -> int:
    """Return the nanoseconds of a time."""
    seconds, rest = _TIME.unpack(time)
    return int(seconds) * 1_000_000_000 + int(rest)


def record(op: Op, fields: Mapping[str, bytes], data: bytes = b"") -> bytes:
    """Return a record of one kind with its fields and its data."""
    header = fields_of({"op": bytes([op]), **fields})
    return b"".join((u32(len(header)), header, u32(len(data)), data))


def fields_of(fields: Mapping[str, bytes]) -> bytes:
    """Return fields as a header has them."""
    parts = (b"%s=%s" % (name.encode(), value) for name, value in fields.items())
    return b"".join(u32(len(part)) + part for part in parts)


def parsed_fields(header: bytes) -> dict[str, bytes]:
    """Return the fields of a header; raises ValueError for a broken one."""
    fields: dict[str, bytes] = {}
    at = 0
    while at < len(header):
        if at + 4 > len(header):
            raise ValueError("a header that ends within a field")
        (size,) = _U32.unpack_from(header, at)
        name, sign, value = header[at + 4 : at + 4 + size].partition(b"=")
        if not sign or at + 4 + size > len(header):
            raise ValueError("a field without a name, or cut off")
        fields[name.decode()] = value
        at += 4 + size
    return fields


def bag_record(index_at: int, connections: int, chunks: int) -> bytes:
    """Return the first record; ``index_at`` is 0 while there is no index."""
    fields = {
        "index_pos": u64(index_at),
        "conn_count": u32(connections),
        "chunk_count": u32(chunks),
    }
    bare = record(Op.BAG, fields)
    return record(Op.BAG, fields, b" " * (HEADER_SIZE - len(bare)))


def connection_record(number: int, source: MessageSource) -> bytes:
    """Return the record of a source of messages."""
    topic = source.topic.encode()
    data = {
        "topic": topic,
        "type": source.type.encode(),
        "md5sum": source.md5.encode(),
        "message_definition": source.definition.encode(),
        "callerid": source.node.encode(),
        "latching": b"1" if source.is_latched else b"0",
    }
    return record(Op.CONNECTION, {"conn": u32(number), "topic": topic}, fields_of(data))


def message_record(number: int, nanoseconds: int, raw: bytes) -> bytes:
    """Return the record of a message, of the connection of that number."""
    return record(Op.MESSAGE, {"conn": u32(number), "time": time_of(nanoseconds)}, raw)


def index_record(number: int, entries: list[tuple[int, int]]) -> bytes:
    """Return where the messages of a connection are in the chunk before: times, ns, and offsets."""
    fields = {"ver": u32(1), "conn": u32(number), "count": u32(len(entries))}
    data = b"".join(time_of(time) + u32(offset) for time, offset in entries)
    return record(Op.INDEX, fields, data)


@dataclass(frozen=True, slots=True)
class ChunkInfo:
    """Where a chunk is, between which times, ns, and how many messages of each connection."""

    at: int
    begin: int
    end: int
    counts: dict[int, int]

    def record(self) -> bytes:
        """Return it as the index at the end of a bag has it."""
        fields = {
            "ver": u32(1),
            "chunk_pos": u64(self.at),
            "start_time": time_of(self.begin),
            "end_time": time_of(self.end),
            "count": u32(len(self.counts)),
        }
        data = b"".join(u32(number) + u32(count) for number, count in self.counts.items())
        return record(Op.CHUNK_INFO, fields, data)
