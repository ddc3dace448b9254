"""The ring keeps the newest messages within its time and memory, and those sent only once."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from rosbags.rosbag1 import Reader

from roomba.recordings.bag_format.records import MessageSource
from roomba.recordings.bags.ring import Message, Ring, keep_newest, save

PLAIN = MessageSource(
    "/text", "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n"
)
MAP = replace(PLAIN, topic="/map", node="/maker", is_latched=True)
SECOND = 1_000_000_000


def filled(ring: Ring, seconds: float, size: int = 100, begin: float = 100.0) -> Ring:
    """Add ten messages a second."""
    for each in range(round(10 * seconds)):
        ring.add(Message(PLAIN, round((begin + each / 10) * SECOND), bytes(size)))
    return ring


def test_it_keeps_the_last_seconds() -> None:
    ring = filled(Ring(60.0, 1 << 20), 200.0)
    times = [message.nanoseconds / SECOND for message in ring.messages()]
    assert times[-1] == pytest.approx(299.9)
    assert times[0] == pytest.approx(239.9)
    assert len(times) == 601
    assert ring.size == 60_100


def test_it_keeps_no_more_than_its_memory() -> None:
    ring = filled(Ring(60.0, 5_000), 200.0)
    assert len(ring.messages()) == 50
    assert ring.size == 5_000
    ring.add(Message(PLAIN, 300 * SECOND, bytes(6_000)))
    assert (ring.messages(), ring.size) == ([], 0)


def test_what_is_told_once_comes_first_and_only_the_newest_of_it() -> None:
    ring = Ring(60.0, 1 << 20)
    for word in (b"old", b"new"):
        ring.add(Message(MAP, SECOND, word))
    other = replace(MAP, node="/other")
    ring.add(Message(other, SECOND, b"another's"))
    messages = filled(ring, 200.0).messages()
    assert [(each.source, each.raw) for each in messages[:2]] == [
        (MAP, b"new"),
        (other, b"another's"),
    ]
    assert messages[0].nanoseconds == messages[2].nanoseconds
    assert len(messages) == 603
    ring.add(Message(MAP, 300 * SECOND, b"newest"))
    assert [each.raw for each in ring.messages() if each.source == MAP] == [b"newest"]


def test_a_clock_that_is_set_back_begins_anew() -> None:
    ring = filled(Ring(60.0, 1 << 20), 50.0, begin=1000.0)
    filled(ring, 5.0, begin=10.0)
    assert len(ring.messages()) == 50


def test_it_is_saved_whole_or_not_at_all(tmp_path: Path) -> None:
    path = tmp_path / "wrong.bag"
    save(filled(Ring(60.0, 1 << 20), 20.0).messages(), path)
    with Reader(path) as reader:
        assert reader.message_count == 200
    with pytest.raises(FileNotFoundError):
        save([], tmp_path / "nowhere" / "wrong.bag")
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("most_files", "most_bytes", "left"),
    [(3, 1000, "cde"), (9, 250, "de"), (9, 1000, "abcde"), (1, 5, "e")],
)
def test_old_files_go(tmp_path: Path, most_files: int, most_bytes: int, left: str) -> None:
    for name in "abcde":
        (tmp_path / f"{name}.bag").write_bytes(bytes(100))
    (tmp_path / "mine.txt").write_bytes(bytes(1000))
    keep_newest(tmp_path, "?.bag", most_files, most_bytes)
    assert sorted(path.stem for path in tmp_path.glob("*.bag")) == list(left)
    assert (tmp_path / "mine.txt").exists()
