"""The robot's own maps on ROS: made, told, saved, recognised, and changed when people agree."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Final

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import DockStatus, Mapping, ZoneArray
from roomba_robot.srv import (
    ListMaps,
    ListMapsRequest,
    ListMapsResponse,
    NameMap,
    NameMapResponse,
)
from std_srvs.srv import Trigger, TriggerResponse

from roomba.config import RobotConfig
from roomba.errors import ConfigError, RoombaError
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.map_store import MapStoreError, StoredMap
from roomba.perception.estimate import Estimate
from roomba.perception.rooms_refit import refitted
from roomba.perception.zones import Zones, ZonesError
from roomba_ros.background import Background
from roomba_ros.change_topics import ChangeTopics
from roomba_ros.convert import header, map_message, pose_message
from roomba_ros.convert_mission import zone_of
from roomba_ros.floor_search import FloorSearch
from roomba_ros.localization_topics import LocalizationTopics
from roomba_ros.map_maker import MapMaker
from roomba_ros.map_shelf import MapShelf
from roomba_ros.parameters import read_mapping_config
from roomba_ros.room_topics import RoomTopics

GIVEN: Final = "given"
NONE: Final = "none"
OWN: Final = "own"
"""Values of the parameter: a map that others tell; a new one of its own; the own one of this floor.
All others are names of saved maps."""
_IS_GIVEN: Final = (
    "the robot was given its map: start it with map:=none (it makes a new one), map:=own (the one "
    "it made of this floor), or map:= and the name of a saved one"
)
_EXPLORE: Final = "the map is being made: explore, or walk about"
_NO_STATION: Final = "the map is being made: put the robot on its station, so that it knows it"


class MapTopics:
    """Tells the robot's own map; when it is given one it does nothing but say so.

    Publishes: ``map`` (OccupancyGrid, latched; while it grows 1 Hz, with a load time of 0) and
    ``station_pose`` (PoseStamped, latched), both unless they are given; ``mapping`` (Mapping,
    latched, at each change), and what :class:`ChangeTopics` tells.
    Subscribes: ``dock_status``, ``zones``.
    Services: ``map/finish`` (Trigger: the map is whole as it is), ``map/save``, ``map/load``,
    ``map/remove`` (NameMap), ``map/list`` (ListMaps), ``map/update/accept``,
    ``map/update/refuse`` (Trigger).
    Parameters: ``~map`` (given, none, own, or the name of a saved map), ``mapping_config``, and
    those of :class:`MapShelf`.
    """

    def __init__(self, config: RobotConfig, place: LocalizationTopics, rooms: RoomTopics) -> None:
        """Connect nothing yet."""
        self._config, self._place, self._rooms = config, place, rooms
        self._shelf, self._changes = MapShelf(rooms), ChangeTopics(place)
        self._background = Background()
        self._lock = threading.RLock()
        self._maker = MapMaker(config, read_mapping_config(), place, self._background)
        rooms.is_growing = lambda: self._maker.is_growing
        self._map: OccupancyMap | None = None
        self._known = 0.0
        self._station: Pose | None = None
        self._name = self._message = self._trouble = ""
        self._zones = Zones()
        self._is_docked = False
        self._said: tuple[object, ...] = ()
        self._search: FloorSearch | None = None

    def start(self) -> None:
        """Read the parameters and connect; raises ConfigError."""
        self._wish = rospy.get_param("~map", GIVEN)
        if not isinstance(self._wish, str) or not self._wish:
            raise ConfigError(
                f"parameter ~map: expected given, none, own or a name, got {self._wish!r}"
            )
        self._shelf.start()
        self._changes.start()
        self._mapping = rospy.Publisher("mapping", Mapping, queue_size=1, latch=True)
        if self._is_own:
            self._background.start()
            self._publisher = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
            self._station_publisher = rospy.Publisher(
                "station_pose", PoseStamped, queue_size=1, latch=True
            )
        self._say(rospy.get_time())
        self._serve()

    @property
    def _is_own(self) -> bool:
        return self._wish != GIVEN

    def _serve(self) -> None:
        rospy.Subscriber("dock_status", DockStatus, self._on_dock, queue_size=1)
        rospy.Subscriber("zones", ZoneArray, self._on_zones, queue_size=1)
        for name, work in (
            ("map/finish", self._finish),
            ("map/update/accept", self._accept),
            ("map/update/refuse", self._refuse),
        ):
            rospy.Service(name, Trigger, lambda _, work=work: self._answer(TriggerResponse, work))
        for name, deed in (
            ("map/save", self._save),
            ("map/load", self._load),
            ("map/remove", self._remove),
        ):
            rospy.Service(
                name,
                NameMap,
                lambda request, deed=deed: self._answer(
                    NameMapResponse, lambda: deed(request.name)
                ),
            )
        rospy.Service("map/list", ListMaps, self._on_list)

    def tick(self, now: float, estimate: Estimate) -> None:
        """Begin, grow, recognise, or look for changes; tell what is new."""
        if not self._is_own:
            return
        with self._lock:
            if self._map is None and not self._maker.is_growing:
                self._begin(now)
            elif self._maker.is_growing:
                self._grow(now)
            else:
                self._changes.look(now, estimate, is_docked=self._is_docked)
            self._say(now)

    # ---------------------------------------------------------------- beginning

    def _begin(self, now: float) -> None:
        """Load the map that is wished, or the one of this floor, or begin a new one."""
        if self._wish == NONE:
            self._maker.begin()
        elif self._wish == OWN:
            self._recognise(now)
        else:
            try:
                self._use(self._wish, self._shelf.load(self._wish))
            except (MapStoreError, OSError) as error:
                rospy.logerr("map %s is not loaded, a new one is made: %s", self._wish, error)
                self._trouble = f"{error}. "
                self._wish = NONE

    def _recognise(self, now: float) -> None:
        """Go on with the map of this floor, as soon as it is clear which one it is."""
        search = self._search = self._search or FloorSearch(
            now, self._config, self._place, self._shelf.load_all()
        )
        place = search.tick()
        if place is not None:
            rospy.loginfo("this floor is %s", place.floor)
            self._use(place.floor, search.floors[place.floor], place.pose)
        elif search.has_failed(now):
            rospy.loginfo("the robot was never on this floor")
            self._maker.begin()
        else:
            return
        self._search = None

    def _use(self, name: str, stored: StoredMap, pose: Pose | None = None) -> None:
        """Go on with a stored map; the robot is at a pose of it, or where it was told to be."""
        self._shelf.keep_beside(stored)
        self._name, self._station = name, stored.station
        localizer = self._place.localizer
        self._tell_map(stored.occupancy)
        if localizer is not None:
            localizer.use_map(stored.occupancy)
            if pose is not None:
                localizer.told(pose, (0.05, 0.05))
        self._tell_station()

    # ---------------------------------------------------------------- growing

    def _grow(self, now: float) -> None:
        maker = self._maker
        if maker.note_station(self._is_docked):
            self._station = maker.station
            self._tell_station()
        self._message = self._trouble + (_NO_STATION if self._station is None else _EXPLORE)
        whole = maker.take_whole()
        if whole is not None:
            self._message, self._trouble, self._station = "", "", maker.station
            self._tell_map(whole)
            self._tell_station()
            return
        grown = maker.grown(now)
        if grown is not None:
            self._map, self._known = grown, grown.free_area
            self._background.do(
                "the map is not told",
                lambda: self._publisher.publish(map_message(now, grown, "map", is_growing=True)),
            )

    def _finish(self) -> str:
        """Let the map be whole as it is."""
        with self._lock:
            if not self._maker.is_growing:
                raise MapStoreError("expected a map that is being made, got none")
            if self._station is None:
                raise MapStoreError(_NO_STATION)
            self._maker.finish()
        return "the map becomes whole"

    # ---------------------------------------------------------------- changes

    def _accept(self) -> str:
        """Change the map as it was offered, its rooms with it; a saved one is saved."""
        with self._lock:
            name, before, proposed = self._name, self._whole_map(), self._changes.proposed()
            stored = self._stored(before)
        rooms = None if stored.rooms is None else refitted(stored.rooms, before, proposed)
        stored = replace(stored, occupancy=proposed, rooms=rooms)
        if name:
            self._shelf.save(name, stored)
        with self._lock:
            self._use(name, stored)
        return "the map is changed"

    def _refuse(self) -> str:
        """Leave the map as it is, and do not ask again."""
        with self._lock:
            self._changes.refuse(rospy.get_time())
        return "the map stays as it is"

    # ---------------------------------------------------------------- saving and loading

    def _save(self, name: str) -> str:
        """Save the map by a name; names of rooms and zones of an older one of it go on."""
        with self._lock:
            occupancy = self._whole_map()
            stored = self._stored(occupancy)
            if stored.rooms is None:
                raise MapStoreError("the rooms of this map are still being found; try again")
        if name == self._name:
            self._shelf.save(name, stored)
        elif self._shelf.save_anew(name, stored):
            # Told again: who keeps zones looks for those that it took over.
            self._publisher.publish(map_message(rospy.get_time(), occupancy, "map"))
        with self._lock:
            self._name = name
        return f"saved as {name} in {self._shelf.folder}"

    def _stored(self, occupancy: OccupancyMap) -> StoredMap:
        """Return a map with its station and what is known of its rooms and zones."""
        if self._station is None:
            raise MapStoreError(_NO_STATION)
        rooms = self._rooms.rooms
        if rooms is not None and rooms.frame != occupancy.frame:
            rooms = None
        return StoredMap(occupancy, self._station, rooms, self._zones)

    def _load(self, name: str) -> str:
        """Go on with a saved map; where the robot is on it, it finds out."""
        stored = self._shelf.load(name)
        with self._lock:
            if self._maker.is_growing:
                raise MapStoreError("a map is being made: finish it first (map/finish)")
            self._use(name, stored)
            if self._is_docked and self._place.localizer is not None:
                self._place.localizer.told(stored.station, (0.05, 0.05))
        return f"the robot goes by {name}"

    def _remove(self, name: str) -> str:
        self._shelf.remove(name)
        with self._lock:
            self._name = "" if self._name == name else self._name
        return f"{name} is removed"

    def _whole_map(self) -> OccupancyMap:
        if self._map is None or self._maker.is_growing:
            raise MapStoreError("expected a whole map, got one that is being made; explore first")
        return self._map

    # ---------------------------------------------------------------- telling

    def _tell_map(self, occupancy: OccupancyMap) -> None:
        now = rospy.get_time()
        self._map, self._known = occupancy, occupancy.free_area
        self._changes.begin(now, occupancy)
        self._publisher.publish(map_message(now, occupancy, "map"))

    def _tell_station(self) -> None:
        if self._station is not None:
            now = rospy.get_time()
            self._station_publisher.publish(pose_message(now, self._station, "map"))

    def _say(self, now: float) -> None:
        """Tell whose map it is, when that is news."""
        said = (self._is_own, self._maker.is_growing, self._name, round(self._known), self._message)
        if said != self._said:
            self._said = said
            self._mapping.publish(
                header(now, "map"), self._is_own, said[1], self._name, self._known, self._message
            )

    # ---------------------------------------------------------------- hearing

    def _on_dock(self, message: DockStatus) -> None:
        self._is_docked = message.is_docked

    def _on_zones(self, message: ZoneArray) -> None:
        try:
            zones = Zones(tuple(zone_of(zone) for zone in message.zones))
        except (ZonesError, TypeError) as error:
            rospy.logwarn("zones are not saved with the map: %s", error)
            return
        with self._lock:
            self._zones = zones

    def _answer(self, kind: type, work: Callable[[], str]) -> object:
        """Return a service's answer: what was done, or why not."""
        if not self._is_own:
            return kind(False, _IS_GIVEN)
        try:
            return kind(True, work())
        except RoombaError as error:
            return kind(False, str(error))
        except OSError as error:
            return kind(False, f"the disk refuses: {error}; nothing was changed")

    def _on_list(self, _: ListMapsRequest) -> ListMapsResponse:
        return ListMapsResponse(list(self._shelf.names), self._name)
