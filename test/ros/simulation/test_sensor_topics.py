"""The simulated body publishes what any body does, and besides what it alone measures."""

from __future__ import annotations

import time
from typing import Any

import pytest
from fixtures.homes.worlds import NOISY
from fixtures.nodes.lockstep import Lockstep
from fixtures.robots.missions import HOME
from roomba_robot.msg import HazardDetection
from sensor_msgs.msg import BatteryState

from roomba.geometry import Twist
from roomba.world.engine.state.arrays import Fault
from roomba.world.simulator import Simulator
from roomba_ros.simulation.sensor_topics import SensorTopics


@pytest.mark.parametrize(("speed", "bumpers"), [(1.0, 50), (0.5, 50), (20.0, 5)])
def test_a_bumper_is_told_5_times_a_second_but_no_oftener_than_10_times_by_the_wall(
    monkeypatch: pytest.MonkeyPatch, speed: float, bumpers: int
) -> None:
    now = 1000.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    simulator = Simulator(HOME, NOISY, seed=1)
    heard: list[Any] = []
    odometry: list[Any] = []
    with Lockstep().installed() as lockstep:
        lockstep.hear("bumper", heard.append)
        lockstep.hear("body", odometry.append)
        topics = SensorTopics(NOISY, simulator, "robot")
        for tick in range(1, 201):
            now += 0.05 / speed
            topics.tell(0.05 * tick, tick, simulator.observe())
        lockstep.deliver()
        assert len(heard) == pytest.approx(bumpers, abs=1)
        assert len(odometry) == 200
        simulator.inject(Fault.BUMPER_STUCK, 1.0)
        simulator.step(Twist(), 0.05)
        topics.tell(10.05, 201, simulator.observe())
        lockstep.deliver()
    assert heard[-1].is_left_pressed or heard[-1].is_right_pressed


def test_it_tells_the_battery_as_measured_and_a_wheel_that_is_held() -> None:
    simulator = Simulator(HOME, NOISY, seed=1)
    batteries: list[Any] = []
    hazards: list[Any] = []
    with Lockstep().installed() as lockstep:
        lockstep.hear("battery_state", batteries.append)
        lockstep.hear("hazard_detection", hazards.append)
        topics = SensorTopics(NOISY, simulator, "robot")
        first = simulator.observe()
        topics.tell(10.0, 1, first)
        simulator.inject(Fault.STALL_LEFT, 1.0)
        for _ in range(20):
            simulator.step(Twist(-0.2), 0.05)
        topics.tell(11.0, 2, simulator.observe())
        lockstep.deliver()
    assert HazardDetection.STALL in [hazard.type for hazard in hazards[-1].detections]
    assert HazardDetection.STALL not in [hazard.type for hazard in hazards[0].detections]
    assert batteries[0].voltage == pytest.approx(first.battery.voltage)
    assert batteries[0].power_supply_health == BatteryState.POWER_SUPPLY_HEALTH_GOOD
