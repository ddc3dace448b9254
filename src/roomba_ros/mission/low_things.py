"""What the bumper felt and the lidar never saw, on ROS: kept for each map, and offered as zones."""

from __future__ import annotations

import threading

import rospy
from roomba_robot.msg import LowThingArray
from roomba_robot.srv import IgnoreLowThing, IgnoreLowThingRequest, IgnoreLowThingResponse

from roomba.mission.mission import Mission
from roomba.perception.rooms.low_things import LowThings
from roomba_ros.convert.rooms import low_things_message
from roomba_ros.mission.felt_on_maps import FeltOnMaps
from roomba_ros.mission.known_home import KnownHome


class LowThingTopics:
    """Publishes ``low_things`` (LowThingArray, latched): no-go zones that are offered.

    Services: ``ignore_low_thing`` (IgnoreLowThing). What was felt is saved at once.
    """

    def __init__(self, memory: FeltOnMaps[LowThings]) -> None:
        """Connect nothing yet."""
        self._memory = memory
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
                self._kept = self._memory.recalled(home)
                mission.obstacles.low = self._kept
            if mission.obstacles.low is not self._kept or home.digest != self._digest:
                self._kept, self._digest = mission.obstacles.low, home.digest
                self._memory.keep(home, self._kept)
        said = (self._kept, mission.context.zones)
        if said != self._told:
            self._told = said
            offers = mission.obstacles.offered_zones(mission.context.zones)
            self._publisher.publish(low_things_message(now, offers, "map"))

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
