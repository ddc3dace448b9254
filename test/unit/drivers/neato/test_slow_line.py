"""The pose that a driver reports, on a line on which a scan takes half a second."""

from __future__ import annotations

import math
from itertools import pairwise

from fixtures.robots.timed_neato import TimedNeato

from roomba.drivers.robots.table import ROBOTS
from roomba.geometry import Pose, Twist
from roomba.robot.command import Command

_TURNS = Twist(0.2, 0.2), Twist(0.0, -1.0), Twist(0.25, -0.1), Twist(0.0, 0.8), Twist(0.3, 0.0)
"""Each is driven for two seconds."""
_AS_QUICK_AS_USB = 8_000_000
"""Baud."""


def driven(seconds: float) -> list[tuple[Pose, Pose]]:
    """Return where it was and where it was told to be, at each tick."""
    neato = TimedNeato(115_200, is_ideal=True)
    begin, found = neato.simulator.pose, list[tuple[Pose, Pose]]()

    def tick() -> None:
        found.append((begin.inverse().compose(neato.simulator.pose), neato.driver.read().odometry))
        neato.driver.act(Command(_TURNS[int(neato.now / 2.0) % len(_TURNS)]))

    neato.tick = tick
    neato.pass_time(seconds)
    return found


def test_while_a_scan_is_on_the_line_and_after_it_is_told_where_it_should_be() -> None:
    poses = driven(20.0)
    assert poses[-1][0].distance_to(0.0, 0.0) > 0.3
    for true, told in poses:
        assert told.distance_to(true.x, true.y) < 0.05
        assert abs(math.remainder(told.theta - true.theta, math.tau)) < 0.25
    steps = [told.distance_to(before.x, before.y) for (_, before), (_, told) in pairwise(poses)]
    # At 0.3 m/s a tick is 0.015 m; the rest is what the way to the next answer was guessed wrong:
    # the wheels brake before the end of the floor that was seen.
    assert max(steps) < 0.035


def test_as_quick_as_usb_no_scan_is_so_old_that_the_lidar_counts_as_silent() -> None:
    neato = TimedNeato(_AS_QUICK_AS_USB)
    ages: list[float] = []

    def tick() -> None:
        newest = neato.driver.newest_scan()
        assert newest is not None
        ages.append(neato.now - newest.stamp)

    neato.tick = tick
    neato.pass_time(30.0)
    # Two turns of 0.25 s, and what lies between two questions.
    assert 0.6 < max(ages) < ROBOTS["neato"].config().localization.scan_timeout
