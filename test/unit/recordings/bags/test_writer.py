"""Other programs read the bags that are written here, also after a kill."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Reader
from rosbags.typesys import Stores, get_typestore

from roomba.recordings.bag_format.mending import mend_bag, needs_mending
from roomba.recordings.bag_format.records import MessageSource
from roomba.recordings.bags.writer import BagWriter

TEXT = MessageSource(
    "/text", "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n", "/a"
)
LATCHED = MessageSource(
    "/number", "std_msgs/Float32", "73fcbf46b49191e672908e50842a83d4", "float32 data\n", "/b", True
)
STORE = get_typestore(Stores.ROS1_NOETIC)
BEGAN = 1_700_000_000_000_000_000


def text(said: str) -> bytes:
    return len(said).to_bytes(4, "little") + said.encode()


def number(value: float) -> bytes:
    return np.float32(value).tobytes()


def fill(bag: BagWriter, count: int, *, flush_every: int = 10) -> list[tuple[str, int, str]]:
    """Write messages of two topics; return topic, time and value of each."""
    wrote = []
    for each in range(count):
        time = BEGAN + each * 100_000_000
        bag.write(TEXT, time, text(f"message {each}"))
        wrote.append(("/text", time, f"message {each}"))
        if each % 7 == 0:
            bag.write(LATCHED, time + 1, number(each))
            wrote.append(("/number", time + 1, str(float(each))))
        if each % flush_every == flush_every - 1:
            bag.flush()
    return wrote


def read(path: Path) -> list[tuple[str, int, str]]:
    with AnyReader([path]) as reader:
        return [
            (connection.topic, time, str(reader.deserialize(raw, connection.msgtype).data))  # type: ignore[attr-defined]
            for connection, time, raw in reader.messages()
        ]


def test_what_is_written_is_read(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "a.bag") as bag:
        wrote = fill(bag, 95)
    assert not needs_mending(tmp_path / "a.bag")
    assert read(tmp_path / "a.bag") == wrote
    with Reader(tmp_path / "a.bag") as reader:
        latching = {each.topic: each.ext.latching for each in reader.connections}  # type: ignore[union-attr]
        assert latching == {"/text": 0, "/number": 1}
        assert {each.topic: each.msgdef.data for each in reader.connections} == {
            "/text": "string data\n",
            "/number": "float32 data\n",
        }
        assert len(reader.chunk_infos) == 10


def test_an_existing_file_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "a.bag").write_text("mine")
    with pytest.raises(FileExistsError):
        BagWriter(tmp_path / "a.bag")
    assert (tmp_path / "a.bag").read_text() == "mine"


def test_a_full_disk_leaves_what_was_whole(tmp_path: Path) -> None:
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    bag = BagWriter(tmp_path / "a.bag")
    wrote = fill(bag, 50)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (bag.size + 1000, before[1]))
        bag.write(TEXT, BEGAN, text("x" * 5000))
        with pytest.raises(OSError, match="File too large"):
            bag.flush()
        with pytest.raises(OSError, match="File too large"):
            bag.close()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, ignored)
    assert mend_bag(tmp_path / "a.bag").torn == 0
    assert read(tmp_path / "a.bag") == wrote


KILLED = """
import sys, time
from pathlib import Path
from roomba.recordings.bag_format.records import MessageSource
from roomba.recordings.bags.writer import BagWriter
md5 = "992ce8a1687cec8c8bd883ec73ca41d1"
source = MessageSource("/text", "std_msgs/String", md5, "string data\\n")
bag = BagWriter(Path(sys.argv[1]))
for each in range(1_000_000):
    said = str(each).encode()
    bag.write(source, 1 + each, len(said).to_bytes(4, "little") + said)
    if each % 100 == 99:
        bag.flush()
        print(each, flush=True)
"""


def test_a_killed_writer_loses_nothing_that_it_flushed(tmp_path: Path) -> None:
    path = tmp_path / "killed.bag"
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, str(path)], stdout=subprocess.PIPE, text=True
    ) as program:
        assert program.stdout is not None
        told = [int(program.stdout.readline()) for _ in range(20)]
        os.kill(program.pid, signal.SIGKILL)
        told += [int(line) for line in program.stdout if line.endswith("\n")]
    mend_bag(path)
    said = [int(each[2]) for each in read(path)]
    assert said == list(range(len(said)))
    assert said[-1] >= told[-1] >= 1999
