"""The emergency stop of a live robot: held until it is released, and kept on the disk meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Generic, TypeVar

from roomba.client.protocol import RequestRefusedError
from roomba.storage.kept_stop import NO_REASON, KeptStop

_Robot = TypeVar("_Robot")


class HeldStop(Generic[_Robot]):
    """Holds and frees the drive of one robot; its methods may be called from any thread.

    ``obey`` lets the robot's thread carry out a command; ``hold``, given the reason, and ``free``
    are such commands.
    """

    def __init__(
        self,
        obey: Callable[[Callable[[_Robot], None]], None],
        hold: Callable[[_Robot, str], None],
        free: Callable[[_Robot], None],
    ) -> None:
        """Let the drive be free, and keep nothing on the disk until :meth:`keep_in`."""
        self._obey, self._hold_drive, self._free_drive = obey, hold, free
        self._kept: KeptStop | None = None
        self._reason = ""

    @property
    def reason(self) -> str:
        """Why the drive is held; empty while it is free."""
        return self._reason

    def keep_in(self, folder: Path, name: str, robot: _Robot) -> None:
        """Keep the stop in ``folder`` under the robot's ``name``; hold one that was kept before.

        To be called before the robot lives, as it is held in the caller's thread.
        """
        self._kept = KeptStop(folder, name)
        if reason := self._kept.reason():
            self._hold(robot, reason)

    def engage(self, reason: str) -> None:
        """Hold the drive until it is released.

        A disk that does not keep it is told as part of why it is held.
        """
        self._obey(lambda robot: self._hold(robot, reason.strip() or NO_REASON))
        if refused := self._keep_newest():
            self._obey(lambda robot: self._tell_not_kept(robot, refused))

    def release(self) -> None:
        """Free the drive; raises RequestRefusedError too if the next start holds it again."""
        self._obey(self._free)
        if refused := self._keep_newest():
            raise RequestRefusedError(f"the drive is free; but {refused}")

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
        return "" if self._kept is None else self._kept.keep(lambda: self._reason)
