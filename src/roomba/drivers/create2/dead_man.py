"""A process that stops the robot when the driver's program is killed or frozen.

The Open Interface has no time-out: the robot obeys its last drive command for ever. Through a pipe
the driver tells this process twenty times a second that it lives; the pipe closes when the driver
dies. When the pipe closes, and when nothing comes for 0.15 s while the robot drives, this process
sends the stop on the same line. It is run as a program and needs nothing but Python, so that it
starts soon and little can go wrong.
"""

import os
import select
import signal
import subprocess
import sys
from typing import Final, Protocol

SILENT: Final = 0.15
"""s; without a word for so long, while the robot drives, it is stopped."""
DRIVES, STANDS = b"d", b"s"
PADDING: Final = bytes(32)
"""Zeros: they complete a command that was cut short; as commands they are passed over."""
STOP: Final = PADDING + bytes([145, 0, 0, 0, 0, 144, 0, 0, 0])
"""Both wheels at 0 mm/s, and all brushes off."""


class Switch(Protocol):
    """What a driver needs of a dead man's switch."""

    def start(self) -> None:
        """Watch from now on."""

    def tell(self, drives: bool) -> bool:
        """Say that the driver lives, and whether the robot may drive; return whether it hears."""

    def end(self) -> None:
        """Watch no more."""


class DeadManSwitch:
    """The driver's side of the process; the port must be a device file of this machine."""

    def __init__(self, port: str) -> None:
        """Prepare to guard the robot on ``port``; no process runs yet."""
        self._port = port
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start the process; one that runs already is ended first."""
        self.end()
        # In a session of its own: a signal that ends the driver from its terminal must not end
        # this, too.
        self._process = subprocess.Popen(
            [sys.executable, "-I", __file__, self._port],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
            bufsize=0,
        )

    def tell(self, drives: bool) -> bool:
        """Say that the driver lives, and whether the robot may drive; return whether it hears.

        The process does not when it was killed or its line is gone; start() then starts another
        one.
        """
        if self._process is None or self._process.stdin is None:
            return False
        try:
            self._process.stdin.write(DRIVES if drives else STANDS)
        except BrokenPipeError:
            return False
        return True

    def end(self) -> None:
        """Close the pipe: the process stops the robot once more, and ends."""
        process, self._process = self._process, None
        if process is None:
            return
        if process.stdin is not None:
            process.stdin.close()
        try:
            process.wait(2.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def watch(words: int, port: str) -> None:
    """Read words from a pipe until it closes; stop the robot on ``port`` when they fail to come."""
    line = os.open(port, os.O_WRONLY | os.O_NOCTTY | os.O_NONBLOCK)
    drives = False
    while True:
        readable, _, _ = select.select([words], [], [], SILENT if drives else None)
        if not readable:
            os.write(line, STOP)
            drives = False
            continue
        came = os.read(words, 4096)
        if not came:
            break
        drives = came.endswith(DRIVES)
    os.write(line, STOP)
    os.close(line)


if __name__ == "__main__":
    for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(ending, signal.SIG_IGN)
    watch(sys.stdin.fileno(), sys.argv[1])
