"""Work that must not hold up ticks: one thread, and of each kind of work only the newest."""

from __future__ import annotations

import threading
from collections.abc import Callable

import rospy

from roomba.errors import RoombaError


class Background:
    """Does what it is given, one after the other; what waits is replaced by newer of its name."""

    def __init__(self) -> None:
        """Begin with nothing to do."""
        self._waiting: dict[str, Callable[[], object]] = {}
        self._news = threading.Condition()
        self._is_at_work = False

    def start(self) -> None:
        """Begin to work."""
        threading.Thread(target=self._run, name="background", daemon=True).start()

    def do(self, name: str, work: Callable[[], object]) -> None:
        """Do this soon, in place of what waits by the same name."""
        with self._news:
            self._waiting.pop(name, None)
            self._waiting[name] = work
            self._news.notify_all()

    def wait(self, deadline: float) -> bool:
        """Return whether all is done, waiting so long for it at most, s of wall time."""
        with self._news:
            return self._news.wait_for(
                lambda: not self._waiting and not self._is_at_work, timeout=deadline
            )

    def work_off(self) -> None:
        """Do all that waits, in the caller's thread: for a caller that starts no other."""
        while self._waiting:
            self._do_next()

    def _run(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: self._waiting)
            self._do_next()

    def _do_next(self) -> None:
        with self._news:
            name = next(iter(self._waiting))
            work = self._waiting.pop(name)
            self._is_at_work = True
        try:
            work()
        except (RoombaError, OSError, ValueError, rospy.ROSException) as error:
            rospy.logwarn("%s: %s", name, error)
        finally:
            with self._news:
                self._is_at_work = False
                self._news.notify_all()
