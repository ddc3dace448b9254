"""Carpets that were felt: the mission node publishes and remembers them.

The nodes are ticked in lockstep; no graph is needed.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import shapely
from fixtures.homes.rooms import room_home
from fixtures.nodes.node_compositions import NodeRobot, started
from fixtures.robots.compositions import Case
from fixtures.robots.missions import STATION
from fixtures.waiting import wait_until
from roomba_robot.msg import CarpetArray, CleanActionGoal

from roomba_ros.convert.page import carpets_of

CARPET = (1.1, 0.6, 1.8, 1.3)
CASE = Case(room_home(2.1, 1.7, station=STATION, carpets=(CARPET,)), sensors="ideal")
DEADLINE = 60.0
"""s of wall time for a clean, and for what the node does in the background."""


class Felt:
    """A robot, and the carpets that it tells."""

    def __init__(self, robot: NodeRobot) -> None:
        self.robot = robot
        self.told: list[CarpetArray] = []
        robot.lockstep.hear("/carpets", self.told.append)

    def until(self, holds: Callable[[], bool], what: str) -> None:
        def ticked() -> bool:
            for _ in range(10):
                self.robot.tick()
            return holds()

        wait_until(ticked, DEADLINE, what)

    def overlap(self) -> float:
        """The share of floor in the carpet, or in those that are told, that is in both."""
        told = carpets_of(self.told[-1])
        outline = shapely.union_all([shapely.Polygon(corners) for corners in told])
        true = shapely.box(*CARPET)
        return float(outline.intersection(true).area / outline.union(true).area)


def test_they_are_told_as_they_are_felt_and_remembered(tmp_path: Path) -> None:
    with started(CASE, tmp_path) as robot:
        now = Felt(robot)
        now.until(lambda: bool(now.told), "the carpets are told")
        assert now.told[-1].carpets == []
        # A second later goals are taken.
        now.until(lambda: robot.world.time > 2.0, "it is ready")
        robot.lockstep.publish("/clean/goal", CleanActionGoal())
        now.until(lambda: bool(now.told[-1].carpets), "a part of it while it cleans")
        now.until(lambda: bool(robot.results), "the clean ends")
        assert now.overlap() > 0.7
        now.until(lambda: any(tmp_path.glob("zones/*.carpets.yaml")), "a file")
        felt = now.told[-1].carpets
    with started(CASE, tmp_path) as robot:
        again = Felt(robot)
        again.until(lambda: bool(again.told), "the carpets are told")
        assert again.told[-1].carpets == felt
