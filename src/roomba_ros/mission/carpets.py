"""The carpets that the brush felt, on ROS: kept for each map, and told."""

from __future__ import annotations

import rospy
from roomba_robot.msg import CarpetArray

from roomba.mission.mission import Mission
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba_ros.convert.rooms import carpets_message
from roomba_ros.mission.felt_on_maps import FeltOnMaps
from roomba_ros.mission.known_home import KnownHome


class CarpetTopics:
    """Publishes ``carpets`` (CarpetArray, latched): carpets that the brush felt.

    They are saved whenever the robot does not clean.
    """

    def __init__(self, memory: FeltOnMaps[FeltCarpets]) -> None:
        """Connect nothing yet."""
        self._memory = memory
        self._mission: Mission | None = None
        self._told: FeltCarpets | None = None
        self._kept: tuple[str, FeltCarpets] | None = None

    def start(self) -> None:
        """Connect."""
        self._publisher = rospy.Publisher("carpets", CarpetArray, queue_size=1, latch=True)

    def tick(self, now: float, mission: Mission, home: KnownHome) -> None:
        """Let a mission know what was felt before on its map, tell what is, and keep it."""
        if mission is not self._mission:
            self._mission = mission
            mission.carpets.recall(self._memory.recalled(home))
            self._kept = home.digest, mission.carpets.felt
        felt = mission.carpets.felt
        if felt is not self._told:
            self._told = felt
            self._publisher.publish(carpets_message(now, felt, "map"))
        if not mission.sweeps and (home.digest, felt) != self._kept:
            self._kept = home.digest, felt
            self._memory.keep(home, felt)
