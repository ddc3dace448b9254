"""Turning once on the spot, where a map in the making shows no way."""

from __future__ import annotations

import math

import pytest

from roomba.configuration.mission import ExploringConfig
from roomba.geometry import Pose, Twist
from roomba.mission.exploring.turn_to_see import TurnToSee
from roomba.mission.inputs.senses import Senses

CONFIG = ExploringConfig()
TICK = 0.05


def turned(turn: TurnToSee, begin: Senses, share: float = 1.0) -> tuple[float, float]:
    """Let a robot turn that does ``share`` of what is wanted; return how far, rad, and how long."""
    now, theta, way = begin.now, begin.pose.theta, 0.0
    while turn.is_under_way:
        wanted = turn.tick(Senses(now, Pose(begin.pose.x, begin.pose.y, theta)))
        assert wanted.linear == 0.0
        now, way = now + TICK, way + share * wanted.angular * TICK
        theta = math.remainder(theta + share * wanted.angular * TICK, math.tau)
        assert now - begin.now < 1000.0
    return way, now - begin.now


def test_it_turns_once_around_at_each_place() -> None:
    turn, here = TurnToSee(CONFIG), Senses(5.0, Pose(1.0, 2.0, 3.0))
    assert turn.begin(here)
    way, lasted = turned(turn, here)
    assert way == pytest.approx(math.tau, abs=0.05)
    assert lasted == pytest.approx(math.tau / CONFIG.seeing_speed, rel=0.05)
    assert not turn.begin(here)
    assert turn.begin(Senses(60.0, Pose(1.0 + CONFIG.same_frontier + 0.1, 2.0, 0.0)))


@pytest.mark.parametrize("share", [0.0, 0.1])
def test_one_that_is_held_gives_up(share: float) -> None:
    turn, here = TurnToSee(CONFIG), Senses(0.0, Pose())
    turn.begin(here)
    way, lasted = turned(turn, here, share)
    assert way < math.tau
    assert lasted < 4.0 * math.tau / CONFIG.seeing_speed
    assert turn.tick(Senses(lasted, Pose())) == Twist()
