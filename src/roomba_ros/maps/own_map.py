"""The topics of the robot's own map: the newest map, its station, its name and its state."""

from __future__ import annotations

import http.client
import threading
import xmlrpc.client
from typing import Final

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import Mapping, ZoneArray

from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.rooms.zones import Zones
from roomba.storage.map_store import MapStoreError, StoredMap
from roomba_ros.convert.common import header, map_message, pose_message
from roomba_ros.convert.rooms import zones_of
from roomba_ros.localization.topics import LocalizationTopics
from roomba_ros.maps.change_topics import ChangeTopics
from roomba_ros.maps.map_memory import MapMemory
from roomba_ros.maps.map_shelf import MapShelf
from roomba_ros.rooms.topics import RoomTopics
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.subscriptions import subscribe

_SETTLED: Final = 2.0
"""s of wall time to wait until all is saved; what the master keeps takes milliseconds."""
NO_STATION: Final = "the map is being made: put the robot on its station, so that it knows it"


class OwnMap:
    """Holds and publishes the map that the robot uses; hold ``lock`` to change several things.

    ``occupancy`` is None before there is one, ``name`` is that by which it is saved, ``message``
    what people should know or do.

    Publishes: ``map`` (OccupancyGrid, latched, with a load time of 0 while it grows),
    ``station_pose`` (PoseStamped, latched), ``mapping`` (Mapping, latched, at each change).
    Subscribes: ``zones``.
    """

    def __init__(
        self,
        place: LocalizationTopics,
        rooms: RoomTopics,
        shelf: MapShelf,
        changes: ChangeTopics,
        memory: MapMemory,
        background: Background,
    ) -> None:
        """Connect nothing yet."""
        self._place, self._rooms, self._shelf = place, rooms, shelf
        self._changes, self._memory, self._background = changes, memory, background
        self.lock = threading.RLock()
        self.occupancy: OccupancyMap | None = None
        self.station: Pose | None = None
        self.name = self.message = ""
        self._known = 0.0
        self._zones = Zones()
        self._said: tuple[object, ...] = ()

    def start(self, *, is_own: bool) -> None:
        """Connect; if the map is not the robot's own, ``mapping`` is all that is published."""
        self._is_own = is_own
        self._mapping = rospy.Publisher("mapping", Mapping, queue_size=1, latch=True)
        if is_own:
            self._publisher = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
            self._station_publisher = rospy.Publisher(
                "station_pose", PoseStamped, queue_size=1, latch=True
            )
            self._place.is_map_own = True
        subscribe("zones", ZoneArray, zones_of, self._on_zones)

    def use(self, name: str, stored: StoredMap, at: Pose | None = None) -> None:
        """Go on with a stored map; the robot is ``at`` a pose on it, or must find its place."""
        self._take(name, stored)
        if at is not None:
            self._place.go_on(stored.occupancy, at)
        else:
            self._place.use_map(stored.occupancy)
        self._tell(stored)

    def use_changed(self, name: str, stored: StoredMap) -> None:
        """Go on with a changed version of the map; the robot's pose on it stays the same."""
        self._take(name, stored)
        self._place.go_on(stored.occupancy, None)
        self._tell(stored)

    def whole(self) -> OccupancyMap:
        """Return the map; raises MapStoreError for one that is being made."""
        if self.occupancy is None or self._rooms.is_growing():
            raise MapStoreError("expected a whole map, got one that is being made; explore first")
        return self.occupancy

    def stored(self) -> StoredMap:
        """Return the map with its station and what is known of its rooms and zones.

        Raises MapStoreError for one that is being made.
        """
        occupancy = self.whole()
        if self.station is None:
            raise MapStoreError(NO_STATION)
        rooms = self._rooms.rooms
        if rooms is not None and rooms.frame != occupancy.frame:
            rooms = None
        return StoredMap(occupancy, self.station, rooms, self._zones)

    def remember(self) -> None:
        """Let a restarted node use this finished map again: by its name, if it has one."""
        if self.name:
            self._background.do("the map's name is not remembered", self._remember_name)
            self._memory.forget_whole()
        elif self.occupancy is not None and self.station is not None:
            self._memory.keep_whole(StoredMap(self.occupancy, self.station))

    def settle(self) -> None:
        """Wait, for some seconds at most, until all is saved: only then tell people that it is."""
        self._background.wait(_SETTLED)

    def _remember_name(self) -> None:
        try:
            rospy.set_param("~map", self.name)
        except (http.client.HTTPException, xmlrpc.client.Error) as error:
            rospy.logwarn("the master does not keep the map's name: %s", error)

    def tell_whole(self, occupancy: OccupancyMap) -> None:
        """Tell a map that is whole."""
        now = rospy.get_time()
        self.occupancy, self._known = occupancy, occupancy.free_area
        self._changes.begin(now, occupancy)
        self.tell_again()

    def tell_again(self) -> None:
        """Publish the map once more: nodes then look for zones that were saved for it meanwhile."""
        assert self.occupancy is not None
        self._publisher.publish(map_message(rospy.get_time(), self.occupancy, "map"))

    def tell_growing(self, now: float, occupancy: OccupancyMap) -> None:
        """Tell a map that is being made, soon."""
        self.occupancy, self._known = occupancy, occupancy.free_area
        self._background.do(
            "the map is not told",
            lambda: self._publisher.publish(map_message(now, occupancy, "map", is_growing=True)),
        )

    def tell_station(self, station: Pose | None) -> None:
        """Tell where the docked robot stands, once that is known."""
        self.station = station
        if station is not None:
            self._station_publisher.publish(pose_message(rospy.get_time(), station, "map"))

    def say(self, now: float, *, is_growing: bool) -> None:
        """Publish whose map it is and its state, if that is new."""
        said = (is_growing, self.name, round(self._known), self.message)
        if said != self._said:
            self._said = said
            self._mapping.publish(
                header(now, "map"), self._is_own, is_growing, self.name, self._known, self.message
            )

    def _take(self, name: str, stored: StoredMap) -> None:
        self._shelf.keep_beside(stored)
        self.name = name

    def _tell(self, stored: StoredMap) -> None:
        self.tell_whole(stored.occupancy)
        self.tell_station(stored.station)
        self.remember()

    def _on_zones(self, zones: Zones) -> None:
        with self.lock:
            self._zones = zones
