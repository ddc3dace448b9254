"""Topics that programs publish: one publisher of ROS each, however many programs share it."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

import rospy

from roomba_ros.convert.errors import MessageError
from roomba_ros.plain.messages import class_of, message_from
from roomba_ros.rosbridge.graph import subscribers_of, type_of_topic
from roomba_ros.rosbridge.limits import HEARD_WITHIN

_QUEUE = 50
"""Messages that wait for a subscriber which is slow."""


class _Arrivals(rospy.SubscribeListener):
    """Tells the server's thread when a subscriber is connected."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__()
        self._loop, self.came = loop, asyncio.Event()

    def peer_subscribe(self, *_: Any) -> None:
        self._loop.call_soon_threadsafe(self.came.set)


@dataclass
class _Advertised:
    publisher: Any
    kind: type
    arrivals: _Arrivals
    expected: int
    """Subscribers at the time of advertising; the first message waits until they are connected."""
    programs: int = 0
    is_heard: bool = False


class Publishers:
    """All topics that programs publish, each while one of them does."""

    def __init__(self, ask: Callable[..., Awaitable[Any]]) -> None:
        """Publish nothing yet; ``ask`` makes a call that may wait for the master in a thread."""
        self._ask = ask
        self._advertised: dict[str, _Advertised] = {}
        self._lock = asyncio.Lock()

    async def advertise(self, name: str, kind: str, *, is_latched: bool) -> None:
        """Publish a topic for one program more; raises MessageError for another type."""
        async with self._lock:
            advertised = self._advertised.get(name)
            if advertised is None:
                advertised = await self._new(name, kind, is_latched)
                self._advertised[name] = advertised
            elif kind and advertised.kind is not class_of(kind):
                raise MessageError(f"{name} is published with another type than {kind}")
            advertised.programs += 1

    async def publish(self, name: str, plain: Any) -> None:
        """Publish a message on a topic that is advertised; raises MessageError."""
        advertised = self._advertised[name]
        message = message_from(advertised.kind, plain, rospy.get_rostime())
        if not advertised.is_heard:
            await self._until_heard(advertised)
        advertised.publisher.publish(message)

    def unadvertise(self, name: str) -> None:
        """Publish it for one program less."""
        advertised = self._advertised[name]
        advertised.programs -= 1
        if advertised.programs == 0:
            del self._advertised[name]
            # In a thread: to unregister waits for the publisher's own threads.
            threading.Thread(target=advertised.publisher.unregister, daemon=True).start()

    async def _new(self, name: str, kind: str, is_latched: bool) -> _Advertised:
        there = await self._ask(type_of_topic, name)
        if kind and there and there != kind:
            raise MessageError(f"{name}: expected its type {there}, got {kind}")
        found = class_of(kind or there or _unknown(name))
        expected = await self._ask(subscribers_of, name)
        arrivals = _Arrivals(asyncio.get_running_loop())
        publisher = rospy.Publisher(
            name, found, arrivals, latch=is_latched, queue_size=_QUEUE, tcp_nodelay=True
        )
        return _Advertised(publisher, found, arrivals, expected)

    async def _until_heard(self, advertised: _Advertised) -> None:
        """Wait until earlier subscribers are connected: ROS drops what is published before."""
        deadline = asyncio.get_running_loop().time() + HEARD_WITHIN
        while advertised.publisher.get_num_connections() < advertised.expected:
            advertised.arrivals.came.clear()
            left = deadline - asyncio.get_running_loop().time()
            try:
                await asyncio.wait_for(advertised.arrivals.came.wait(), max(left, 0.0))
            except asyncio.TimeoutError:
                break
        advertised.is_heard = True


def _unknown(name: str) -> str:
    raise MessageError(f"{name}: expected a type, for no node publishes or hears this topic")
