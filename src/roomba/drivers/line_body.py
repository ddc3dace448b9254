"""The body of a brain that a driver on a line makes, served by its own thread, in real time.

The brain's thread reads what was told and says what is wanted; the line's thread talks with the
robot. A line that is gone is opened again and again until the robot answers. The same is done after
a fault of the driver: the thread lives as long as the body.
"""

from __future__ import annotations

import logging
import threading
import time
import traceback
from typing import Final, Protocol

from roomba.drivers.body_clock import BodyClock
from roomba.drivers.driver import Driver
from roomba.drivers.line import LineError
from roomba.errors import RoombaError
from roomba.robot.command import Command
from roomba.robot.readings import Readings, ScanReading
from roomba.vocabulary import NO_REASON, Reason

_LOG: Final = logging.getLogger(__name__)
_RETRY_PERIOD: Final = 0.5
"""s of wall time between two attempts to open a line that is gone, and after a fault."""
_FIRST_SCAN_WAIT: Final = 15.0
"""s of wall time; a lidar needs some to come up to its speed."""
_LOOK_PERIOD: Final = 0.05
"""s of wall time between two looks for the first scan."""
_LONGEST_ENDING: Final = 5.0
"""s of wall time for the thread of the line to end: longer than any answer takes."""


class LineAgain(Protocol):
    """A line that can be opened anew."""

    def reopen(self) -> None:
        """Close the line and open it again; raises LineError as long as it is gone."""

    def close(self) -> None:
        """Let go of it."""


class NoScanError(RoombaError):
    """The robot answers, and its lidar does not."""


class DriverFaultError(LineError):
    """The driver failed by an error that it does not handle."""

    remedy = "Please report this"


class LineBody:
    """A :class:`roomba.robot.body.Body` by ``driver``, which times itself by ``clock``.

    :meth:`act` lets a ``tick``, s, of wall time pass. Between :meth:`start` and :meth:`stop` only
    this body's thread may use the line.
    """

    def __init__(self, driver: Driver, line: LineAgain, clock: BodyClock, tick: float) -> None:
        """Connect nothing yet."""
        self._driver, self._line, self._clock, self._tick = driver, line, clock, tick
        self._trouble = Reason("its line is not served yet")
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="robot's line", daemon=True)
        self._due = 0.0
        self._faults: set[str] = set()
        """Faults that are in the log already, by kind and place."""

    def start(self, first_scan: float = _FIRST_SCAN_WAIT, *, has_lidar: bool = True) -> None:
        """Take the robot over, and return when its lidar told a scan, if it has one.

        Raises LineError when it does not answer, NoScanError when no scan comes within
        ``first_scan`` s; then it was given back.
        """
        self._driver.begin()
        self._trouble = NO_REASON
        self._clock.go_on()
        self._thread.start()
        if has_lidar:
            self._wait_for_scan(first_scan)
        self._due = time.monotonic()

    def _wait_for_scan(self, first_scan: float) -> None:
        end = time.monotonic() + first_scan
        while self._driver.newest_scan() is None:
            if time.monotonic() > end:
                why = self._trouble.text
                self.stop()
                raise NoScanError(
                    why
                    or f"expected a scan of the lidar within {first_scan:g} s, got none: does it "
                    "turn, and is nothing in its way?"
                )
            self._driver.act(Command())
            self._is_over.wait(_LOOK_PERIOD)

    def stop(self) -> None:
        """Let the robot stand, give it back, and let go of the line."""
        self._is_over.set()
        if self._thread.ident is not None:
            self._thread.join(_LONGEST_ENDING)
        self._driver.end()
        self._line.close()

    @property
    def trouble(self) -> Reason:
        """Why the robot cannot be reached, and what helps; empty while it can."""
        return self._trouble

    def read(self) -> Readings:
        """Return what the robot told last; each scan is returned once."""
        return self._driver.read()

    def newest_scan(self) -> ScanReading | None:
        """Return the newest scan; None before the first one."""
        return self._driver.newest_scan()

    def tell(self, command: Command) -> None:
        """Pass on the wanted command; without another one the robot stands soon."""
        self._driver.act(command)

    def act(self, command: Command) -> None:
        """Pass on the wanted command, and return when a tick has passed since the last call."""
        self.tell(command)
        now = time.monotonic()
        # A brain that took longer than a tick to think does not catch up.
        self._due = max(self._due + self._tick, now)
        self._is_over.wait(self._due - now)

    def locate(self) -> None:
        """Beep."""
        self._driver.locate()

    def _serve(self) -> None:
        while not self._is_over.is_set():
            try:
                self._driver.serve()
            except Exception as error:
                self._take_over_again(error)

    def _take_over_again(self, error: Exception) -> None:
        """Try until the robot answers again, or the body is stopped; meanwhile the clock stands."""
        self._clock.stand()
        self._note(error)
        # A line that is only garbled is whole again at once; a fault may come each time.
        pause = 0.0 if isinstance(error, LineError) else _RETRY_PERIOD
        is_open = True
        while not self._is_over.wait(pause):
            try:
                if not is_open:
                    self._line.reopen()
                self._driver.begin()
            except Exception as newer:
                self._note(newer)
                is_open, pause = False, _RETRY_PERIOD
                continue
            self._clock.go_on()
            self._trouble = NO_REASON
            return

    def _note(self, error: Exception) -> None:
        """Tell why the robot cannot be reached; the log gets each fault with its place, once."""
        self._trouble = _told(_as_line_error(error))
        if isinstance(error, LineError):
            return
        fault = "".join([type(error).__name__, *traceback.format_tb(error.__traceback__)])
        if fault not in self._faults:
            self._faults.add(fault)
            _LOG.error("A fault of the robot's driver", exc_info=error)


def _as_line_error(error: Exception) -> LineError:
    """Return what is told of an error; a fault of the driver is told with its kind."""
    if isinstance(error, LineError):
        return error
    return DriverFaultError(f"its driver failed, by {type(error).__name__}: {error}")


def _told(error: LineError) -> Reason:
    why = str(error).rstrip(". ")
    end = "" if why.endswith("?") else "."
    text = f"{error.trouble}: {why}{end} {error.remedy}: it goes on by itself"
    return Reason(text, error.hindrance)
