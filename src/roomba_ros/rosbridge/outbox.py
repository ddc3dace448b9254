"""The messages that wait for one program: of each topic the newest, in bounded queues."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from dataclasses import dataclass

from roomba_ros.convert.errors import MessageError
from roomba_ros.rosbridge.hearing import Heard
from roomba_ros.rosbridge.limits import MOST_WAITING, MOST_WAITING_BYTES


@dataclass(frozen=True)
class HearingWish:
    """How a program wants to hear a topic: ``throttle`` s between two messages at least.

    ``length`` is how many messages may wait; 0 means the default: one if throttled, else twenty.
    """

    throttle: float
    length: int

    @property
    def most_waiting(self) -> int:
        """How many messages may wait."""
        usual = 1 if self.throttle > 0.0 else MOST_WAITING
        return min(self.length or usual, MOST_WAITING)


class Listening:
    """One topic of one program, which gets each message once, also with several subscriptions."""

    def __init__(self, name: str, wake: asyncio.Event) -> None:
        """Take the name by which the program knows the topic."""
        self._wake = wake
        self._begin = f'{{"op":"publish","topic":{json.dumps(name)},"msg":'
        self.wishes: dict[str | None, HearingWish] = {}
        self._waiting: deque[Heard] = deque()
        self._last: object = None
        self._last_size = 0
        self._next = 0.0

    def offer(self, heard: Heard) -> None:
        """Let a message wait; it takes the place of the oldest when there are too many."""
        if heard.message is self._last:
            return  # latched, and given twice
        self._last = heard.message
        self._waiting.append(heard)
        most = max((wish.most_waiting for wish in self.wishes.values()), default=1)
        while len(self._waiting) > most or (
            len(self._waiting) > 1 and len(self._waiting) * self._last_size > MOST_WAITING_BYTES
        ):
            self._waiting.popleft()
        self._wake.set()

    def take(self, now: float) -> str | None:
        """Return the next message that is due, as text; None if there is none.

        Raises MessageError for one that cannot be JSON.
        """
        if not self._waiting or now < self._next:
            return None
        heard = self._waiting.popleft()
        self._next = now + min((wish.throttle for wish in self.wishes.values()), default=0.0)
        text = f"{self._begin}{heard.json}}}"
        self._last_size = len(text)
        return text

    @property
    def due(self) -> float | None:
        """When the next message is to be sent, s of the loop's clock; None without one."""
        return self._next if self._waiting else None


class Outbox:
    """All that waits for one program."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.wake = asyncio.Event()
        self.topics: dict[str, Listening] = {}

    async def next(self) -> list[str]:
        """Wait for messages; return one of each topic that has one due."""
        loop = asyncio.get_running_loop()
        while True:
            self.wake.clear()
            now = loop.time()
            texts = [text for topic in self.topics.values() if (text := _taken(topic, now))]
            if texts:
                return texts
            dues = [due for topic in self.topics.values() if (due := topic.due) is not None]
            try:
                await asyncio.wait_for(self.wake.wait(), min(dues) - now if dues else None)
            except asyncio.TimeoutError:
                continue


def _taken(topic: Listening, now: float) -> str | None:
    try:
        return topic.take(now)
    except MessageError as error:
        return status_text("error", str(error))


def status_text(level: str, reason: str, identity: str | None = None) -> str:
    """Return a status for a program."""
    status = {"op": "status", "level": level, "msg": reason}
    if identity is not None:
        status["id"] = identity
    return json.dumps(status)
