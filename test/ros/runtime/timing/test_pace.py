"""How fast the simulation goes, by a clock of the test's own."""

import threading

import pytest

from roomba.configuration.nodes import PaceConfig
from roomba_ros.runtime.timing.pace import Pace

TICK, SPEED = 0.05, 5.0
PERIOD = TICK / SPEED
PART = "/mission_node"


class Wall:
    """A wall clock on which only sleeping takes time; ``on_sleep`` happens meanwhile."""

    def __init__(self) -> None:
        self.now = 100.0
        self.events: list[tuple[float, float]] = []
        self.dead: set[str] = set()
        self.pace = Pace(
            TICK,
            SPEED,
            PaceConfig(),
            lambda part: part not in self.dead,
            lambda: self.now,
            self.sleep,
            self.wait_for,
        )

    def wait_for(self, news: threading.Event, seconds: float) -> None:
        """Let time pass until there is news, at most so many seconds."""
        until = self.now + seconds
        if self.events and self.events[0][0] < until:
            self.sleep(self.events[0][0] - self.now)
        if not news.is_set():
            self.sleep(until - self.now)

    def sleep(self, seconds: float) -> None:
        self.now += seconds
        while self.events and self.events[0][0] <= self.now:
            self.pace.heard(PART, self.events.pop(0)[1])

    def ticks(self, count: int, robot: float = 0.0) -> float:
        """Let ticks pass at a time of the robot's clock; return how long that took."""
        began = self.now
        for _ in range(count):
            self.pace.wait(robot, lambda: False)
        return self.now - began


def test_it_is_as_fast_as_asked_for() -> None:
    wall = Wall()
    assert wall.ticks(100) == pytest.approx(1.0)
    # A tick that took longer is made up for.
    wall.now += 0.2
    assert wall.ticks(100) == pytest.approx(0.8)
    assert not wall.pace.is_late


def test_far_behind_it_goes_on_slower_and_says_so() -> None:
    wall = Wall()
    wall.now += 2.0
    assert wall.ticks(1) == 0.0
    assert wall.pace.is_late
    assert wall.ticks(100) == pytest.approx(1.0)


def test_a_robot_that_is_late_is_waited_for() -> None:
    wall = Wall()
    wall.pace.heard(PART, 7.6)
    assert wall.ticks(1, robot=7.65) == pytest.approx(PERIOD)
    wall.events = [(wall.now + 0.2034, 8.0)]
    # No longer than until it is heard.
    assert wall.ticks(1, robot=8.1) == pytest.approx(0.2034, abs=1e-9)


def test_what_is_heard_while_it_looks_ends_the_wait() -> None:
    wall = Wall()
    wall.pace.heard(PART, 7.6)
    looks: list[float] = []

    def is_there(part: str) -> bool:
        # Heard just after the look at how far it is, before the wait begins.
        if not looks:
            wall.pace.heard(PART, 8.0)
        looks.append(wall.now)
        return True

    wall.pace = Pace(
        TICK, SPEED, PaceConfig(), is_there, lambda: wall.now, wall.sleep, wall.wait_for
    )
    wall.pace.heard(PART, 7.6)
    assert wall.ticks(1, robot=8.1) == pytest.approx(PERIOD)
    assert looks


def test_one_that_says_nothing_any_more_is_not() -> None:
    wall = Wall()
    wall.pace.heard(PART, 7.6)
    assert 1.9 < wall.ticks(1, robot=8.1) < 2.1
    assert wall.ticks(11, robot=8.15) == pytest.approx(11 * TICK, abs=TICK)


def test_each_part_is_waited_for() -> None:
    wall = Wall()
    wall.pace.heard("pose", 8.1)
    wall.pace.heard(PART, 7.6)
    wall.events = [(wall.now + 0.2, 8.0)]
    assert wall.ticks(1, robot=8.1) == pytest.approx(0.2, abs=0.002)


def test_a_dead_part_is_not_waited_for() -> None:
    wall = Wall()
    wall.pace.heard(PART, 7.6)
    wall.dead.add(PART)
    assert wall.ticks(1, robot=8.1) == pytest.approx(PERIOD)
    wall.pace.heard("pose", 7.7)
    assert 1.9 < wall.ticks(1, robot=8.1) < 2.1


def test_while_one_is_gone_it_goes_no_faster_than_real_time() -> None:
    wall = Wall()
    wall.pace.heard(PART, 8.1)
    assert wall.ticks(100, robot=8.1) == pytest.approx(100 * PERIOD)
    wall.dead.add(PART)
    # The first one was due already.
    assert wall.ticks(101, robot=8.1) == pytest.approx(PERIOD + 100 * TICK)
    # There again it is not back before it is heard.
    wall.dead.clear()
    assert wall.ticks(100, robot=8.1) == pytest.approx(100 * TICK)
    wall.pace.heard(PART, 8.2)
    assert wall.ticks(101, robot=8.2) == pytest.approx(TICK + 100 * PERIOD)


def test_who_does_not_come_back_for_a_minute_counts_no_more() -> None:
    wall = Wall()
    wall.pace.heard(PART, 8.1)
    wall.dead.add(PART)
    assert wall.ticks(int(60.0 / TICK) + 2, robot=8.1) > 59.0
    assert wall.ticks(100, robot=8.1) == pytest.approx(100 * PERIOD)


def test_what_was_asked_for_to_be_slow_stays_so() -> None:
    wall = Wall()
    wall.pace = Pace(
        TICK, 0.5, PaceConfig(), lambda part: False, lambda: wall.now, wall.sleep, wall.wait_for
    )
    wall.pace.heard(PART, 8.1)
    assert wall.ticks(100, robot=8.1) == pytest.approx(100 * TICK / 0.5)


def test_a_part_that_answered_since_the_last_tick_is_not_waited_for() -> None:
    # Of a place that it knows no newer one is told before the clock goes on.
    wall = Wall()
    wall.pace.heard(PART, 7.6)
    wall.events = [(wall.now + 0.05 * count, 7.6) for count in range(1, 100)]
    assert wall.ticks(1, robot=8.1) == pytest.approx(0.05, abs=0.002)
    # It must answer each tick.
    assert wall.ticks(4, robot=8.1) == pytest.approx(0.2, abs=0.01)


def test_a_part_never_heard_or_of_another_clock_is_not_waited_for() -> None:
    wall = Wall()
    assert wall.ticks(10, robot=8.1) == pytest.approx(10 * PERIOD)
    for stamp in (500.0, 1.0):
        wall.pace.heard(PART, stamp)
        assert wall.ticks(1, robot=50.0) == pytest.approx(PERIOD)


def test_told_to_end_it_waits_no_more() -> None:
    wall = Wall()
    wall.pace.heard(PART, 7.6)
    began = wall.now
    wall.pace.wait(8.1, lambda: True)
    assert wall.now - began == pytest.approx(PERIOD)
