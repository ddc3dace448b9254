"""A bag that was cut short, anywhere, has all messages that are whole again, packed or not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

from roomba.recordings.bag_format.mending import BagError, mend_bag, needs_mending
from roomba.recordings.bag_format.records import BEGIN, MAGIC, MessageSource
from roomba.recordings.bags.writer import BagWriter

STORE = get_typestore(Stores.ROS1_NOETIC)
TEXT = MessageSource(
    "/text", "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n", "/a"
)
OTHER = MessageSource(
    "/other", "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n", "/b"
)
CHUNK = 10
"""Messages of a chunk."""

Said = tuple[str, int, str]
"""Topic, time, ns, and text."""


def said(count: int) -> list[Said]:
    return [("/other" if n % 3 == 1 else "/text", 1000 + n, f"message {n}") for n in range(count)]


def unfinished(path: Path, count: int) -> list[Said]:
    """Write a bag as a killed recorder leaves it; return what it has."""
    bag = BagWriter(path.with_suffix(".open"))
    for number, (topic, time, text) in enumerate(said(count), 1):
        raw = len(text).to_bytes(4, "little") + text.encode()
        bag.write(TEXT if topic == "/text" else OTHER, time, raw)
        if number % CHUNK == 0:
            bag.flush()
    path.write_bytes(bag.path.read_bytes())
    bag.close()
    return said(count)


def finished(path: Path, count: int, packed: Writer.CompressionFormat | None) -> list[Said]:
    """Write a whole bag by rosbags; return what it has."""
    writer = Writer(path)
    if packed is not None:
        writer.set_compression(packed)
    writer.chunk_threshold = 500
    with writer:
        connections: dict[str, Any] = {}
        for topic, time, text in said(count):
            if topic not in connections:
                connections[topic] = writer.add_connection(
                    topic, "std_msgs/msg/String", typestore=STORE
                )
            message = STORE.types["std_msgs/msg/String"](data=text)
            raw = STORE.serialize_ros1(message, "std_msgs/msg/String")
            writer.write(connections[topic], time, raw)
    return said(count)


def read(path: Path) -> list[Said]:
    with AnyReader([path]) as reader:
        return [
            (connection.topic, time, str(reader.deserialize(raw, connection.msgtype).data))  # type: ignore[attr-defined]
            for connection, time, raw in reader.messages()
        ]


def cut(path: Path, size: int) -> Path:
    """Return a copy that has the first bytes alone."""
    copy = path.with_name("cut.bag")
    copy.write_bytes(path.read_bytes()[:size])
    return copy


@given(share=st.floats(0.0, 1.0))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_of_a_bag_that_is_cut_anywhere_all_whole_messages_are_kept(
    tmp_path: Path, share: float
) -> None:
    path = tmp_path / "whole.bag"
    wrote = said(95) if path.exists() else finished(path, 95, None)
    data = path.read_bytes()
    at = BEGIN + round(share * (len(data) - BEGIN))
    whole = [each for each in wrote if 0 < data.find(each[2].encode()) <= at - len(each[2])]
    copy = cut(path, at)
    if not whole:
        with pytest.raises(BagError, match="no whole message"):
            mend_bag(copy)
        return
    assert needs_mending(copy) is (at < len(data))
    if at < len(data):
        assert mend_bag(copy).messages == len(whole)
    assert not needs_mending(copy)
    assert read(copy) == whole


@pytest.mark.parametrize("packed", list(Writer.CompressionFormat))
def test_of_a_bag_whose_chunks_are_packed_whole_chunks_are_kept(
    tmp_path: Path, packed: Writer.CompressionFormat
) -> None:
    wrote = finished(tmp_path / "whole.bag", 95, packed)
    copy = cut(tmp_path / "whole.bag", round(0.5 * (tmp_path / "whole.bag").stat().st_size))
    assert needs_mending(copy)
    mended = mend_bag(copy)
    kept = read(copy)
    assert kept == wrote[: len(kept)]
    assert mended.messages == len(kept) > 20
    assert mended.torn > 0


@pytest.mark.parametrize("lost", [0, 1, 37, 200])
def test_a_chunk_whose_index_is_torn_is_kept(tmp_path: Path, lost: int) -> None:
    wrote = unfinished(tmp_path / "a.bag", 50)
    copy = cut(tmp_path / "a.bag", (tmp_path / "a.bag").stat().st_size - lost)
    assert needs_mending(copy)
    mended = mend_bag(copy)
    assert read(copy) == wrote
    assert (mended.messages, mended.chunks) == (50, 5)
    assert not needs_mending(copy)


@pytest.mark.parametrize("broken", [0, 2])
def test_a_chunk_that_is_broken_within_is_left_out_and_what_follows_is_kept(
    tmp_path: Path, broken: int
) -> None:
    path = tmp_path / "a.bag"
    wrote = unfinished(path, 50)
    whole = bytearray(path.read_bytes())
    chunk = [each for each in range(len(whole)) if whole.startswith(b"op=\x05", each)][broken]
    # Its last message: the connections of both topics are before that.
    at = whole.index(f"message {CHUNK * (broken + 1) - 1}".encode(), chunk)
    at = whole.rindex(b"conn=", chunk, at)
    whole[at : at + 5] = b"cann="
    path.write_bytes(whole)
    mended = mend_bag(path)
    assert mended.chunks == 4
    kept = read(path)
    assert kept == wrote[: broken * CHUNK] + wrote[(broken + 1) * CHUNK :]
    assert mended.messages == len(kept)


def test_messages_of_which_no_connection_is_known_do_not_count(tmp_path: Path) -> None:
    path = tmp_path / "a.bag"
    unfinished(path, 50)
    whole = bytearray(path.read_bytes())
    # The first record of the first chunk: with it both connections are gone.
    at = whole.index(b"conn=", whole.index(b"op=\x05"))
    whole[at : at + 5] = b"cann="
    path.write_bytes(whole)
    with pytest.raises(BagError, match="no whole message"):
        mend_bag(path)
    assert path.read_bytes() == whole


def test_a_place_of_the_index_that_is_none_is_mended(tmp_path: Path) -> None:
    path = tmp_path / "a.bag"
    wrote = finished(path, 30, None)
    data = path.read_bytes()
    at = data.index(b"index_pos=") + len(b"index_pos=")
    path.write_bytes(data[:at] + b"\xff" * 8 + data[at + 8 :])
    assert needs_mending(path)
    mend_bag(path)
    assert read(path) == wrote


def test_what_is_still_written_is_not_mended(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "a.bag") as bag:
        bag.write(TEXT, 1, b"\1\0\0\0a")
        bag.flush()
        with pytest.raises(BagError, match="still being recorded"):
            mend_bag(tmp_path / "a.bag")
    assert read(tmp_path / "a.bag") == [("/text", 1, "a")]


def test_what_is_no_recording_is_refused(tmp_path: Path) -> None:
    other, empty = tmp_path / "other", tmp_path / "empty.bag"
    other.write_bytes(b"something else")
    assert not needs_mending(other)
    with pytest.raises(BagError, match=r"expected a bag of ROS 1"):
        mend_bag(other)
    empty.write_bytes(MAGIC)
    with pytest.raises(BagError, match="no whole message"):
        mend_bag(empty)
