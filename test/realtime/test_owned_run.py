"""``./roomba run robot:=neato``: the whole graph over a made-up Neato at the end of its line."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import rospy
from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import CleanAction, CleanGoal, VacuumState

from roomba_ros.runtime.action_client import ActionClient


def test_it_cleans_a_home_that_it_does_not_know(graph: RosGraph, tmp_path: Path) -> None:
    link = tmp_path / "neato"
    emulate = (sys.executable, "-m", "roomba.commands.program", "emulate", "neato")
    graph.run(*emulate, "--link", str(link), "--seed", "1")
    wait_until(link.exists, 60.0, "the made-up robot")
    run = graph.start_run("robot:=neato", f"port:={link}")
    wait_until(
        lambda: "/clean/cancel" in graph.system_state()[1] or run.status is not None,
        START_DEADLINE,
        "all nodes are up",
        pause=0.1,
    )
    assert run.status is None, run.output
    probe = Probe(graph)
    docked = probe.next("/vacuum/state", VacuumState, 60.0)
    assert docked.phase == "docked", run.output
    station = probe.next("/station_pose", PoseStamped, 60.0).pose
    # It stands with its back to the station, where its map begins, and looks along x.
    assert math.hypot(station.position.x, station.position.y) < 0.1
    assert abs(station.orientation.z) > 0.99
    clean = ActionClient("clean", CleanAction)
    wait_until(lambda: clean.wait_for_server(rospy.Duration(0.01)), 40.0, "a server of cleans")
    clean.send_goal(CleanGoal())
    probe.hear("/vacuum/state", VacuumState)
    wait_until(
        lambda: probe.newest["/vacuum/state"].covered > 0.3,
        60.0,
        lambda: f"some clean floor: {probe.newest['/vacuum/state']}\n{run.output}",
    )
    grid = probe.next("/map", OccupancyGrid)
    free = sum(value == 0 for value in grid.data) * grid.info.resolution**2
    assert free > 4.0
    assert float(str(graph.param("/robot_max_speed"))) == 0.3
