"""A state is published now and then, and a change of it at once, however fast the clock is."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest
from fixtures.nodes.lockstep import Lockstep
from std_msgs.msg import Int32

from roomba_ros.body.told_topic import ToldTopic

TICK = 0.05


@pytest.fixture
def ros() -> Iterator[Lockstep]:
    """Topics without a master."""
    with Lockstep().installed() as lockstep:
        yield lockstep


@pytest.fixture
def wall(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """What the wall's clock shows, s."""
    shown = [1000.0]
    monkeypatch.setattr(time, "monotonic", lambda: shown[0])
    return shown


def number_of(now: float, told: int) -> Int32:
    return Int32(told)


def tell(topic: ToldTopic[int], wall: list[float], values: list[int], speed: float = 1.0) -> None:
    for tick, value in enumerate(values):
        topic.tell(tick * TICK, tick, value)
        wall[0] += TICK / speed


def heard_of(ros: Lockstep) -> list[int]:
    heard: list[int] = []
    ros.hear("number", lambda message: heard.append(message.data))
    return heard


def test_it_is_told_every_period(ros: Lockstep, wall: list[float]) -> None:
    heard = heard_of(ros)
    tell(ToldTopic("number", Int32, 4, number_of), wall, list(range(10)))
    ros.deliver()
    assert heard == [0, 4, 8]


def test_a_change_is_told_at_once(ros: Lockstep, wall: list[float]) -> None:
    heard = heard_of(ros)
    topic = ToldTopic("number", Int32, 4, number_of, lambda told: told)
    tell(topic, wall, [5, 5, 5, 6, 6, 6, 6, 6, 6])
    ros.deliver()
    # At the beginning and when it changes; not again a tick later, but a period after that.
    assert heard == [5, 6, 6]


@pytest.mark.parametrize(("speed", "count"), [(1.0, 50), (20.0, 5)])
def test_on_a_fast_clock_the_same_is_repeated_10_times_a_second_of_wall_time(
    ros: Lockstep, wall: list[float], speed: float, count: int
) -> None:
    heard = heard_of(ros)
    tell(ToldTopic("number", Int32, 4, number_of, lambda told: told), wall, [7] * 200, speed)
    ros.deliver()
    assert len(heard) == pytest.approx(count, abs=1)


def test_on_a_fast_clock_what_is_new_each_time_is_told_each_time(
    ros: Lockstep, wall: list[float]
) -> None:
    heard = heard_of(ros)
    tell(ToldTopic("number", Int32, 1, number_of), wall, list(range(200)), 20.0)
    ros.deliver()
    assert heard == list(range(200))


def test_without_a_subscriber_no_message_is_made(ros: Lockstep, wall: list[float]) -> None:
    made: list[int] = []
    topic: ToldTopic[int] = ToldTopic("number", Int32, 1, lambda _, told: made.append(told))
    tell(topic, wall, [1, 2, 3])
    assert made == []
