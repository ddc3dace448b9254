"""The node classes in lockstep clean as the headless robot does: same home, same seed."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from fixtures.forked import run_forked
from fixtures.lockstep import Lockstep
from numpy.typing import NDArray
from roomba_robot.msg import (
    CleanActionGoal,
    CleanActionResult,
    CleanGoal,
    CleanResult,
    Rectangle,
    VacuumState,
)

from roomba.files.shipped import HOMES
from roomba.headless.cleaner import HeadlessMission
from roomba.mission.cleaning.request import CleanOutcome, CleanRequest
from roomba.vocabulary import CleanMode
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator
from roomba_ros.dirt.dirt_pub_node import DirtPubNode
from roomba_ros.mission.mission_node import MissionNode
from roomba_ros.position.position_pub_node import PositionPubNode
from roomba_ros.simulation import home_sim_node
from roomba_ros.speed.speed_pub_node import SpeedPubNode
from roomba_ros.walking.walk_to_point_action_server import WalkToPointActionServer

HOME, SEED = "studio", 1
TICK = 0.05
ZONE = (1.0, -0.5, 2.5, 0.7)
"""m; floor of the studio."""
GOAL = CleanGoal(mode=CleanGoal.ZONES, zones=[Rectangle(*ZONE)])
LONGEST = 600.0
"""s of the robot's clock; the clean takes a fifth of it."""


@dataclass(frozen=True)
class Outcome:
    """How a clean ended: shares 0..1, m."""

    is_completed: bool
    is_docked: bool
    share: float
    hits: int
    way: NDArray[np.float64]


def in_lockstep(folder: Path) -> Outcome:
    """Clean with the node classes."""
    worlds: list[Simulator] = []

    class Kept(Simulator):
        def __init__(self, *arguments: object, **named: object) -> None:
            super().__init__(*arguments, **named)  # type: ignore[arg-type]
            worlds.append(self)

    lockstep = Lockstep()
    results: list[CleanActionResult] = []
    states: list[VacuumState] = []
    with lockstep.installed(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(home_sim_node, "Simulator", Kept)
        folders = {f"{name}_folder": str(folder / name) for name in ("memory", "zones", "rooms")}
        lockstep.start(
            "home_sim_node", home_sim_node.HomeSimNode(), home=HOME, seed=SEED, clock=False
        )
        lockstep.start("position_pub_node", PositionPubNode(), **folders)
        lockstep.start("walk_to_point_action_server_node", WalkToPointActionServer())
        lockstep.start("mission_node", MissionNode(), **folders)
        lockstep.start("speed_pub_node", SpeedPubNode())
        lockstep.start("dirt_pub_node", DirtPubNode())
        lockstep.hear("/vacuum/state", states.append)
        lockstep.hear("/clean/result", results.append)
        while not states or states[-1].phase != "docked":
            lockstep.tick(TICK)
            assert lockstep.now < 1100.0, lockstep.logged
        lockstep.publish("/clean/goal", CleanActionGoal(goal=GOAL))
        way = []
        began = lockstep.now
        while not results:
            lockstep.tick(TICK)
            way.append((worlds[0].pose.x, worlds[0].pose.y))
            assert lockstep.now < began + LONGEST, states[-1]
    result = results[0].result
    return Outcome(
        result.outcome == CleanResult.COMPLETED,
        states[-1].phase == "docked",
        result.covered / result.wanted,
        int(worlds[0].numbers["hits"]),
        np.array(way),
    )


def headless() -> Outcome:
    """Clean with the headless robot, each tick by the ordinary classes."""
    robot = HeadlessMission(load_home(HOME, HOMES), seed=SEED, longest_burst=0)
    record = robot.clean(CleanRequest(CleanMode.ZONES, zones=(ZONE,)))
    return Outcome(
        record.result.outcome is CleanOutcome.COMPLETED,
        robot.is_home,
        record.result.covered / record.result.wanted,
        record.hits,
        record.poses[:, 1:3],
    )


def off(way: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far each place of a way is from the nearest of another, m."""
    places = (np.hypot(*(other - place).T).min() for place in way)
    return np.fromiter(places, np.float64)


def test_the_nodes_clean_as_the_headless_robot_does(tmp_path: Path) -> None:
    def compare() -> None:
        plain, nodes = headless(), in_lockstep(tmp_path / "first")
        assert (plain.is_completed, plain.is_docked, plain.hits) == (True, True, 0)
        assert (nodes.is_completed, nodes.is_docked, nodes.hits) == (True, True, 0)
        assert nodes.share == pytest.approx(plain.share, abs=0.002)
        # The goal is heard a tick later; and until it turns nothing was corrected by a scan.
        for there, here in zip(plain.way[:60], nodes.way[1:61], strict=True):
            assert math.dist(there, here) < 0.01
        # Later they aim by poses that are half a tick apart, and come to corners at other times.
        assert off(nodes.way, plain.way).max() < 0.02
        assert np.median(off(nodes.way, plain.way)) < 0.005
        assert np.array_equal(in_lockstep(tmp_path / "again").way, nodes.way)

    run_forked(compare)
