"""What all programs of a bridge share: topics, publishers, and threads that may wait."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from roomba.client.protocol import RobotUnavailableError
from roomba_ros.rosbridge.hearing import Topics
from roomba_ros.rosbridge.limits import MOST_CALLS
from roomba_ros.rosbridge.publishing import Publishers

Value = TypeVar("Value")


class Shared:
    """The shared parts; they are made in the server's thread."""

    def __init__(self) -> None:
        """Begin with nothing."""
        # The bridge's own threads: calls that hang take no thread away from the page.
        self._waiting = ThreadPoolExecutor(MOST_CALLS, thread_name_prefix="rosbridge")
        self.topics = Topics()
        self.publishers = Publishers(self.wait)

    async def wait(self, ask: Callable[..., Value], *arguments: object) -> Value:
        """Return the answer of a call that may block; RobotUnavailableError without a master."""
        loop = asyncio.get_running_loop()
        try:
            return await loop.run_in_executor(self._waiting, ask, *arguments)
        except OSError as error:
            raise RobotUnavailableError(f"the master does not answer: {error}") from error
