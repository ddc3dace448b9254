"""Ticks at a steady rate of the ROS clock, also when that clock is set or jumps."""

from __future__ import annotations

import time
from collections.abc import Callable

import rospy

from roomba.clock import ClockJumps

_LONGEST_WAIT = 0.1
"""s of wall time; within it a shutdown, or a clock that was set back, is noticed."""
_EARLY = 1e-6


class Ticker:
    """Calls back every ``period`` s of the ROS clock, in the thread that runs it.

    A clock set back or forward starts the rhythm anew there; ticks that were missed are left out.
    rospy's own Rate and Timer raise, or end, when the clock goes backwards.
    """

    def __init__(self, period: float, ended: Callable[[], bool]) -> None:
        """Tick every ``period`` s until ``ended`` says so."""
        self._period = period
        self._ended = ended

    def run(self, tick: Callable[[float], None]) -> None:
        """Call ``tick(now)`` until the end; ``now`` in s of the ROS clock."""
        clock_moved = rospy.rostime.get_rostime_cond()
        jumps = ClockJumps(last=rospy.get_time())
        due = rospy.get_time() + self._period
        while not self._ended():
            now = rospy.get_time()
            jump = jumps.at(now)
            if jump:
                rospy.loginfo("the clock was set back by %.1f s; going on from there", -jump)
                due = now + self._period
            if now + _EARLY < due:
                self._wait(clock_moved, now, due)
                continue
            tick(now)
            due += self._period
            if due <= now:
                due = now + self._period

    @staticmethod
    def _wait(clock_moved: object, now: float, due: float) -> None:
        wait = min(due - now, _LONGEST_WAIT)
        if rospy.rostime.is_wallclock():
            time.sleep(wait)
            return
        with clock_moved:  # type: ignore[attr-defined]
            if rospy.get_time() == now:
                clock_moved.wait(_LONGEST_WAIT)  # type: ignore[attr-defined]
