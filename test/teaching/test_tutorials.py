"""Every tutorial comes out as it is written, typed by a reader who knows nothing else."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from fixtures.graph import RosGraph
from fixtures.tutorial import ROOT, Reader

TUTORIALS = ROOT / "docs" / "tutorials"
ON_ONE_ROBOT = ("the_reports_robot", "your_own_node", "a_bag_of_your_robot")
"""In this order by the robot that the first one launches: each of them says so."""
WITHOUT_ROS = ("a_coverage_stage", "a_home_of_your_own", "a_policy", "how_a_clean_is_proven")


def test_all_tutorials_are_read() -> None:
    pages = {path.stem for path in TUTORIALS.glob("*.md")}
    assert pages == {"README", *ON_ONE_ROBOT, *WITHOUT_ROS}


def test_what_is_done_with_a_robot_that_runs(tmp_path: Path) -> None:
    graph = RosGraph(tmp_path)
    with Reader(tmp_path, graph.environment) as reader:
        for name in ON_ONE_ROBOT:
            reader.read(TUTORIALS / f"{name}.md")


@pytest.mark.parametrize("name", WITHOUT_ROS)
def test_what_is_done_without_ros(name: str, tmp_path: Path) -> None:
    with Reader(tmp_path, os.environ) as reader:
        reader.read(TUTORIALS / f"{name}.md")
