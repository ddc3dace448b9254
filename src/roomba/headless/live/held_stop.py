"""The emergency stop of a live robot: held until it is released, and kept on the disk meanwhile."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeoutError
from pathlib import Path
from typing import Final, Generic, TypeVar

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.storage.kept_stop import NO_REASON, KeptStop

ANSWER: Final = 5.0
"""s of wall time within which the robot must confirm that its drive is held, or free."""

_Robot = TypeVar("_Robot")


class HeldStop(Generic[_Robot]):
    """Holds and frees the drive of one robot; its methods may be called from any thread.

    ``put`` lets the robot's thread carry out a command after those that were put before, and
    returns the answer to come; ``hold``, given the reason, and ``free`` are such commands. A stop
    that was asked for is never taken back: a robot that is busy holds as soon as it is not.
    """

    def __init__(
        self,
        put: Callable[[Callable[[_Robot], None]], Future[None]],
        hold: Callable[[_Robot, str], None],
        free: Callable[[_Robot], None],
    ) -> None:
        """Let the drive be free, and keep nothing on the disk until :meth:`keep_in`."""
        self._put, self._hold_drive, self._free_drive = put, hold, free
        self._kept: KeptStop | None = None
        self._reason = ""
        self._asked: list[str] = []
        self._asking = threading.Lock()

    @property
    def reason(self) -> str:
        """Why the drive is held; empty while it is free."""
        return self._reason

    def keep_in(self, folder: Path, name: str, robot: _Robot) -> None:
        """Keep the stop in ``folder`` under the robot's ``name``; hold if one was kept before.

        Call this before the robot lives, as it is held in the caller's thread.
        """
        self._kept = KeptStop(folder, name)
        if reason := self._kept.reason():
            self._hold(robot, reason)

    def engage(self, reason: str) -> None:
        """Hold the drive until it is released.

        If the disk cannot keep the stop, the reason of the hold says so. Raises
        RobotUnavailableError if the robot does not answer in time: it holds as soon as it does.
        """
        answers = [self._ask_to_hold(reason.strip() or NO_REASON)]
        if refused := self._keep_newest():
            answers.append(self._put(lambda robot: self._tell_not_kept(robot, refused)))
        for answer in answers:
            _wait_for(answer, "the emergency stop holds as soon as it answers")

    def release(self) -> None:
        """Free the drive; raises RequestRefusedError also if the next start will hold it again.

        Raises RobotUnavailableError if the robot does not answer in time.
        """
        answer = self._put(self._free)
        try:
            _wait_for(answer, "the emergency stop may still hold")
        finally:
            answer.cancel()
        if refused := self._keep_newest():
            raise RequestRefusedError(f"the drive is free; but {refused}")

    def _ask_to_hold(self, reason: str) -> Future[None]:
        """Queue a command to hold; until the robot carries it out its reason is the newest one."""
        with self._asking:
            self._asked.append(reason)
            answer = self._put(lambda robot: self._hold(robot, reason))
        answer.add_done_callback(lambda _: self._asked.remove(reason))
        return answer

    def _hold(self, robot: _Robot, reason: str) -> None:
        self._hold_drive(robot, reason)
        self._reason = reason

    def _free(self, robot: _Robot) -> None:
        self._free_drive(robot)
        self._reason = ""

    def _tell_not_kept(self, robot: _Robot, refused: str) -> None:
        if self._reason:
            self._hold(robot, f"{self._reason}; but {refused}")

    def _keep_newest(self) -> str:
        """Keep why the drive is held, or that it is free; return what the disk refused."""
        return "" if self._kept is None else self._kept.keep(self._newest)

    def _newest(self) -> str:
        """Return the newest reason that waits to hold, else the one that holds."""
        asked = self._asked[-1:]
        return asked[0] if asked else self._reason


def _wait_for(answer: Future[None], late: str) -> None:
    """Wait for an answer; raises RobotUnavailableError, which tells ``late``, if none comes."""
    try:
        answer.result(ANSWER)
    except FutureTimeoutError:
        raise RobotUnavailableError(
            f"expected the robot's answer within {ANSWER:g} s, got none; {late}"
        ) from None
