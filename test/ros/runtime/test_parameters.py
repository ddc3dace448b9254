"""The report's parameters are read as often as it makes a difference."""

from __future__ import annotations

import time

import pytest
import rospy

from roomba.errors import ConfigError
from roomba_ros.runtime.parameters import LiveSeedParameters, bool_parameter, robot_run

LIMITS = {"/robot_max_speed": 0.5, "/min_cordinate": -100.0, "/max_cordinate": 100.0}


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> dict[str, float]:
    """What the master told of parameters; wall time stands at ``wall``."""
    values = {**LIMITS, "wall": 10.0}
    monkeypatch.setattr(
        rospy, "search_param", lambda name: f"/{name}" if f"/{name}" in values else None
    )
    monkeypatch.setattr(rospy, "resolve_name", lambda name: f"/{name}")
    monkeypatch.setattr(rospy, "get_param", values.__getitem__)
    monkeypatch.setattr(rospy, "get_param_cached", lambda key: values.get(key, {}))
    monkeypatch.setattr(rospy, "get_param_names", list)
    monkeypatch.setattr(time, "monotonic", lambda: values["wall"])
    return values


def test_a_change_is_obeyed_at_the_next_tick_of_real_time(told: dict[str, float]) -> None:
    parameters = LiveSeedParameters()
    told["/robot_max_speed"] = 0.3
    assert parameters.refresh().robot_max_speed == 0.5
    told["wall"] += 0.05
    assert parameters.refresh().robot_max_speed == 0.3


def test_the_guardian_looks_at_each_tick(told: dict[str, float]) -> None:
    parameters = LiveSeedParameters(guardian=True)
    told["/robot_max_speed"] = 0.3
    assert parameters.refresh().robot_max_speed == 0.3


def test_what_is_true_or_false_is_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    values: dict[str, object] = {"~yes": True, "~often": "often", "~one": 1}
    monkeypatch.setattr(rospy, "get_param", values.get)
    assert bool_parameter("~yes", False)
    assert bool_parameter("~other", True)
    for name in ("~often", "~one"):
        with pytest.raises(ConfigError, match=f"parameter {name}: expected true or false"):
            bool_parameter(name, True)


def test_a_run_is_that_of_the_robot_and_without_one_that_of_the_master(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    values = {"/run_id": "of the master"}
    monkeypatch.setattr(rospy, "get_param", values.get)
    assert robot_run() == "of the master"
    values["robot_run"] = "of the robot"
    assert robot_run() == "of the robot"
