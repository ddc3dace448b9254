"""A Neato that is driven at stairs by a caller that goes on: no wheel goes over the edge."""

from __future__ import annotations

import math

import pytest
from fixtures.robots.timed_neato import TimedNeato

from roomba.geometry import Pose, Twist
from roomba.robot.command import Command

EDGE = 6.5
"""m; x where the hallway of ``family`` ends, between y = -1.2 and -0.2."""
LINES = {"usb": (8_000_000, False), "serial": (115_200, False), "bridge": (115_200, True)}
_LEAST_AHEAD = 0.155 * math.cos(math.radians(60.0))
"""m; of the outer drop sensors before the wheels."""


def driven_at_stairs(line: str, pose: Pose, wanted: Twist, seconds: float = 8.0) -> float:
    """Return how far it came from where its sensors met the edge, m; fails when a wheel drops."""
    baud, is_bridged = LINES[line]
    neato = TimedNeato(baud, home="family", is_ideal=True, is_bridged=is_bridged)
    neato.simulator.put(pose)
    met: list[Pose] = []
    farthest = 0.0

    def tick() -> None:
        nonlocal farthest
        seen = neato.robot.seen
        cliff = seen.cliff
        assert not seen.wheels.dropped, f"over the edge at {seen.pose}"
        if cliff.left or cliff.front_left or cliff.front_right or cliff.right:
            met.append(seen.pose)
            farthest = max(farthest, seen.pose.distance_to(met[0].x, met[0].y))
        neato.driver.act(Command(wanted))

    neato.tick = tick
    neato.pass_time(seconds)
    assert met, "it came to no edge"
    assert neato.driver.read().cliff.any
    return farthest


@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("before", [0.5, 0.56, 0.62, 0.68, 0.74])
def test_straight_ahead_it_stands_before_a_wheel_is_over(line: str, before: float) -> None:
    """From several distances, so that it comes to the edge in a scan as well."""
    pose = Pose(EDGE - before, -0.7, 0.0)
    assert driven_at_stairs(line, pose, Twist(0.3, 0.0)) < _LEAST_AHEAD


@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("heading", [-0.5, 0.4])
@pytest.mark.parametrize("angular", [-0.2, 0.2])
def test_askew_and_in_a_bend(line: str, heading: float, angular: float) -> None:
    pose = Pose(EDGE - 0.5, -0.7 - 0.3 * math.sin(heading), heading)
    driven_at_stairs(line, pose, Twist(0.3, angular))


@pytest.mark.parametrize("line", LINES)
def test_away_from_an_edge_it_drives_though_that_is_still_told(line: str) -> None:
    baud, is_bridged = LINES[line]
    neato = TimedNeato(baud, home="family", is_ideal=True, is_bridged=is_bridged)
    neato.simulator.put(Pose(EDGE - 0.1, -0.7, 0.0))
    neato.tick = lambda: neato.driver.act(Command(Twist(-0.1, 0.0)))
    neato.pass_time(3.0)
    assert neato.simulator.pose.x < EDGE - 0.2
    assert not neato.driver.read().cliff.any
