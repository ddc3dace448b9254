"""Viewers of a page's server: ``python3 -m roomba_bench.page.viewers PORT COUNT SECONDS``.

Prints a line of JSON: the ages of all updates when they came, and how many bytes came.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time
from typing import Any, Final

import numpy as np
from websockets.asyncio.client import connect

_SETTLE: Final = 4.0
"""s until all are connected and have the layers; earlier updates are not counted."""


class Viewers:
    """Many viewers in one process."""

    def __init__(self, port: int, count: int) -> None:
        """Connect nothing yet."""
        self._port, self._count = port, count
        self._ages: list[float] = []
        self._bytes = 0
        self._counts = False

    async def look(self, seconds: float) -> dict[str, Any]:
        """Watch for so many s; return what was received."""
        looking = [asyncio.create_task(self._view()) for _ in range(self._count)]
        await asyncio.sleep(_SETTLE)
        self._counts = True
        await asyncio.sleep(seconds)
        self._counts = False
        for task in looking:
            task.cancel()
        await asyncio.gather(*looking, return_exceptions=True)
        ages = np.array(self._ages or [np.nan])
        return {
            "updates": len(self._ages) / self._count / seconds,
            "median": 1e3 * float(np.median(ages)),
            "p99": 1e3 * float(np.percentile(ages, 99)),
            "longest": 1e3 * float(ages.max()),
            "bytes": self._bytes / self._count / seconds,
        }

    async def _view(self) -> None:
        async with connect(f"ws://127.0.0.1:{self._port}/live", max_size=None) as socket:
            async for message in socket:
                if self._counts:
                    self._bytes += len(message)
                    self._note(message)

    def _note(self, message: str | bytes) -> None:
        """Note the age of a state, by the time of the look that it contains."""
        at = message.find('"looked":') if isinstance(message, str) else -1
        if at >= 0 and isinstance(message, str):
            end = min(found for mark in ",}" if (found := message.find(mark, at)) > 0)
            self._ages.append(time.time() - float(message[at + 9 : end]))


def main() -> None:
    """Look on, and print what was seen."""
    port, count, seconds = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    print(json.dumps(asyncio.run(Viewers(port, count).look(seconds))), flush=True)


if __name__ == "__main__":
    main()
