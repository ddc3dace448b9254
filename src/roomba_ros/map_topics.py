"""The robot's own maps on ROS: made, told, saved, recognised, and changed when people agree."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Final

import rospkg
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import DockStatus, Mapping, MapUpdate, ZoneArray
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
from roomba.map_bound_file import map_digest
from roomba.map_store import MapStore, MapStoreError, StoredMap
from roomba.perception.carry_over import carry_over
from roomba.perception.estimate import Estimate, Knowledge
from roomba.perception.floor_recognition import Floor, FloorRecognition, FloorVerdict
from roomba.perception.map_changes import MapChanges
from roomba.perception.zones import Zones, ZonesError
from roomba.rooms_file import save_rooms
from roomba.zones_file import save_zones
from roomba_ros.background import Background
from roomba_ros.convert import header, map_message, pose_message
from roomba_ros.convert_mapping import update_message
from roomba_ros.convert_mission import zone_of
from roomba_ros.localization_topics import LocalizationTopics
from roomba_ros.map_maker import MapMaker, known_area
from roomba_ros.parameters import read_mapping_config
from roomba_ros.room_topics import RoomTopics

GIVEN: Final = "given"
NONE: Final = "none"
OWN: Final = "own"
"""Values of the parameter: a map that others tell; a new one of its own; the own one of this floor.
All others are names of saved maps."""
_CHANGES_PERIOD: Final = 0.4
"""s between two scans that are looked through for changes."""
_RECOGNITION_TIMEOUT: Final = 20.0
"""s; when no floor was recognised by then, it is a new one."""
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
    latched, at each change), ``map/update`` (MapUpdate, latched: what of the map it would change).
    Subscribes: ``dock_status``, ``zones``.
    Services: ``map/finish`` (Trigger: the map is whole as it is), ``map/save``, ``map/load``,
    ``map/remove`` (NameMap), ``map/list`` (ListMaps), ``map/update/accept``,
    ``map/update/refuse`` (Trigger).
    Parameters: ``~map`` (given, none, own, or the name of a saved map), ``~maps_folder`` (default:
    roomba_robot/maps in the ROS home folder), ``~zones_folder`` (as the mission node has it),
    ``mapping_config``.
    """

    def __init__(self, config: RobotConfig, place: LocalizationTopics, rooms: RoomTopics) -> None:
        """Connect nothing yet."""
        self._config, self._place, self._rooms = config, place, rooms
        self._background = Background()
        self._lock = threading.RLock()
        self._maker = MapMaker(config, read_mapping_config(), place, self._background)
        self._map: OccupancyMap | None = None
        self._station: Pose | None = None
        self._name = self._message = ""
        self._zones = Zones()
        self._is_docked = False
        self._changes: MapChanges | None = None
        self._changes_seen = -1.0
        self._offered: tuple[object, ...] = ()
        self._said: tuple[object, ...] = ()
        self._recognition: FloorRecognition | None = None
        self._recognises_since: float | None = None

    def start(self) -> None:
        """Read the parameters and connect; raises ConfigError."""
        self._wish = rospy.get_param("~map", GIVEN)
        if not isinstance(self._wish, str) or not self._wish:
            raise ConfigError(
                f"parameter ~map: expected given, none, own or a name, got {self._wish!r}"
            )
        self._store = MapStore(_folder("~maps_folder", "maps"))
        self._zones_folder = _folder("~zones_folder", "zones")
        self._mapping = rospy.Publisher("mapping", Mapping, queue_size=1, latch=True)
        self._update = rospy.Publisher("map/update", MapUpdate, queue_size=1, latch=True)
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
                self._look_for_changes(now, estimate)
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
                self._use(self._wish, self._store.load(self._wish))
            except (MapStoreError, OSError) as error:
                rospy.logerr("map %s is not loaded, a new one is made: %s", self._wish, error)
                self._message = str(error)
                self._wish = NONE

    def _recognise(self, now: float) -> None:
        """Compare what is in sight with the maps of all floors, a little at a tick."""
        if self._recognition is None:
            self._floors = self._all_floors()
            floors = {
                name: Floor(each.occupancy, each.station) for name, each in self._floors.items()
            }
            config = self._config
            self._recognition = FloorRecognition(floors, config.localization, config.body.radius)
            self._recognises_since = now
        recognition = self._recognition
        seen = self._place.seen
        if seen is not None and self._place.localizer is not None:
            _, ranges, lidar = seen
            recognition.see(lidar.view(ranges), self._place.localizer.reckoned)
        recognition.advance()
        place = recognition.place
        since = self._recognises_since
        is_late = since is None or not 0.0 <= now - since <= _RECOGNITION_TIMEOUT
        if place is not None:
            rospy.loginfo("this floor is %s", place.floor)
            self._use(place.floor, self._floors[place.floor], place.pose)
        elif recognition.verdict is FloorVerdict.NEW or is_late:
            rospy.loginfo("the robot was never on this floor")
            self._maker.begin()
        else:
            return
        self._recognition = None

    def _all_floors(self) -> dict[str, StoredMap]:
        floors = {}
        for name in self._store.names():
            try:
                floors[name] = self._store.load(name)
            except (MapStoreError, OSError) as error:
                rospy.logwarn("map %s is left out: %s", name, error)
        return floors

    def _use(self, name: str, stored: StoredMap, pose: Pose | None = None) -> None:
        """Go on with a stored map; the robot is at a pose of it, or where it was told to be."""
        self._keep_beside(stored)
        self._name, self._station = name, stored.station
        localizer = self._place.localizer
        self._tell_map(stored.occupancy)
        if localizer is not None:
            localizer.use_map(stored.occupancy)
            if pose is not None:
                localizer.told(pose, (0.05, 0.05))
        self._tell_station()

    def _keep_beside(self, stored: StoredMap) -> None:
        """Let those find its rooms and zones who look for them by the map."""
        number = f"{map_digest(stored.occupancy)[:16]}.yaml"
        rooms_path, zones_path = self._rooms.folder / number, self._zones_folder / number
        try:
            if stored.rooms is not None and not rooms_path.exists():
                save_rooms(stored.rooms, stored.occupancy, rooms_path)
            if stored.zones.all and not zones_path.exists():
                save_zones(stored.zones, stored.occupancy, zones_path)
        except (OSError, RoombaError) as error:
            rospy.logwarn("rooms and zones of the map are not taken over: %s", error)

    # ---------------------------------------------------------------- growing

    def _grow(self, now: float) -> None:
        maker = self._maker
        if maker.note_station(self._is_docked):
            self._station = maker.station
            self._tell_station()
        self._message = _NO_STATION if self._station is None else _EXPLORE
        whole = maker.take_whole()
        if whole is not None:
            self._message, self._station = "", maker.station
            self._tell_map(whole)
            self._tell_station()
            return
        grown = maker.grown(now)
        if grown is not None:
            self._map = grown
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

    def _look_for_changes(self, now: float, estimate: Estimate) -> None:
        """Look through a scan now and then; offer what stands otherwise when the robot is home."""
        seen, changes = self._place.seen, self._changes
        if changes is None or seen is None or estimate.knowledge is not Knowledge.KNOWN:
            return
        stamp, ranges, lidar = seen
        if not 0.0 <= stamp - self._changes_seen < _CHANGES_PERIOD:
            self._changes_seen = stamp
            changes.see(stamp, ranges, lidar.arrays(), estimate.pose)
        if self._is_docked:
            self._offer(now, changes)

    def _offer(self, now: float, changes: MapChanges) -> None:
        offered: tuple[object, ...] = changes.changes()
        if offered == self._offered:
            return
        self._offered = offered
        self._update.publish(update_message(now, changes.changes(), "map"))
        if offered:
            rospy.loginfo("%d things stand otherwise than on the map; see map/update", len(offered))

    def _accept(self) -> str:
        """Change the map as it was offered."""
        with self._lock:
            changes, before = self._changes, self._map
            if changes is None or before is None or not self._offered:
                raise MapStoreError("expected an offer (see map/update), got none")
            proposed = changes.proposed()
            self._keep_beside(self._stored(proposed))
            localizer = self._place.localizer
            if localizer is not None:
                localizer.use_map(proposed)
            self._tell_map(proposed)
            name = self._name
        if name:
            self._save(name)
        return "the map is changed"

    def _refuse(self) -> str:
        """Leave the map as it is, and do not ask again."""
        with self._lock:
            changes = self._changes
            if changes is None or not self._offered:
                raise MapStoreError("expected an offer (see map/update), got none")
            for change in changes.changes():
                changes.dismissed(change)
            self._offer(rospy.get_time(), changes)
        return "the map stays as it is"

    # ---------------------------------------------------------------- saving and loading

    def _save(self, name: str) -> str:
        """Save the map by a name; names of rooms and zones of an older one of it go on."""
        with self._lock:
            occupancy = self._whole_map()
            stored = self._stored(occupancy)
            if stored.rooms is None:
                raise MapStoreError("the rooms of this map are still being found; try again")
        if name in self._store.names() and name != self._name:
            stored = self._carried_over(stored, self._store.load(name))
        self._store.save(name, stored)
        with self._lock:
            self._name = name
        return f"saved as {name} in {self._store.folder}"

    def _carried_over(self, stored: StoredMap, old: StoredMap) -> StoredMap:
        """Return a map that was made anew with what people did to the old one, and tell it."""
        assert stored.rooms is not None
        zones = stored.zones if stored.zones.all else old.zones
        carried = carry_over(stored.rooms, old.rooms, zones)
        self._rooms.use(carried.rooms)
        number = f"{map_digest(stored.occupancy)[:16]}.yaml"
        save_zones(carried.zones, stored.occupancy, self._zones_folder / number)
        return StoredMap(stored.occupancy, stored.station, carried.rooms, carried.zones)

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
        stored = self._store.load(name)
        with self._lock:
            if self._maker.is_growing:
                raise MapStoreError("a map is being made: finish it first (map/finish)")
            self._use(name, stored)
            if self._is_docked and self._place.localizer is not None:
                self._place.localizer.told(stored.station, (0.05, 0.05))
        return f"the robot goes by {name}"

    def _remove(self, name: str) -> str:
        self._store.remove(name)
        with self._lock:
            self._name = "" if self._name == name else self._name
        return f"{name} is removed"

    def _whole_map(self) -> OccupancyMap:
        if self._map is None or self._maker.is_growing:
            raise MapStoreError("expected a whole map, got one that is being made; explore first")
        return self._map

    # ---------------------------------------------------------------- telling

    def _tell_map(self, occupancy: OccupancyMap) -> None:
        self._map, self._changes = occupancy, MapChanges(occupancy)
        self._offered = ()
        now = rospy.get_time()
        self._update.publish(MapUpdate(header=header(now, "map")))
        self._publisher.publish(map_message(now, occupancy, "map"))

    def _tell_station(self) -> None:
        if self._station is not None:
            now = rospy.get_time()
            self._station_publisher.publish(pose_message(now, self._station, "map"))

    def _say(self, now: float) -> None:
        """Tell whose map it is, when that is news."""
        known = 0.0 if self._map is None else known_area(self._map)
        said = (self._is_own, self._maker.is_growing, self._name, round(known), self._message)
        if said != self._said:
            self._said = said
            self._mapping.publish(
                header(now, "map"), self._is_own, said[1], self._name, known, self._message
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
        return ListMapsResponse(list(self._store.names()), self._name)


def _folder(parameter: str, name: str) -> Path:
    folder = str(rospy.get_param(parameter, ""))
    return Path(folder or Path(rospkg.get_ros_home()) / "roomba_robot" / name)
