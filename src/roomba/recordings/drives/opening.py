"""Which reader a file needs, by what is in it."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Final

from roomba.recordings.carmen.lines import is_number
from roomba.recordings.carmen.log import CarmenLog
from roomba.recordings.log import Log
from roomba.recordings.packed import head_of, plain_name
from roomba.recordings.readings import LogError

_HEAD: Final = 1 << 16
"""Bytes by which a file is known."""
_MAGIC: Final = {b"#ROSBAG V": ".bag", b"\x89MCAP": ".mcap", b"SQLite format 3": ".db3"}
"""How bags begin, and what their names must end with."""
_OLD: Final = (b"#ROSRECORD V", b"#ROSBAG V1.")
"""How bags begin that are older than version 2.0: those of before 2010."""
_ARCHIVES: Final = {b"PK\x03\x04": ("zip", "unzip"), b"\x28\xb5\x2f\xfd": ("zstd", "unzstd")}
"""How files begin that are not unpacked here: which program packed them, and which unpacks them."""
_RELATION: Final = 8
"""Numbers in a line of a file of relations."""


def open_log(path: Path) -> Log:
    """Return a log that is open for reading; raises LogError."""
    path = path.parent if path.name == "metadata.yaml" else path
    if path.is_dir():
        if not (path / "metadata.yaml").is_file():
            raise LogError(
                f"{path}: expected a bag of ROS 2, the folder has no metadata.yaml; name a "
                "bag in it"
            )
        return _bag(path)
    head = head_of(path, _HEAD)
    if not head:
        raise LogError(f"{path}: expected a bag or a log, the file is empty")
    if head.startswith(_OLD):
        raise LogError(_told_old(path, head))
    for magic, suffix in _MAGIC.items():
        if head.startswith(magic):
            if not plain_name(path).endswith(suffix):
                raise LogError(f"{path}: expected a name that ends with {suffix}; rename it")
            return _bag(path)
    for magic, (packer, unpacker) in _ARCHIVES.items():
        if head.startswith(magic):
            raise LogError(
                f"{path}: expected a bag or a log, got a file that {packer} packed; unpack it: "
                f"{unpacker} {shlex.quote(str(path))}"
            )
    if b"\0" in head:
        raise LogError(f"{path}: expected a bag of ROS 1 or 2, or a CARMEN log, got something else")
    if is_relations(head):
        raise LogError(
            f"{path}: expected a recorded drive, got relations, the truth that maps are judged by: "
            "name the log beside it; ./roomba bench slam --logs FOLDER compares the two"
        )
    return CarmenLog(path)


def is_relations(head: bytes) -> bool:
    """Whether a text is one of relations: lines of two times, a translation and a rotation."""
    lines = head.decode("utf-8", errors="replace").split("\n")
    # The last line may be cut off; of a whole text nothing is left after the last line's end.
    words = [line.split() for line in (lines[:-1] or lines) if line.strip()]
    rows = [row for row in words if not row[0].startswith("#")]
    return bool(rows) and all(len(row) == _RELATION and all(map(is_number, row)) for row in rows)


def _told_old(path: Path, head: bytes) -> str:
    """Return the refusal of an old bag, with what converts it: only ``rosbag`` reads it."""
    version = head.split(b"\n", 1)[0].rpartition(b"V")[2][:8].decode(errors="replace").strip()
    return (
        f"{path}: expected a bag of ROS 1, version 2.0, got an old one of version {version}; "
        f"`rosbag filter {shlex.quote(str(path))} new.bag True` of ROS 1 writes it anew, and where "
        "that refuses it `rosbag fix`"
    )


def _bag(path: Path) -> Log:
    # Imported here: the types of all messages take half a second, which a text does not need.
    from roomba.recordings.bag import BagLog

    return BagLog(path)
