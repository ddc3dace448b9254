"""The pace of the simulation: as fast as asked for while the robot's nodes keep up."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Final, NamedTuple

from roomba.configuration.nodes import PaceConfig

_LOOK: Final = 0.01
"""s of wall time between two looks whether a silent part is still to be waited for."""


class _Heard(NamedTuple):
    """A part's last message: ``stamp`` in s of the robot's clock, the others in s of wall time."""

    stamp: float
    advanced: float
    """When the part first told that stamp."""
    answered: float
    """When the part last told any stamp."""


class Pace:
    """Says when the next tick is due. The robot's parts tell how far they are by :meth:`heard`.

    The pace waits for them, for two reasons. On a busy machine commands would come too late if the
    world went on while the robot's nodes still work. And a killed node needs a few seconds of wall
    time to restart, which are minutes on a clock that is faster than real time.
    """

    def __init__(
        self,
        tick: float,
        speed: float,
        config: PaceConfig,
        is_there: Callable[[str], bool],
        monotonic: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
        wait_for: Callable[[threading.Event, float], object] = threading.Event.wait,
    ) -> None:
        """Let a tick, ``tick`` s of the robot's clock, come every ``tick / speed`` s of wall time.

        ``is_there`` tells whether a node that was heard still runs. A dead node is not waited for,
        but the clock goes no faster than real time until the node is heard again, for a minute at
        most.
        """
        self._tick, self._speed, self._config = tick, speed, config
        self._monotonic, self._sleep, self._is_there = monotonic, sleep, is_there
        self._has_news, self._wait_for = threading.Event(), wait_for
        self._due = monotonic() + tick / speed
        self._heard: dict[str, _Heard] = {}
        self._ticked = monotonic()
        self.is_late = False
        """Whether it was ever slower than asked for."""

    def heard(self, part: str, stamp: float) -> None:
        """Hear that a part of the robot has worked up to a time of its clock, s.

        The same time again means that the part has not got any farther.
        """
        now, before = self._monotonic(), self._heard.get(part)
        advanced = before.advanced if before is not None and before.stamp == stamp else now
        self._heard[part] = _Heard(stamp, advanced, now)
        self._has_news.set()

    def wait(self, now: float, ended: Callable[[], bool]) -> None:
        """Return when the next tick is due, or at the end.

        ``now`` is the time, s of the robot's clock, of what it was told last.
        """
        wait = self._due - self._monotonic()
        if wait > 0.0:
            self._sleep(wait)
        self._hold(now, ended)
        if self._monotonic() - self._due > self._config.latest:
            self.is_late = True
            self._due = self._monotonic()
        self._due += self._tick / self._speed_now()
        self._ticked = self._monotonic()

    def _hold(self, now: float, ended: Callable[[], bool]) -> None:
        """Wait for the parts that are late, at most until the last of them is heard."""
        while not ended():
            self._has_news.clear()  # cleared before the look: news after it ends the wait
            if not self._must_hold(now):
                return
            self._wait_for(self._has_news, _LOOK)

    def _speed_now(self) -> float:
        is_missed = self._speed > 1.0 and any(map(self._is_missed, list(self._heard)))
        return 1.0 if is_missed else self._speed

    def _is_missed(self, part: str) -> bool:
        silence = self._monotonic() - self._heard[part].advanced
        is_gone = silence > self._config.longest_hold or not self._is_there(part)
        return is_gone and silence < self._config.longest_absence

    def _must_hold(self, now: float) -> bool:
        """Whether to wait for a late part; not if its clock is another one or was set.

        A part that answered since the last tick is not waited for either: it goes by the clock,
        which stands meanwhile.
        """
        advanced = [
            heard.advanced
            for part, heard in list(self._heard.items())
            if self._is_late(now - heard.stamp)
            and heard.answered <= self._ticked
            and self._is_there(part)
        ]
        return bool(advanced) and self._monotonic() - max(advanced) < self._config.longest_hold

    def _is_late(self, behind: float) -> bool:
        return self._config.most_behind < behind < 10.0 * self._config.longest_hold
