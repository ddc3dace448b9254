"""Following a walk: it always ends, and its output suits the terminal or pipe."""

from __future__ import annotations

import io
import math
import re

import pytest
from rich.console import Console

from roomba.client.fake.robot import FakeRobot, SteppedClock, Turn, WalkScript
from roomba.client.protocol import RobotState, RobotUnavailableError, WalkOutcome, WalkReport
from roomba.ui.progress import (
    CANCEL_DEADLINE,
    POLL_TIME,
    SILENCE_LIMIT,
    LineView,
    follow_walk,
    quantity,
    walk_view,
)


def plain_console() -> Console:
    return Console(file=io.StringIO(), force_terminal=False, width=80)


def terminal(no_color: bool = False) -> Console:
    return Console(
        file=io.StringIO(),
        force_terminal=True,
        force_interactive=True,
        width=80,
        color_system="standard",
        no_color=no_color,
        _environ={"TERM": "xterm"},
    )


def shown(console: Console) -> str:
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def follow(robot: FakeRobot, console: Console, stop_after: float = math.inf) -> WalkReport:
    """Walk to (3, 4), wanting to stop at a moment of the robot's clock."""
    length = robot.path_length(3.0, 4.0)
    walk = robot.walk_to(3.0, 4.0)
    with walk_view(console, length) as view:
        return follow_walk(
            walk,
            robot,
            view,
            total=length,
            wants_to_stop=lambda: robot.clock.monotonic() >= stop_after,
            clock=robot.clock,
        )


@pytest.mark.parametrize(
    ("value", "unit", "decimals", "text"),
    [
        (1.005, "m", 2, "1.00 m"),
        (-0.001, "m", 2, "0.00 m"),
        (12.34, "s", 1, "12.3 s"),
        (math.nan, "m/s", 2, "unknown"),
        (math.inf, "s", 2, "unknown"),
    ],
)
def test_quantities(value: float, unit: str, decimals: int, text: str) -> None:
    assert quantity(value, unit, decimals) == text


def test_a_pipe_gets_one_line_per_feedback() -> None:
    console = plain_console()
    report = follow(FakeRobot(), console)
    assert report.outcome is WalkOutcome.ARRIVED
    assert shown(console).splitlines() == [
        f"Distance left: {left} m, current speed: 0.50 m/s"
        for left in ("5.00", "3.50", "2.00", "0.50")
    ]


def test_a_terminal_gets_a_line_per_feedback_and_a_live_bar_that_fills() -> None:
    console = terminal()
    follow(FakeRobot(), console)
    output = shown(console)
    assert "\x1b[?25l" in output  # the cursor is hidden …
    assert output.endswith("\x1b[?25h")  # … and given back
    for left in ("5.00 m left", "3.50 m left", "0.00 m left", "0.50 m/s"):
        assert left in output
    assert "━" in output
    for left in ("5.00", "3.50", "2.00", "0.50"):
        assert output.count(f"Distance left: {left} m, current speed: 0.50 m/s") == 1


def test_no_color_is_honoured() -> None:
    coloured, plain = terminal(), terminal(no_color=True)
    follow(FakeRobot(), coloured)
    follow(FakeRobot(), plain)
    colour = re.compile(r"\x1b\[[39]\dm")
    done, to_do = "\x1b[36m━", "\x1b[90m━"
    assert done in shown(coloured)
    assert to_do in shown(coloured)
    assert not colour.search(shown(plain))


def test_a_dumb_terminal_gets_lines() -> None:
    console = Console(file=io.StringIO(), force_terminal=True, width=80, _environ={"TERM": "dumb"})
    follow(FakeRobot(), console)
    assert shown(console).count("Distance left: ") == 4


def test_a_way_that_got_longer_does_not_break_the_bar() -> None:
    console = terminal()
    with walk_view(console, 2.0) as view:
        view.feedback(3.5, math.nan)
    assert "3.50 m left" in shown(console)
    assert "at unknown" in shown(console)


def test_stopping_is_noticed_within_one_look() -> None:
    robot = FakeRobot()
    report = follow(robot, plain_console(), stop_after=2.0)
    assert report.outcome is WalkOutcome.CANCELLED
    assert 2.0 <= report.duration <= 2.0 + POLL_TIME
    assert robot.walks[0].cancels == 1


