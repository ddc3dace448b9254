"""Tutorials about ROS come out as they are written, by the robot that the first one launches."""

from __future__ import annotations

from pathlib import Path

from fixtures.graph import RosGraph
from fixtures.tutorial import ROOT, Reader

ON_ONE_ROBOT = ("the_reports_robot", "your_own_node", "a_bag_of_your_robot")
"""In this order; each of them says which robot it needs."""


def test_what_is_done_with_a_robot_that_runs(tmp_path: Path) -> None:
    graph = RosGraph(tmp_path)
    with Reader(tmp_path, graph.environment) as reader:
        for name in ON_ONE_ROBOT:
            reader.read(ROOT / "docs" / "tutorials" / f"{name}.md")
