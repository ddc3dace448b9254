"""A made-up Create 2 at the end of a line: it answers, and tells a stream, while it lives."""

from __future__ import annotations

import threading
import time
from typing import Final, Protocol

from roomba.drivers.create2.open_interface import STREAM_PERIOD
from roomba.emulators.create2.instructions import InstructionReader
from roomba.emulators.create2.robot import Create2Robot
from roomba.emulators.living import LivingWorld

_LOOK: Final = 0.1
"""s between two checks of whether the thread is to end."""


class TimedEnd(Protocol):
    """The robot's end of a line that has a rate."""

    def read(self, seconds: float) -> bytes:
        """Return what came; b"" after ``seconds``."""

    def write(self, data: bytes) -> None:
        """Send ``data``, as quickly as the line takes it."""

    def set_rate(self, baud: int) -> bool:
        """Send at ``baud``; return whether the program at the other end does, too."""


class Create2Server:
    """Serves a robot on a line until :meth:`end`, ``speed`` times as fast as real time."""

    def __init__(
        self, robot: Create2Robot, line: TimedEnd, world: LivingWorld, speed: float = 1.0
    ) -> None:
        """Serve ``robot``, which lives in ``world``, on ``line``."""
        self.robot, self._line, self._world, self._speed = robot, line, world, speed
        self.is_mute = self.is_deaf = False
        """Whether the wire from the robot (mute), or the wire to it (deaf), is broken."""
        self._writing = threading.Lock()
        self._is_over = threading.Event()
        self._threads = [
            threading.Thread(target=self._obey, name="create2 line", daemon=True),
            threading.Thread(target=self._tell, name="create2 stream", daemon=True),
        ]

    def start(self) -> None:
        """Answer."""
        for thread in self._threads:
            thread.start()

    def end(self) -> None:
        """Answer no more."""
        self._is_over.set()
        for thread in self._threads:
            thread.join(2.0)

    def _obey(self) -> None:
        reader = InstructionReader()
        while not self._is_over.is_set():
            came = self._line.read(_LOOK)
            if self.is_deaf or not self._line.set_rate(self.robot.baud):
                continue  # at another rate no byte is understood
            for told in reader.take(came):
                with self._world.lock:
                    answer = self.robot.do(told)
                self._say(answer)

    def _tell(self) -> None:
        following = time.monotonic()
        while not self._is_over.is_set():
            with self._world.lock:
                frame = self.robot.frame() if self.robot.is_streaming else b""
            self._say(frame)
            # A frame that takes longer than its time on the line delays the next one.
            following = max(following + STREAM_PERIOD / self._speed, time.monotonic())
            self._is_over.wait(max(0.0, following - time.monotonic()))

    def _say(self, data: bytes) -> None:
        if not data or self.is_mute:
            return
        with self._writing:
            if self._line.set_rate(self.robot.baud):
                self._line.write(data)
