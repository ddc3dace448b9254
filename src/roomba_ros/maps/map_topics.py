"""The robot's own maps on ROS: begun or recognized, finished, and checked for changes."""

from __future__ import annotations

from typing import Final

import rospy
from roomba_robot.msg import DockStatus

from roomba.configuration.nodes import NodesConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import ConfigError
from roomba.perception.localization.estimate import Estimate
from roomba.storage.map_store import MapStoreError
from roomba_ros.convert.readings import is_docked_of
from roomba_ros.localization.floor_search import FloorSearch
from roomba_ros.localization.topics import LocalizationTopics
from roomba_ros.maps.change_topics import ChangeTopics
from roomba_ros.maps.map_maker import MapMaker
from roomba_ros.maps.map_memory import MapMemory
from roomba_ros.maps.map_services import MapServices
from roomba_ros.maps.map_shelf import MapShelf
from roomba_ros.maps.map_wish import GIVEN, NONE, OWN
from roomba_ros.maps.own_map import NO_STATION, OwnMap
from roomba_ros.rooms.topics import RoomTopics
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.parameters import read_mapping_config
from roomba_ros.runtime.subscriptions import subscribe

_EXPLORE: Final = "the map is being made: explore, or walk about"


class MapTopics:
    """Publishes the robot's own map; for a robot with a given map it publishes only that fact.

    Publishes: what :class:`OwnMap` tells (the map 1 Hz while it grows), and :class:`ChangeTopics`.
    Subscribes: ``dock_status``, and what :class:`OwnMap` hears.
    Services: those of :class:`MapServices`.
    Parameters: ``~map`` (given, none, own, or the name of a saved map), ``map_is_given``
    (false: given means own, as in a real home), ``mapping_config``, and
    those of :class:`MapShelf`.
    """

    def __init__(
        self,
        config: RobotConfig,
        nodes: NodesConfig,
        place: LocalizationTopics,
        rooms: RoomTopics,
    ) -> None:
        """Connect nothing yet."""
        self._config, self._nodes, self._place = config, nodes, place
        self._background = Background()
        self._memory = MapMemory(nodes.memory, self._background)
        mapping = read_mapping_config()
        self._floors = mapping.floors
        self._maker = MapMaker(
            config, mapping, nodes.placing, place, self._background, self._memory
        )
        rooms.is_growing = lambda: self._maker.is_growing
        self._shelf = MapShelf(rooms, mapping.floors)
        self._changes = ChangeTopics(place, mapping.changes, nodes.periods.changes)
        self._own = OwnMap(place, rooms, self._shelf, self._changes, self._memory, self._background)
        self._services = MapServices(self._own, self._maker, self._shelf, self._changes, place)
        self._trouble = ""
        self._is_docked = False
        self._search: FloorSearch | None = None

    def start(self) -> None:
        """Read the parameters and connect; raises ConfigError."""
        self._wish = rospy.get_param("~map", GIVEN)
        if not isinstance(self._wish, str) or not self._wish:
            raise ConfigError(
                f"parameter ~map: expected given, none, own or a name, got {self._wish!r}"
            )
        if self._wish == GIVEN and not rospy.get_param("map_is_given", True):
            self._wish = OWN
        self._shelf.start()
        self._changes.start()
        self._memory.start(self._shelf.folder)
        if self._is_own:
            self._background.start()
        self._own.start(is_own=self._is_own)
        if not (self._is_own and self._memory.is_there):
            # Otherwise an exploration would take the map for finished before it is resumed.
            self._own.say(rospy.get_time(), is_growing=False)
        subscribe("dock_status", DockStatus, is_docked_of, self._on_dock)
        self._services.start(is_own=self._is_own)

    @property
    def _is_own(self) -> bool:
        return bool(self._wish != GIVEN)

    def tick(self, now: float, estimate: Estimate) -> None:
        """Begin, grow or recognize a map, or look for changes; publish what is new."""
        if not self._is_own:
            return
        own, maker = self._own, self._maker
        with own.lock:
            is_new_station = maker.note_station(self._is_docked)
            if own.occupancy is None and not maker.is_growing:
                self._begin(now)
            elif maker.is_growing:
                if is_new_station:
                    own.tell_station(maker.station)
                self._grow(now)
            else:
                self._changes.look(now, estimate, is_docked=self._is_docked)
            own.say(now, is_growing=maker.is_growing)

    def _begin(self, now: float) -> None:
        """Resume an unfinished map, load the wished one, recognize this floor, or begin anew."""
        if self._search is None and self._take_up():
            return
        if self._wish == NONE:
            self._maker.begin()
        elif self._wish == OWN:
            self._recognise(now)
        else:
            try:
                stored = self._shelf.load(self._wish)
                # A node that is restarted in the same run finds the robot where it was.
                at = self._place.place if self._place.was_here_before else None
                self._own.use(self._wish, stored, at)
            except (MapStoreError, OSError) as error:
                rospy.logerr("map %s is not loaded, a new one is made: %s", self._wish, error)
                self._trouble = f"{error}. "
                self._maker.begin()

    def _take_up(self) -> bool:
        """Resume the map that a killed process of this run had; return whether it had one."""
        if not self._place.was_here_before:
            return False
        if self._maker.take_up():
            self._own.tell_station(self._maker.station)
            return True
        whole = self._memory.recall_whole()
        if whole is not None:
            rospy.loginfo("this node ended; it goes on with the map that it made")
            self._own.use("", whole, self._place.place)
        return whole is not None

    def _recognise(self, now: float) -> None:
        """Go on with the map of this floor, as soon as it is clear which one it is."""
        search = self._search = self._search or FloorSearch(
            now,
            self._config,
            self._floors,
            self._place,
            self._shelf.load_all(),
            self._nodes.deadlines.floor,
        )
        place = search.tick()
        if place is not None:
            rospy.loginfo("this floor is %s", place.floor)
            self._own.use(place.floor, search.floors[place.floor], place.pose)
        elif search.has_failed(now):
            rospy.loginfo("the robot was never on this floor")
            self._maker.begin()
        else:
            return
        self._search = None

    def _grow(self, now: float) -> None:
        own, maker = self._own, self._maker
        own.message = self._trouble + (NO_STATION if maker.station is None else _EXPLORE)
        whole = maker.take_whole()
        if whole is not None:
            own.message = self._trouble = ""
            # Publish the station first: from its old and new pose other nodes move what they noted.
            own.tell_station(maker.station)
            own.tell_whole(whole)
            own.remember()
            return
        grown = maker.grown(now)
        if grown is not None:
            own.tell_growing(now, grown)
        maker.keep(now)

    def _on_dock(self, is_docked: bool) -> None:
        self._is_docked, self._maker.has_dock = is_docked, True
