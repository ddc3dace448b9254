"""A made-up Neato at the end of a line: the world goes on in real time while it answers."""

from __future__ import annotations

import threading
from typing import Final, Protocol

from roomba.emulators.living import LivingWorld
from roomba.emulators.neato.robot import STEP, NeatoRobot

LATENCY: Final = 0.025
"""s; what the robot takes for each command."""
_LONGEST_LINE: Final = 512
"""Bytes; what is longer is no command."""
_LOOK: Final = 0.1
"""s between two checks of whether the thread is to end."""


class RobotEnd(Protocol):
    """The robot's end of a line."""

    def read(self, seconds: float) -> bytes:
        """Return what came; b"" after ``seconds``."""

    def write(self, data: bytes) -> None:
        """Send ``data``, as quickly as the line takes it."""


class NeatoServer:
    """Answers on a line until :meth:`end`, ``speed`` times as fast as real time."""

    def __init__(self, robot: NeatoRobot, line: RobotEnd, speed: float = 1.0) -> None:
        """Serve ``robot`` on ``line``."""
        self.robot, self._line, self._speed = robot, line, speed
        self._world = LivingWorld(robot.advance, speed, STEP)
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._answer_all, name="neato line", daemon=True)

    def start(self) -> None:
        """Let the world go on, and answer."""
        self._world.start()
        self._thread.start()

    def end(self) -> None:
        """Let the world stand, and answer no more."""
        self._is_over.set()
        self._thread.join(2.0)
        self._world.end()

    def __enter__(self) -> NeatoRobot:
        """Start; return the robot."""
        self.start()
        return self.robot

    def __exit__(self, *_: object) -> None:
        """End."""
        self.end()

    def _answer_all(self) -> None:
        came = b""
        while not self._is_over.is_set():
            came += self._line.read(_LOOK)
            *lines, came = came.replace(b"\r", b"\n").split(b"\n")
            came = came[-_LONGEST_LINE:]
            for line in lines:
                if line.strip():
                    self._answer(line)

    def _answer(self, line: bytes) -> None:
        text = line[:_LONGEST_LINE].decode("ascii", "replace")
        self._is_over.wait(LATENCY / self._speed)
        with self._world.lock:
            answer = self.robot.answer(text)
        self._line.write(answer.encode("ascii", "replace"))
