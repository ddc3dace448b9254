"""Prompts on a terminal or in a pipe: reading lines and numbers, and what Ctrl-C means."""

from __future__ import annotations

import contextlib
import math
import os
import select
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from types import FrameType, TracebackType

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.errors import RoombaError

STATUS_DONE = 0
STATUS_INTERRUPTED = 130
"""What a shell expects of a program that Ctrl-C ended: 128 + SIGINT."""

SIGNAL_TIME = 0.2
"""s until a waiting prompt looks whether a signal came."""

LONGEST_LINE = 4096
"""Bytes of a line that are kept: an endless one must not fill the memory."""

Read = Callable[[str], str]
"""Asks with a prompt and returns a line; raises EOFError when there are no more."""


class EndOfInputError(Exception):
    """The input has ended: no answer can come."""


class Keyboard:
    """Asks on stdout and reads lines of stdin, be it a terminal or a pipe.

    In the place of ``input``, which sleeps through a Ctrl-C that comes between its prompt and its
    read, and which writes a terminal's prompt to stderr.
    """

    def __init__(self) -> None:
        self._pending = b""
        self._ended = False

    def __call__(self, prompt: str) -> str:
        """Return a line without its end; EOFError at the end of input, or without stdin, stdout."""
        try:
            print(prompt, end="", flush=True)
            descriptor = sys.stdin.fileno()
            line = self._line(descriptor)
            if not os.isatty(descriptor):
                print(flush=True)  # in a pipe no Enter key ends the prompt's line
        except (AttributeError, OSError, ValueError) as error:
            raise EOFError from error
        return line.decode("utf-8", errors="replace")

    def _line(self, descriptor: int) -> bytes:
        while b"\n" not in self._pending and not self._ended:
            if select.select([descriptor], [], [], SIGNAL_TIME)[0]:
                data = os.read(descriptor, LONGEST_LINE)
                self._ended = not data
                end = data.find(b"\n")
                room = max(0, LONGEST_LINE - len(self._pending))
                self._pending += data[:room] if end < 0 else data[: min(end, room)] + data[end:]
        if not self._pending:
            self._ended = False  # a terminal may go on after Ctrl-D
            raise EOFError
        line, _, self._pending = self._pending.partition(b"\n")
        return line


def ask(read: Read, prompt: str) -> str:
    """Return an answer without the blanks around it; raises :class:`EndOfInputError`."""
    try:
        return read(prompt).strip()
    except EOFError:
        # an own class, so that an EOFError of the robot's connection is not taken for the input's
        # end
        raise EndOfInputError from None


def read_number(text: str) -> float | None:
    """Return the finite number that a person typed, or None if it is none."""
    try:
        number = float(text)
    except ValueError:
        return None
    # `float` reads 1_0 as 10; at a keyboard that is a typing error
    return number if math.isfinite(number) and "_" not in text else None


def explain(error: RoombaError) -> str:
    """Return one line for people about what the robot did not do."""
    reason = " ".join(str(error).split()) or "no reason given"
    if isinstance(error, RobotUnavailableError):
        return f"The robot does not answer: {reason}"
    if isinstance(error, RequestRefusedError):
        return f"The robot refuses: {reason}"
    return f"That did not work: {reason}"


class Interrupts:
    """Handles Ctrl-C: at a prompt it leaves; while held, the first is noted, the next leaves."""

    def __init__(self) -> None:
        self._holding = False
        self._noted = False

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            self._before = signal.getsignal(signal.SIGINT)
            signal.signal(signal.SIGINT, self._interrupt)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if threading.current_thread() is threading.main_thread():
            # None stands for a handler that was not set from Python
            signal.signal(signal.SIGINT, self._before or signal.SIG_DFL)

    @contextlib.contextmanager
    def held(self) -> Iterator[None]:
        """Note the first Ctrl-C inside, see :meth:`noted`; forget it at the end."""
        self._noted = False
        self._holding = True
        try:
            yield
        finally:
            self._holding = False

    def noted(self) -> bool:
        """Whether a Ctrl-C came since :meth:`held` began."""
        return self._noted

    def _interrupt(self, _number: int, _frame: FrameType | None) -> None:
        if self._holding and not self._noted:
            self._noted = True
            return
        raise KeyboardInterrupt
