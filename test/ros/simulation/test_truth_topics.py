"""The truth is published by the robot's clock, but no oftener than people can follow."""

from __future__ import annotations

import time
from typing import Any

import pytest
from fixtures.nodes.lockstep import Lockstep
from fixtures.robots.missions import HOME

from roomba.configuration.nodes import PeriodsConfig
from roomba.world.simulator import Simulator
from roomba_ros.simulation.truth_topics import TruthTopics

PERIODS = PeriodsConfig(true_pose_wall=0.04, true_dirt_wall=0.5)


@pytest.mark.parametrize(
    ("speed", "poses", "dirts"), [(1.0, 200, 10), (20.0, 13, 1), (0.5, 200, 10)]
)
def test_pose_and_dirt_are_told_by_the_robots_clock_but_not_oftener_by_that_of_people(
    monkeypatch: pytest.MonkeyPatch, speed: float, poses: int, dirts: int
) -> None:
    now = 1000.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    simulator = Simulator(HOME)
    heard: dict[str, list[Any]] = {"sim/pose": [], "sim/dirt": [], "sim/home": []}
    with Lockstep().installed() as lockstep:
        for topic, messages in heard.items():
            lockstep.hear(topic, messages.append)
        truth = TruthTopics(simulator, PERIODS)
        for tick in range(1, 201):
            now += 0.05 / speed
            truth.tell(0.05 * tick, tick, simulator.observe())
        lockstep.deliver()
    assert [len(messages) for messages in heard.values()] == [poses, dirts, 1]


def test_a_pose_that_is_not_heard_is_not_told() -> None:
    simulator = Simulator(HOME)
    heard: list[Any] = []
    with Lockstep().installed() as lockstep:
        truth = TruthTopics(simulator, PERIODS)
        truth.tell(0.05, 20, simulator.observe())
        lockstep.hear("sim/pose", heard.append)
        truth.tell(0.1, 21, simulator.observe())
        lockstep.deliver()
    assert [message.header.stamp.to_sec() for message in heard] == [0.1]