def test_a_robot_that_does_not_confirm_a_cancellation_is_lost() -> None:
    robot = FakeRobot(scripts=[WalkScript(obeys=False)])
    report = follow(robot, plain_console(), stop_after=2.0)
    assert report.outcome is WalkOutcome.DISCONNECTED
    assert "did not confirm within 5 s" in report.message
    assert report.duration == pytest.approx(2.0 + CANCEL_DEADLINE, abs=2 * POLL_TIME)
    assert robot.walks[0].cancels == 1


def test_a_vanished_server_is_lost_as_the_client_says() -> None:
    robot = FakeRobot(scripts=[WalkScript(Turn.VANISHES, 4.0, "the action server is gone")])
    report = follow(robot, plain_console())
    assert (report.outcome, report.message) == (
        WalkOutcome.DISCONNECTED,
        "the action server is gone",
    )
    assert robot.clock.monotonic() < 6.0


def test_a_frozen_robot_is_lost_within_seconds_and_told_to_stop() -> None:
    robot = FakeRobot(scripts=[WalkScript(Turn.FREEZES, after=4.0)])
    report = follow(robot, plain_console())
    assert report.outcome is WalkOutcome.DISCONNECTED
    assert "has not answered for 6 s" in report.message
    assert robot.clock.monotonic() <= 4.0 + SILENCE_LIMIT + 1.0
    assert report.distance == pytest.approx(1.5)  # as the last feedback, at 3 s, had it
    assert robot.walks[0].cancels == 1


class CountingWalk:
    """A walk that knows it has ended, but never gets its report."""

    def __init__(self) -> None:
        self.asked = 0

    def next_feedback(self, timeout: float) -> float | None:
        self.asked += 1
        return None

    def report(self) -> WalkReport | None:
        return None

    def cancel(self) -> None:
        raise RobotUnavailableError("gone")


def test_a_client_that_returns_at_once_is_not_asked_in_circles() -> None:
    clock = SteppedClock()
    walk = CountingWalk()
    report = follow_walk(
        walk,
        FakeRobot(),
        LineView(plain_console()),
        total=1.0,
        wants_to_stop=lambda: False,
        clock=clock,
    )
    assert report.outcome is WalkOutcome.DISCONNECTED
    assert walk.asked <= SILENCE_LIMIT / POLL_TIME + 2


class QuietWalk:
    """A walk of 30 s without a single feedback, on a robot that moves all the time."""

    def __init__(self, clock: SteppedClock) -> None:
        self._clock = clock

    def next_feedback(self, timeout: float) -> float | None:
        self._clock.sleep(timeout)
        return None

    def report(self) -> WalkReport | None:
        if self._clock.monotonic() < 30.0:
            return None
        return WalkReport(WalkOutcome.ARRIVED, distance=15.0, duration=30.0, message="")

    def cancel(self) -> None:
        raise AssertionError("it was not asked for")


class MovingRobot(FakeRobot):
    def state(self, timeout: float = 5.0) -> RobotState:
        return RobotState(x=0.5 * self.clock.monotonic(), y=0.0, speed=0.5, dirt=0.0)


def test_a_robot_that_moves_is_not_lost_for_want_of_feedback() -> None:
    clock = SteppedClock()
    report = follow_walk(
        QuietWalk(clock),
        MovingRobot(clock=clock),
        LineView(plain_console()),
        total=15.0,
        wants_to_stop=lambda: False,
        clock=clock,
    )
    assert report.outcome is WalkOutcome.ARRIVED


class StandingWalk(QuietWalk):
    """A walk of 30 s on a robot that stands: it thinks about a way around, and says so."""

    def next_feedback(self, timeout: float) -> float | None:
        self._clock.sleep(4.0)
        return 15.0


def test_a_robot_that_tells_is_not_lost_for_standing() -> None:
    clock = SteppedClock()
    report = follow_walk(
        StandingWalk(clock),
        FakeRobot(clock=clock),
        LineView(plain_console()),
        total=15.0,
        wants_to_stop=lambda: False,
        clock=clock,
    )
    assert report.outcome is WalkOutcome.ARRIVED
