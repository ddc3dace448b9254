"""A topic that tells a state: at a steady rate, and at once when the state changes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, Generic, TypeVar

import rospy

from roomba_ros.runtime.timing.wall_period import WallPeriod

_Told = TypeVar("_Told")
_REPEATED_AFTER: Final = 0.1
"""s of wall time between two messages that tell the same."""


class ToldTopic(Generic[_Told]):
    """Publishes ``message(now, told)`` every ``period`` ticks; at once when ``changes(told)`` does.

    On a fast clock, an unchanged state is repeated at most 10 times a second of wall time. Without
    ``changes`` each message counts as new. Without a subscriber no message is made.
    """

    def __init__(
        self,
        name: str,
        kind: type,
        period: int,
        message: Callable[[float, _Told], Any],
        changes: Callable[[_Told], object] | None = None,
    ) -> None:
        """Connect; messages are of ``kind``."""
        self._publisher = rospy.Publisher(name, kind, queue_size=1, tcp_nodelay=True)
        self._period, self._message, self._changes = period, message, changes
        self._last: object = None
        self._repeated = WallPeriod(_REPEATED_AFTER)

    def tell(self, now: float, tick: int, told: _Told) -> None:
        """Publish if it is time to; ``now`` is the time for stamps, s."""
        if self._publisher.get_num_connections() == 0:
            return
        state = self._changes(told) if self._changes else None
        if state != self._last or (tick % self._period == 0 and self._is_due()):
            self._last = state
            self._repeated.begin()
            self._publisher.publish(self._message(now, told))

    def _is_due(self) -> bool:
        """Whether the message counts as new, or the last one is old enough by wall time."""
        return self._changes is None or self._repeated.is_over()
