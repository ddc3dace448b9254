"""The sizes that records of an index tell, put right.

Programs of 2010 told 20 bytes for each message in a chunk's index, and wrote 12. The tools of ROS
go by the number of messages; other readers take what follows for a part of the index.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Final, NamedTuple

from roomba.recordings.bag_format.records import MAGIC, Op, parsed_fields, u32

_ENTRY: Final = 12
"""Bytes of each message in an index: its time and where it is."""


class _ToldSize(NamedTuple):
    """Where a record of an index tells its size, the size that it tells, and the true one."""

    at: int
    told: int
    true: int


def has_wrong_sizes(path: Path) -> bool:
    """Whether the first index of a chunk tells a wrong size: one program wrote them all."""
    with path.open("rb") as file:
        first = next(_sizes(file), None)
    return first is not None and first.told != first.true


def mend_sizes(path: Path) -> int:
    """Write the true sizes into a bag, and return how many were wrong; raises OSError."""
    with path.open("r+b") as file:
        wrong = [each for each in _sizes(file) if each.told != each.true]
        for each in wrong:
            file.seek(each.at)
            file.write(u32(each.true))
    return len(wrong)


def _sizes(file: BinaryIO) -> Iterator[_ToldSize]:
    """Yield the sizes of the indexes of chunks, up to what is not whole."""
    end = os.fstat(file.fileno()).st_size
    if file.read(len(MAGIC)) != MAGIC:
        return
    while True:
        header = file.read(_number(file))
        at, size = file.tell(), _number(file)
        try:
            fields = parsed_fields(header)
            op = fields["op"][0]
            if op == Op.INDEX:
                true = _ENTRY * int.from_bytes(fields["count"], "little")
                yield _ToldSize(at, size, true)
                size = true
        except (ValueError, LookupError):
            return
        if at + size >= end:
            return
        file.seek(at + 4 + size)


def _number(file: BinaryIO) -> int:
    return int.from_bytes(file.read(4), "little")
