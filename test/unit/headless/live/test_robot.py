"""A robot whose time passes by itself, and requests to it from other threads."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import replace

import pytest

from roomba.client.protocol import RobotUnavailableError
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.headless.live.robot import LiveRobot
from roomba.robot.readings import Readings

DEADLINE = 20.0
"""s of wall time."""


class StandingRobot:
    """Its time passes, and nothing else happens."""

    def __init__(self) -> None:
        self.robot_config = RobotConfig()
        self.now = Readings(0.0, Pose())

    def forget_rows(self) -> None:
        """It keeps none."""

    def advance(self) -> None:
        self.now = replace(self.now, time=self.now.time + self.robot_config.timing.tick)

    def steer(self, twist: Twist) -> None:
        self.advance()


@pytest.fixture
def live() -> Iterator[LiveRobot[StandingRobot]]:
    live = LiveRobot(StandingRobot(), 1.0, lambda robot: None)
    live.start()
    yield live
    live.stop()


def test_what_was_told_to_have_no_answer_is_not_carried_out_later_but_what_was_put_is(
    live: LiveRobot[StandingRobot],
) -> None:
    is_held, goes_on = threading.Event(), threading.Event()
    done: list[str] = []

    def hold(robot: StandingRobot) -> None:
        is_held.set()
        goes_on.wait(DEADLINE)
        done.append("held")

    held = live.put(hold)
    assert is_held.wait(DEADLINE)
    with pytest.raises(RobotUnavailableError, match=r"within 0\.05 s, got none"):
        live.carry_out(lambda robot: done.append("too late"), 0.05)
    put = live.put(lambda robot: done.append("put"))
    assert not put.done()
    goes_on.set()
    held.result(DEADLINE)
    live.carry_out(lambda robot: done.append("in time"))
    assert put.done()
    assert done == ["held", "put", "in time"]


def test_what_is_put_to_a_robot_that_has_ended_is_told_so(
    live: LiveRobot[StandingRobot],
) -> None:
    live.stop()
    with pytest.raises(RobotUnavailableError, match="has ended; start it again"):
        live.put(lambda robot: None).result(DEADLINE)


def test_a_command_that_is_refused_says_why_to_who_gave_it(
    live: LiveRobot[StandingRobot],
) -> None:
    def refuse(robot: StandingRobot) -> None:
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        live.carry_out(refuse)
    assert live.ending == ""
