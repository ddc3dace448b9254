"""Work that must not hold up ticks: one thread, which does only the newest work of each subject.

When the disk refuses work, that is logged once and tried again until it succeeds or newer work
replaces it.
"""

from __future__ import annotations

import threading
import time
import traceback
from collections.abc import Callable
from typing import Final, NamedTuple

import rospy

from roomba.errors import RoombaError

RETRY: Final = 2.0
"""s of wall time until work that the disk refused is tried again."""
_TELL_AGAIN: Final = 60.0
"""s of wall time between two lines of the log about work that is refused again and again."""


class _NamedWork(NamedTuple):
    """Work to do; ``name`` is what to log when it fails."""

    name: str
    do: Callable[[], object]


class _Failed(NamedTuple):
    """Work that the disk refused: when it is due again, why it was, and when that was logged."""

    work: _NamedWork
    due: float
    reason: str
    told: float


class Background:
    """Does work one after the other; newer work of a subject replaces the work that waits."""

    def __init__(self) -> None:
        """Begin with nothing to do."""
        self._waiting: dict[str, _NamedWork] = {}
        """Work by subject, as is what failed."""
        self._failed: dict[str, _Failed] = {}
        self._news = threading.Condition()
        self._is_at_work = False

    def start(self) -> None:
        """Begin to work."""
        threading.Thread(target=self._run, name="background", daemon=True).start()

    def do(self, name: str, work: Callable[[], object], subject: str = "") -> None:
        """Do work soon; it replaces work of its ``subject`` that waits or was refused.

        ``name`` is logged when the work fails, and is the subject if none is given.
        """
        subject = subject or name
        with self._news:
            self._waiting.pop(subject, None)
            self._waiting[subject] = _NamedWork(name, work)
            self._news.notify_all()

    @property
    def trouble(self) -> str:
        """What the disk refuses now, and why; empty when all is well."""
        with self._news:
            failures = self._failed.values()
            return "; ".join(f"{failed.work.name}: {failed.reason}" for failed in failures)

    def wait(self, deadline: float) -> bool:
        """Return whether all is done, waiting so long for it at most, s of wall time."""
        with self._news:
            return self._news.wait_for(
                lambda: not self._waiting and not self._is_at_work, timeout=deadline
            )

    def work_off(self) -> None:
        """Do all waiting work in the caller's thread, where :meth:`start` was never called."""
        while self._waiting:
            self._do_next()

    def _run(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: self._waiting, timeout=self._until_due())
                self._take_due()
            if self._waiting:
                self._do_next()

    def _until_due(self) -> float | None:
        if not self._failed:
            return None
        return max(0.0, min(failed.due for failed in self._failed.values()) - time.monotonic())

    def _take_due(self) -> None:
        """Queue refused work again when it is due, unless newer work of its subject waits."""
        for subject, failed in self._failed.items():
            if time.monotonic() >= failed.due:
                self._waiting.setdefault(subject, failed.work)

    def _do_next(self) -> None:
        with self._news:
            subject = next(iter(self._waiting))
            work = self._waiting.pop(subject)
            self._is_at_work = True
        try:
            work.do()
            self._succeeded(subject)
        except OSError as error:
            self._refused(subject, work, error)
        except (RoombaError, ValueError, rospy.ROSException) as error:
            self._given_up(subject)
            rospy.logwarn("%s: %s", work.name, error)
        except Exception:
            # A bug, or no memory: the other work is done all the same.
            self._given_up(subject)
            rospy.logerr("%s: %s", work.name, traceback.format_exc())
        finally:
            with self._news:
                self._is_at_work = False
                self._news.notify_all()

    def _given_up(self, subject: str) -> None:
        """Drop a subject's refused work: it is not tried again."""
        with self._news:
            self._failed.pop(subject, None)

    def _succeeded(self, subject: str) -> None:
        with self._news:
            failed = self._failed.pop(subject, None)
        if failed is not None:
            rospy.logwarn("this is over: %s", failed.work.name)

    def _refused(self, subject: str, work: _NamedWork, error: OSError) -> None:
        now = time.monotonic()
        with self._news:
            before = self._failed.get(subject)
            is_told = before is not None and now - before.told < _TELL_AGAIN
            told = before.told if before is not None and is_told else now
            self._failed[subject] = _Failed(work, now + RETRY, str(error), told)
        if not is_told:
            rospy.logerr("%s: %s; it is tried again", work.name, error)
