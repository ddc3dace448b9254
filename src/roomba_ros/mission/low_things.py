"""What the bumper felt and the lidar never saw, on ROS: kept for each map, and offered as zones."""

from __future__ import annotations

import threading
from pathlib import Path

import rospy
from roomba_robot.msg import LowThingArray
from roomba_robot.srv import IgnoreLowThing, IgnoreLowThingRequest, IgnoreLowThingResponse

from roomba.mission.mission import Mission
from roomba.perception.rooms.low_things import LowThings
from roomba.storage.low_things import LowThingsError, load_low_things, save_low_things
from roomba.storage.map_bound import map_file_name
from roomba_ros.convert.mission import low_things_message
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.runtime.background import Background


class LowThingTopics:
    """Publishes ``low_things`` (LowThingArray, latched): no-go zones that are offered.

    Services: ``ignore_low_thing`` (IgnoreLowThing). What was felt is saved at once.
    """

    def __init__(self, background: Background, folder: Path) -> None:
        """Connect nothing yet; files are kept in ``folder``, by the maps' digests."""
        self._background, self._folder = background, folder
        self._lock = threading.Lock()
        self._mission: Mission | None = None
        self._digest = ""
        self._kept = LowThings()
        self._told: tuple[object, ...] = ()

    def start(self) -> None:
        """Connect."""
        self._publisher = rospy.Publisher("low_things", LowThingArray, queue_size=1, latch=True)
        rospy.Service("ignore_low_thing", IgnoreLowThing, self._on_ignore)

    def tick(self, now: float, mission: Mission, home: KnownHome) -> None:
        """Let a mission know what was felt before on its map, keep what it feels, and tell."""
        with self._lock:
            if mission is not self._mission:
                self._mission, self._digest = mission, home.digest
                self._kept = self._recalled(home)
                mission.obstacles.low = self._kept
            if mission.obstacles.low is not self._kept or home.digest != self._digest:
                self._kept, self._digest = mission.obstacles.low, home.digest
                self._keep(home)
        said = (self._kept, mission.context.zones)
        if said != self._told:
            self._told = said
            offers = mission.obstacles.offered_zones(mission.context.zones)
            self._publisher.publish(low_things_message(now, offers, "map"))

    def _recalled(self, home: KnownHome) -> LowThings:
        if home.digest == GROWING:
            return LowThings()
        try:
            return load_low_things(self._path(), home.context.occupancy, rospy.logwarn)
        except LowThingsError as error:
            rospy.logwarn("what was felt before is felt anew: %s", error)
            return LowThings()

    def _keep(self, home: KnownHome) -> None:
        """Save what was felt; a map that is being made is no map to save it for."""
        if home.digest == GROWING:
            return
        things, occupancy, path = self._kept, home.context.occupancy, self._path()
        self._background.do(
            "what was felt is not remembered", lambda: save_low_things(things, occupancy, path)
        )

    def _path(self) -> Path:
        return self._folder / f"{map_file_name(self._digest)}.low_things.yaml"

    def _on_ignore(self, request: IgnoreLowThingRequest) -> IgnoreLowThingResponse:
        with self._lock:
            if self._mission is None:
                return IgnoreLowThingResponse(False, "the robot knows no map yet; try again")
            obstacles = self._mission.obstacles
            try:
                obstacles.low = obstacles.low.ignoring(request.x, request.y)
            except ValueError as error:
                return IgnoreLowThingResponse(False, str(error))
        return IgnoreLowThingResponse(True, "no zone is offered there any more")
