"""Which reader a file gets, packed or not; and files that are something else."""

from __future__ import annotations

import bz2
import gzip
import lzma
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from fixtures.drives.made_logs import drive, write_bag, write_bag_2, write_carmen

from roomba.recordings.bag import BagLog
from roomba.recordings.carmen.log import CarmenLog
from roomba.recordings.drives.opening import is_relations, open_log
from roomba.recordings.readings import LogError

RELATION = "976052857.3 976052890.1 1.5 -0.25 0.0 0.0 0.0 0.31\n"


@pytest.mark.parametrize(
    ("suffix", "packed"),
    [(".gz", gzip.compress), (".xz", lzma.compress), (".bz2", bz2.compress), ("", bytes)],
)
@pytest.mark.parametrize("name", ["made.bag", "made.log", "made.clf"])
def test_logs_are_read_packed_or_not(
    tmp_path: Path, suffix: str, packed: Callable[[bytes], bytes], name: str
) -> None:
    write = write_bag if name.endswith(".bag") else write_carmen
    plain = write(tmp_path / name, drive(1.0))
    path = tmp_path / f"packed_{name}{suffix}"
    path.write_bytes(packed(plain.read_bytes()))
    log = open_log(path)
    assert isinstance(log, BagLog if name.endswith(".bag") else CarmenLog)
    assert log.path == path
    assert log.channels
    log.close()


def test_a_folder_and_its_metadata_are_the_same_bag(tmp_path: Path) -> None:
    folder = write_bag_2(tmp_path / "made", drive(1.0))
    for path in (folder, folder / "metadata.yaml"):
        log = open_log(path)
        assert log.path == folder
        assert {each.name for each in log.channels} == {"/scan", "/odom", "/tf_static"}
        log.close()


@pytest.mark.parametrize("packed", [bytes, lzma.compress])
def test_the_truth_given_as_a_log_is_told_what_it_is_for(
    tmp_path: Path, packed: Callable[[bytes], bytes]
) -> None:
    path = tmp_path / "made.relations"
    path.write_bytes(packed((RELATION * 40).encode()))
    with pytest.raises(LogError, match="got relations, the truth that maps are judged by"):
        open_log(path)


def test_relations_are_known_by_their_eight_numbers() -> None:
    assert is_relations(f"# t1 t2 x y z\n{RELATION}".encode())
    assert is_relations(f"{RELATION}976052857.3 97605".encode())
    assert not is_relations(b"FLASER 2 1.0 2.0 0 0 0 0\n")
    assert not is_relations(b"# nothing\n")
    assert not is_relations(b"1 2 3 4 5 6 7\n")


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("none.bag", None, "no such file; expected a bag or a log"),
        ("empty.bag", b"", "the file is empty"),
        ("made.mcap", b"#ROSBAG V2.0\n", "expected a name that ends with .bag"),
        ("picture.png", b"\x89PNG\r\n\x1a\n\0\0", "expected a bag of ROS 1 or 2, or a CARMEN log"),
        ("cut.log.xz", lzma.compress(b"FLASER 1 2\n" * 9000)[:-30], "cannot be"),
        ("cut.log.bz2", bz2.compress(b"FLASER 1 2\n" * 9000)[:-30], "cannot be"),
        ("a log.zip", b"PK\x03\x04\x14\0", "that zip packed; unpack it: unzip '.*a log.zip'"),
        ("made.log.zst", b"\x28\xb5\x2f\xfd\0", "that zstd packed; unpack it: unzstd .*.zst"),
        ("old.bag", b"#ROSBAG V1.2\n", r"an old one of version 1\.2; `rosbag filter .*old.bag new"),
        ("old.bag", b"#ROSRECORD V1.2\n\0\0", r"version 1\.2; .*`rosbag fix`"),
        ("new.bag", b"#ROSBAG V3.0\n", "version 300 is not supported"),
        (
            "cells.dat",
            b"589923412 1 2 3\n589923500 1 2 3\n",
            "lines that begin with numbers, as 5899",
        ),
        ("half.log", b"1.5 2\nTo be\n2.5 1\n", "of a CARMEN log, got lines that begin with num"),
        ("words.log", b"To be or not\n", "of a CARMEN log, got none"),
    ],
)
def test_what_is_no_log_is_refused_with_the_reason(
    tmp_path: Path, name: str, data: bytes | None, said: str
) -> None:
    path = tmp_path / name
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(LogError, match=said) as refusal:
        open_log(path)
    assert str(path) in str(refusal.value)


def test_a_pipe_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "made.log")
    with pytest.raises(LogError, match="expected a file, got a pipe or a device"):
        open_log(tmp_path / "made.log")


def test_a_folder_without_metadata_is_no_bag(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"the folder has no metadata\.yaml"):
        open_log(tmp_path)
