"""Polls a robot that cleans by its own brain, in a thread of its own."""

from __future__ import annotations

import contextlib
import math
import threading
from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.client.protocol import CleanReport
from roomba.client.view import NO_POINTS
from roomba.errors import RoombaError
from roomba.headless.live.remote.errand_end import ErrandEnd
from roomba.robot.remote import RemoteRobot, RemoteState
from roomba.vocabulary import Phase

_PERIOD: Final = 2.0
"""s between two looks; OpenNeato's bridge keeps a state for so long."""
_SCAN_EACH: Final = 2
"""Looks per scan: a scan occupies the robot's connection for most of a second."""
_OLD: Final = 10.0
"""s after which the last state is outdated; even a slow look takes less."""
_ENDING: Final = 10.0
"""s that :meth:`RemoteWatch.end` waits for a look under way."""
_MOVES: Final = (Phase.CLEANING, Phase.RETURNING)


class RemoteWatch:
    """Looks at one robot; what it saw may be read from any thread.

    ``state`` is what the robot told last, None before it did, ``scan`` where its lidar's beams met
    something, and ``scan_trouble`` why there is none.
    """

    def __init__(
        self, remote: RemoteRobot, now: Callable[[], float], before: Callable[[], None]
    ) -> None:
        """Look at nothing yet; ``before`` is called before each look, and may raise RoombaError."""
        self._remote, self._now, self._before = remote, now, before
        self.state: RemoteState | None = None
        self.scan: NDArray[np.float32] = NO_POINTS
        self.scan_trouble = ""
        self._errand = ErrandEnd()
        self._lost = ""
        self._looks, self._looked_at = 0, -math.inf
        self._failure: Exception | None = None
        self._due, self._is_over = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._watch, name="remote robot", daemon=True)

    def start(self) -> None:
        """Look from now on."""
        self._thread.start()

    def hurry(self) -> None:
        """Look at once."""
        self._due.set()

    def end(self) -> None:
        """Look no more."""
        self._is_over.set()
        self._due.set()
        if self._thread.is_alive():
            self._thread.join(_ENDING)

    @property
    def ending(self) -> str:
        """Why the robot is not looked at any more; empty while it is, and before :meth:`start`."""
        if self._failure is not None:
            return f"the robot is not looked at any more: {self._failure!r}"
        has_ended = self._is_over.is_set() and not self._thread.is_alive()
        return "the robot is not looked at any more" if has_ended else ""

    @property
    def lost(self) -> str:
        """Why the robot is not reached now; empty if it is."""
        if self.state is None:
            return self._lost or "the robot was not asked yet"
        if not self._lost and self._now() - self._looked_at > _OLD:
            return f"expected news of the robot within {_OLD:g} s, got none"
        return self._lost

    @property
    def last(self) -> CleanReport | None:
        """How its last clean ended; None before one did. It is set before ``state`` is."""
        return self._errand.last

    @property
    def moves(self) -> bool:
        """Whether the robot was cleaning or returning at the last look."""
        return self.state is not None and self.state.phase in _MOVES

    def _watch(self) -> None:
        try:
            while not self._is_over.is_set():
                self._due.clear()
                with contextlib.suppress(RoombaError):  # ``before`` reports its own failures
                    self._before()
                self._look_or_lose()
                self._due.wait(_PERIOD)
        except Exception as failure:
            self._failure = failure

    def _look_or_lose(self) -> None:
        try:
            self._look()
            self._lost = ""
        except RoombaError as error:
            self._lost = str(error)

    def _look(self) -> None:
        state = self._remote.look()
        self._looked_at = self._now()
        self._errand.look(state, self._looked_at)
        self.state = state
        self._looks += 1
        if not self.moves:
            self.scan, self.scan_trouble = NO_POINTS, ""
        elif self._looks % _SCAN_EACH == 0:
            self._look_around()

    def _look_around(self) -> None:
        try:
            self.scan, self.scan_trouble = self._remote.scan(), ""
        except RoombaError as error:
            self.scan, self.scan_trouble = NO_POINTS, str(error)
