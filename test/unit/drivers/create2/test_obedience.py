"""Wheels that do not turn as commanded are noticed."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from roomba.drivers.create2.obedience import Obedience
from roomba.geometry import STANDSTILL, Twist

AHEAD = Twist(0.28, 0.0)


def lost_after(
    told: Callable[[float], Twist], measured: Callable[[float], Twist], seconds: float = 4.0
) -> float | None:
    """Return when it is noticed that a robot does not obey, s; None: within so long it is not."""
    obedience = Obedience(0.235)
    for tick in range(round(seconds / 0.05)):
        now = 0.05 * tick
        if obedience.is_lost(now, told(now), measured(now)):
            return now
    return None


def test_a_robot_that_does_what_it_is_told_obeys() -> None:
    twists = [AHEAD, Twist(0.0, 1.5), Twist(0.1, -0.8), Twist(-0.1, 0.0), STANDSTILL]

    def told(now: float) -> Twist:
        return twists[int(now) % len(twists)]

    assert lost_after(told, told, 20.0) is None
    # It is late, as any robot is.
    assert lost_after(told, lambda now: told(max(0.0, now - 0.3)), 20.0) is None


@pytest.mark.parametrize("told", [STANDSTILL, Twist(0.0, 1.5), Twist(0.1, 0.0), Twist(-0.2, 0.0)])
def test_a_robot_that_drives_on_does_not_obey(told: Twist) -> None:
    after = lost_after(lambda now: AHEAD if now < 1.0 else told, lambda _: AHEAD)
    assert after is not None
    assert after == pytest.approx(1.5, abs=0.06)


def test_wheels_that_something_holds_obey() -> None:
    assert lost_after(lambda _: AHEAD, lambda _: STANDSTILL) is None
    assert lost_after(lambda _: AHEAD, lambda _: Twist(0.1, 0.0)) is None


def test_a_robot_that_stands_may_be_pushed_by_hand() -> None:
    def told(now: float) -> Twist:
        return AHEAD if now < 1.0 else STANDSTILL

    def measured(now: float) -> Twist:
        return AHEAD if now < 1.0 or now > 4.5 else STANDSTILL

    assert lost_after(told, measured, 12.0) is None


def test_taken_over_anew_it_begins_anew() -> None:
    obedience = Obedience(0.235)
    obedience.is_lost(0.0, AHEAD, AHEAD)
    assert obedience.is_lost(0.8, AHEAD, Twist(-0.3, 0.0))
    obedience.forget()
    assert not obedience.is_lost(0.9, STANDSTILL, AHEAD)
