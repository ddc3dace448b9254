"""The newest messages, bounded in time and memory; and those that are told only once."""

from __future__ import annotations

import threading
from collections import deque
from pathlib import Path
from typing import NamedTuple

from roomba.recordings.bag_format.records import MessageSource
from roomba.recordings.bags.writer import BagWriter


class Message(NamedTuple):
    """A message as it came: where from, when, ns, and its bytes."""

    source: MessageSource
    nanoseconds: int
    raw: bytes


class Ring:
    """Messages of the last ``seconds`` by their times, of ``most_bytes`` at most.

    The newest message of each latched source is kept as well, however old: a map, or where sensors
    are. Only one message of each source is kept so, so this is bounded, too.
    """

    def __init__(self, seconds: float, most_bytes: int) -> None:
        """Begin empty."""
        self._length, self._most = round(seconds * 1e9), most_bytes
        self._lock = threading.Lock()
        self._messages: deque[Message] = deque()
        self._latched: dict[tuple[str, str], Message] = {}
        self.size = 0
        """Bytes of the messages of the last seconds."""

    def add(self, message: Message) -> None:
        """Take a message; the oldest ones go."""
        with self._lock:
            if message.source.is_latched:
                self._latched[message.source.topic, message.source.node] = message
            if (
                self._messages
                and message.nanoseconds < self._messages[-1].nanoseconds - self._length
            ):
                # The clock was set back: what was before is of another time.
                self._messages.clear()
                self.size = 0
            self._messages.append(message)
            self.size += len(message.raw)
            newest = self._messages[-1].nanoseconds
            while self.size > self._most or self._messages[0].nanoseconds < newest - self._length:
                self.size -= len(self._messages.popleft().raw)
                if not self._messages:
                    break

    def messages(self) -> list[Message]:
        """Return all of them; those latched before the others come first, with the first time."""
        with self._lock:
            kept = list(self._messages)
            there = set(map(id, kept))
            before = [each for each in self._latched.values() if id(each) not in there]
        begin = kept[0].nanoseconds if kept else 0
        return [*(each._replace(nanoseconds=begin or each.nanoseconds) for each in before), *kept]


def save(messages: list[Message], path: Path) -> None:
    """Write messages as a bag, which is there when it is whole; raises OSError."""
    unfinished = path.with_suffix(".unfinished")
    unfinished.unlink(missing_ok=True)
    try:
        with BagWriter(unfinished) as bag:
            for message in messages:
                bag.write(*message)
        unfinished.rename(path)
    finally:
        unfinished.unlink(missing_ok=True)


def keep_newest(folder: Path, pattern: str, most_files: int, most_bytes: int) -> list[Path]:
    """Remove a pattern's oldest files until few and small enough are left; return those removed.

    The newest one stays, however large it is.
    """
    found = sorted(folder.glob(pattern), key=lambda path: (path.stat().st_mtime_ns, path.name))
    sizes = [path.stat().st_size for path in found]
    removed = []
    while len(found) > 1 and (len(found) > most_files or sum(sizes) > most_bytes):
        oldest = found.pop(0)
        sizes.pop(0)
        oldest.unlink()
        removed.append(oldest)
    return removed
