"""A run has the parameters of its launch file, and none of the run before on the same master."""

from __future__ import annotations

import os
from typing import Any

import pytest
import rosgraph
from fixtures.graph import RosGraph

from roomba_ros.supervision.launch_parameters import set_parameters

OWNED = {"/use_sim_time": False, "/robot_config": "neato", "/driver/port": "/dev/ttyACM0"}
SIMULATED = {"/use_sim_time": True, "/home_sim_node/home": "flat"}


def on(graph: RosGraph, parameters: dict[str, Any], run_id: str = "of a run") -> rosgraph.Master:
    """Set them on a master; return it."""
    os.environ.update(graph.environment)
    set_parameters(parameters, run_id)
    return rosgraph.Master("/test")


def test_nothing_of_the_run_before_counts_but_what_people_have_set(graph: RosGraph) -> None:
    graph.set_param("/mission_config", "mine.yaml")
    on(graph, OWNED)
    master = on(graph, SIMULATED)
    assert not master.hasParam("/robot_config")
    assert not master.hasParam("/driver/port")
    assert master.getParam("/use_sim_time") is True
    assert master.getParam("/home_sim_node/home") == "flat"
    assert master.getParam("/mission_config") == "mine.yaml"
    master = on(graph, OWNED)
    assert not master.hasParam("/home_sim_node/home")
    assert master.getParam("/robot_config") == "neato"


def test_the_robot_in_another_namespace_keeps_its_own(
    graph: RosGraph, monkeypatch: pytest.MonkeyPatch
) -> None:
    on(graph, {"/robot_config": "neato"})
    monkeypatch.setenv("ROS_NAMESPACE", "/other")
    master = on(graph, {"/other/robot_config": "create2"})
    assert master.getParam("/robot_config") == "neato"


def test_the_run_of_a_master_stays(graph: RosGraph) -> None:
    on(graph, {}, "the first")
    assert on(graph, {}, "the second").getParam("/run_id") == "the first"
