"""The carpets that the brush felt, on ROS: kept for each map, and told."""

from __future__ import annotations

from pathlib import Path

import rospy
from roomba_robot.msg import CarpetArray

from roomba.mission.mission import Mission
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.storage.carpets import CarpetsError, load_carpets, save_carpets
from roomba.storage.map_bound import map_file_name
from roomba_ros.convert.mission import carpets_message
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.runtime.background import Background


class CarpetTopics:
    """Publishes ``carpets`` (CarpetArray, latched): carpets that the brush felt.

    They are saved whenever the robot does not clean.
    """

    def __init__(self, background: Background, folder: Path) -> None:
        """Connect nothing yet; files are kept in ``folder``, by the maps' digests."""
        self._background, self._folder = background, folder
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
            mission.carpets.recall(self._recalled(home))
            self._kept = home.digest, mission.carpets.felt
        felt = mission.carpets.felt
        if felt is not self._told:
            self._told = felt
            self._publisher.publish(carpets_message(now, felt, "map"))
        if not mission.sweeps and (home.digest, felt) != self._kept:
            self._kept = home.digest, felt
            self._keep(home, felt)

    def _recalled(self, home: KnownHome) -> FeltCarpets:
        if home.digest == GROWING:
            return FeltCarpets()
        try:
            return load_carpets(self._path(home), home.context.occupancy, rospy.logwarn)
        except CarpetsError as error:
            rospy.logwarn("carpets are felt anew: %s", error)
            return FeltCarpets()

    def _keep(self, home: KnownHome, felt: FeltCarpets) -> None:
        """Save them; a map that is being made is no map to save them for."""
        if home.digest == GROWING:
            return
        occupancy, path = home.context.occupancy, self._path(home)
        self._background.do(
            "carpets are not remembered", lambda: save_carpets(felt, occupancy, path)
        )

    def _path(self, home: KnownHome) -> Path:
        return self._folder / f"{map_file_name(home.digest)}.carpets.yaml"
