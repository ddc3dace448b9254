"""rosbridge v2 over the WebSockets of the page's server."""

from __future__ import annotations

import asyncio

from fastapi import WebSocket

from roomba.ui.web.guard import Guard
from roomba.ui.web.viewers import until_one_ends
from roomba_ros.rosbridge.limits import BRIDGE_LIMITS, MOST_PROGRAMS
from roomba_ros.rosbridge.program import Program
from roomba_ros.rosbridge.shared import Shared

_TRY_LATER = 1013
"""The code with which a WebSocket is closed that is one too many."""


class RosBridge:
    """Lets programs hear, publish and call what is on the graph.

    Subscribes and publishes, under the name of this node, what programs ask for, and calls services
    for them.
    """

    limits = BRIDGE_LIMITS

    def __init__(self) -> None:
        """Begin without programs."""
        self._shared: Shared | None = None
        self._programs = 0

    async def serve(self, socket: WebSocket, guard: Guard, *, may_change: bool) -> None:
        """Speak with one program until it goes; without the token it may only read."""
        if self._programs >= MOST_PROGRAMS:
            await socket.close(_TRY_LATER, f"expected at most {MOST_PROGRAMS} programs")
            return
        self._shared = self._shared or Shared()
        program = Program(socket, self._shared, guard, may_change=may_change)
        self._programs += 1
        try:
            await until_one_ends(
                asyncio.create_task(program.listen()), asyncio.create_task(program.tell())
            )
        finally:
            self._programs -= 1
            program.close()
