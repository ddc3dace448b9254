from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.rooms import room_home

from roomba.configuration.body import HealthConfig
from roomba.world.health import Level, PartHealth, health_of
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator

HEALTH = HealthConfig()
WHOLE = np.full(360, 2.0, np.float32)


def seen(**changes: float) -> Observation:
    """What a robot away from its station sees, its battery changed."""
    observation = Simulator(room_home()).observe()
    return replace(observation, battery=replace(observation.battery, is_docked=False, **changes))


def part(name: str, parts: tuple[PartHealth, ...]) -> PartHealth:
    return next(found for found in parts if found.name == name)


def test_all_is_well_at_first() -> None:
    parts = health_of(seen(), WHOLE, 100.0, HEALTH)
    assert {found.level for found in parts} == {Level.OK}
    assert part("battery", parts).values["charge (0..1)"] == "1.000"


@pytest.mark.parametrize(
    ("changes", "level", "said"),
    [
        ({"level": 0.08}, Level.WARN, "go home"),
        ({"level": 0.01}, Level.ERROR, "carry"),
        ({"temperature": 50.0}, Level.WARN, "cool"),
    ],
)
def test_a_battery_in_need_says_so(changes: dict[str, float], level: Level, said: str) -> None:
    battery = part("battery", health_of(seen(**changes), WHOLE, 100.0, HEALTH))
    assert battery.level is level
    assert said in battery.message


def test_a_low_battery_on_the_station_is_no_trouble() -> None:
    observation = seen(level=0.02)
    docked = replace(observation, battery=replace(observation.battery, is_docked=True))
    assert part("battery", health_of(docked, WHOLE, 100.0, HEALTH)).level is Level.OK


@pytest.mark.parametrize(
    ("wrong", "said"), [("dropped_left", "floor"), ("stalled_right", "free it")]
)
def test_wheels_in_trouble_are_an_error(wrong: str, said: str) -> None:
    observation = seen()
    ill = replace(observation, wheels=replace(observation.wheels, **{wrong: True}))
    drive = part("drive", health_of(ill, WHOLE, 100.0, HEALTH))
    assert drive.level is Level.ERROR
    assert said in drive.message


@pytest.mark.parametrize(("lost", "level"), [(0, Level.OK), (200, Level.WARN), (360, Level.ERROR)])
def test_a_lidar_without_returns_is_noticed(lost: int, level: Level) -> None:
    ranges = WHOLE.copy()
    ranges[:lost] = np.inf
    assert part("lidar", health_of(seen(), ranges, 100.0, HEALTH)).level is level


def test_a_full_bin_wants_to_be_emptied() -> None:
    full = replace(seen(), in_bin=99.0)
    assert part("bin", health_of(full, WHOLE, 100.0, HEALTH)).message == "full: empty it"


@pytest.mark.parametrize(
    ("name", "changed", "level"),
    [
        ("battery", {"low_battery": 0.6}, Level.WARN),
        ("battery", {"low_battery": 0.6, "empty_battery": 0.55}, Level.ERROR),
        ("battery", {"hot_battery": 20.0}, Level.WARN),
        ("bin", {"full_bin": 0.3}, Level.WARN),
        ("lidar", {"most_misses": 0.05}, Level.WARN),
    ],
)
def test_from_when_on_a_part_is_in_need_is_configured(
    name: str, changed: dict[str, float], level: Level
) -> None:
    ranges = WHOLE.copy()
    ranges[:36] = np.inf
    half = replace(seen(level=0.5), in_bin=40.0)
    assert part(name, health_of(half, ranges, 100.0, HEALTH)).level is Level.OK
    assert part(name, health_of(half, ranges, 100.0, HealthConfig(**changed))).level is level
