"""Low things, felt and never seen: published, accepted as a zone, ignored, remembered.

The nodes are ticked in lockstep; no graph is needed.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from fixtures.nodes.node_compositions import NodeRobot, started
from fixtures.robots.compositions import Case
from fixtures.robots.missions import HOME
from fixtures.waiting import wait_until
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import LowThingArray, Zone
from roomba_robot.srv import IgnoreLowThingRequest, SetZoneRequest

from roomba.grid import OccupancyMap
from roomba.perception.rooms.low_things import LowThing, LowThings
from roomba.storage.low_things import load_low_things, save_low_things
from roomba.storage.map_bound import map_digest
from roomba_ros.convert.common import map_of

CASE = Case(HOME, sensors="ideal")
OFTEN, SELDOM = LowThing(0.6, 0.6, 0.9, 0.6, 3), LowThing(1.5, 0.6, 1.5, 0.6, 2)
IGNORED = LowThing(0.6, 1.2, 0.6, 1.2, 7)
DEADLINE = 20.0
"""s of wall time for what the node does in the background."""


class Offered:
    """A robot that stands, and the zones that it offers."""

    def __init__(self, robot: NodeRobot) -> None:
        self.robot = robot
        self.maps: list[OccupancyGrid] = []
        self.told: list[LowThingArray] = []
        robot.lockstep.hear("/map", self.maps.append)
        robot.lockstep.hear("/low_things", self.told.append)

    def until(self, holds: Callable[[], bool], what: str) -> None:
        def ticked() -> bool:
            self.robot.tick()
            return holds()

        wait_until(ticked, DEADLINE, what)

    def count(self) -> int:
        """How many are offered by the newest message; -1 before it."""
        return len(self.told[-1].things) if self.told else -1


def known_map(folder: Path) -> OccupancyMap:
    """The map as the mission node hears it."""
    with started(CASE, folder) as robot:
        first = Offered(robot)
        first.until(lambda: first.count() == 0 and bool(first.maps), "no offer at first")
        return map_of(first.maps[-1])


def test_zones_are_offered_taken_ignored_and_remembered(tmp_path: Path) -> None:
    known = known_map(tmp_path)
    path = tmp_path / "zones" / f"{map_digest(known)[:16]}.low_things.yaml"
    save_low_things(LowThings((OFTEN, SELDOM, IGNORED)), known, path)
    with started(CASE, tmp_path) as robot:
        now, call = Offered(robot), robot.lockstep.call
        now.until(lambda: now.count() == 2, "two offers")
        first = now.told[-1].things[0]
        assert (first.times, len(first.corners)) == (3, 4)
        refused = call("/ignore_low_thing", IgnoreLowThingRequest(5.0, 5.0))
        assert not refused.success
        assert "something that was felt" in refused.message
        assert call("/ignore_low_thing", IgnoreLowThingRequest(0.6, 1.2)).success
        now.until(lambda: now.count() == 1, "one offer")
        zone = Zone("cable", Zone.NO_GO, first.corners)
        assert call("/set_zone", SetZoneRequest(zone)).success
        now.until(lambda: now.count() == 0, "no offer")
        now.until(
            lambda: any(thing.is_ignored for thing in load_low_things(path, known).all), "saved"
        )
    with started(CASE, tmp_path) as robot:
        again = Offered(robot)
        again.until(lambda: again.count() == 0, "no offer any more")
        assert len(load_low_things(path, known).all) == 3
