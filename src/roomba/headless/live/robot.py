"""A robot whose time passes by itself: a thread ticks it as fast as was asked for.

All that touches the robot happens in that thread. Others read immutable snapshots, and let
commands be carried out there.
"""

from __future__ import annotations

import math
import threading
import time
from bisect import bisect_left
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeoutError
from queue import Empty, SimpleQueue
from typing import Any, Final, Generic, Protocol, TypeVar

from roomba.client.observed import HAND_SILENCE, TickTimes
from roomba.client.protocol import RobotUnavailableError
from roomba.configuration.robot import RobotConfig
from roomba.geometry import STANDSTILL, Twist
from roomba.robot.readings import Readings

_FRAME: Final = 0.05
"""s of wall time between two frames: at real time, a tick of the robot."""
_ANSWER: Final = 5.0
"""s of wall time within which a command is answered."""
SPEEDS: Final = (0.1, 100.0)
"""The robot's seconds per second of the wall clock: the least and the most."""

TICK_BOUNDS: Final = (0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.05, 0.1, 0.3, 1.0)
"""s; ticks are counted by which of these bounds their computing time lies between."""


class Ticked(Protocol):
    """A robot whose time passes only while it is ticked."""

    @property
    def now(self) -> Readings:
        """What its body told last."""

    @property
    def robot_config(self) -> RobotConfig:
        """Its configuration."""

    def forget_rows(self) -> None:
        """Forget the ticks that passed, if it keeps them."""

    def advance(self) -> None:
        """Let some ticks pass."""

    def steer(self, twist: Twist) -> None:
        """Let one tick pass, driven by hand."""


_Answer = TypeVar("_Answer")
_Robot = TypeVar("_Robot", bound=Ticked)


class LiveRobot(Generic[_Robot]):
    """Lets a robot's time pass at ``speed`` times that of the wall clock, or as fast as it can."""

    def __init__(self, robot: _Robot, speed: float, observe: Callable[[_Robot], None]) -> None:
        """Start nothing yet.

        ``observe`` is shown the robot after each frame in which its time passed, in its thread.
        """
        self.speed = speed
        self._robot, self._observe = robot, observe
        self._commands: SimpleQueue[tuple[Callable[[_Robot], Any], Future[Any]]]
        self._commands = SimpleQueue()
        self._thread = threading.Thread(target=self._live, name="live robot", daemon=True)
        self._ends = threading.Event()
        self._failure: BaseException | None = None
        self._by_hand = STANDSTILL
        self._hand_heard = -math.inf
        self._ticks, self._ticking = [0] * (len(TICK_BOUNDS) + 1), 0.0

    def start(self) -> None:
        """Begin to live."""
        self._observe(self._robot)
        self._thread.start()

    def stop(self) -> None:
        """End; returns when the last frame has passed."""
        self._ends.set()
        if self._thread.ident is not None:
            self._thread.join(_ANSWER)

    def carry_out(self, command: Callable[[_Robot], _Answer], timeout: float = _ANSWER) -> _Answer:
        """Let the robot's thread call ``command`` between two frames, and return its answer.

        Raises what ``command`` raises, and RobotUnavailableError when the robot ended or does not
        answer within ``timeout`` s of wall time: a command not begun by then is left undone.
        """
        answer = self.put(command)
        try:
            return answer.result(timeout)
        except FutureTimeoutError:
            answer.cancel()
            raise RobotUnavailableError(
                f"expected the robot's answer within {timeout:g} s, got none{self._reason}"
            ) from None

    def put(self, command: Callable[[_Robot], _Answer]) -> Future[_Answer]:
        """Let the robot's thread call ``command`` after those that wait; return its answer to come.

        The command is called however long that thread is busy, unless its answer is cancelled
        before. If the robot has ended, the answer is RobotUnavailableError.
        """
        answer: Future[_Answer] = Future()
        if self.ending:
            answer.set_exception(RobotUnavailableError(f"{self.ending}; start it again"))
        else:
            self._commands.put((command, answer))
        return answer

    def tick_times(self) -> TickTimes:
        """Return how long ticks took to compute; each counts with the mean of its frame."""
        return TickTimes(TICK_BOUNDS, tuple(self._ticks), self._ticking)

    def drive(self, twist: Twist) -> None:
        """Drive by hand for the next half second."""
        self._by_hand, self._hand_heard = twist, time.monotonic()

    @property
    def ending(self) -> str:
        """Why its time does not pass any more; empty while it does."""
        if self._failure is None and self._thread.is_alive():
            return ""
        return f"the robot has ended{self._reason}"

    @property
    def _reason(self) -> str:
        return "" if self._failure is None else f": {self._failure}"

    def _live(self) -> None:
        try:
            due = time.monotonic()
            while not self._ends.is_set():
                self._obey()
                self._pass_frame()
                self._observe(self._robot)
                # A robot that cannot keep up with its clock runs slower, and does not catch up.
                due = max(due + _FRAME, time.monotonic() - _FRAME)
                self._ends.wait(max(0.0, due - time.monotonic()))
        except BaseException as failure:
            self._failure = failure
            raise
        finally:
            self._obey()

    def _obey(self) -> None:
        while True:
            try:
                command, answer = self._commands.get_nowait()
            except Empty:
                return
            if not answer.set_running_or_notify_cancel():
                continue
            try:
                answer.set_result(command(self._robot))
            except Exception as refusal:
                answer.set_exception(refusal)

    def _pass_frame(self) -> None:
        """Let the time of a frame pass."""
        robot = self._robot
        # A robot that lives on for days keeps only the ticks of its last frame.
        robot.forget_rows()
        before, began = robot.now.time, time.monotonic()
        until = before + _FRAME * self.speed
        if self._is_driven_by_hand:
            self._pass_by_hand(until)
            return
        half_tick = 0.5 * robot.robot_config.timing.tick
        while robot.now.time < until - half_tick and time.monotonic() - began < _FRAME:
            robot.advance()
        self._note_ticks(round((robot.now.time - before) / robot.robot_config.timing.tick), began)

    def _note_ticks(self, count: int, began: float) -> None:
        if count > 0:
            seconds = time.monotonic() - began
            self._ticks[bisect_left(TICK_BOUNDS, seconds / count)] += count
            self._ticking += seconds

    @property
    def _is_driven_by_hand(self) -> bool:
        return time.monotonic() - self._hand_heard < HAND_SILENCE

    def _pass_by_hand(self, until: float) -> None:
        """Drive as the hand wants; the mission stands meanwhile."""
        robot = self._robot
        half_tick, began = 0.5 * robot.robot_config.timing.tick, time.monotonic()
        while robot.now.time < until - half_tick and time.monotonic() - began < _FRAME:
            robot.steer(self._by_hand)
