"""The home as the mission plans in it, on ROS: map, station and rooms are heard here."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Final

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import Mapping, RoomArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.nodes import DeadlinesConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, old_in_new
from roomba.grid import OccupancyMap
from roomba.storage.map_bound import map_digest
from roomba_ros.convert.common import ToldMap, pose_in_map, told_map_of
from roomba_ros.convert.mapping import is_growing_of
from roomba_ros.convert.rooms import RoomOutlines, outlines_of
from roomba_ros.mission.context_maker import ContextInputs, ContextMaker
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.mission.zone_edits import ZoneEdits
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.subscriptions import subscribe

_LAST_EDIT: Final = 0.1
"""s of wall time after the last edit until a context is made: many edits in a row make only one.

Until then the robot stands."""


class HomeTopics:
    """Hears of the home, and lets a context be made for each map and each edit of it.

    Publishes and serves what :class:`ZoneEdits` says.
    Subscribes: ``map``, ``mapping`` (whether it is being made), ``rooms``, ``station_pose``
    (PoseStamped: where the docked robot stands).
    """

    def __init__(
        self,
        robot: RobotConfig,
        mission: MissionConfig,
        docking: DockingConfig,
        deadlines: DeadlinesConfig,
        background: Background,
        folder: Path,
    ) -> None:
        """Connect nothing yet; zones are saved in ``folder``."""
        self._deadlines = deadlines
        self._lock = threading.Lock()
        self._maker = ContextMaker(robot, mission, docking, background, self._lock, self._inputs)
        self._zones = ZoneEdits(folder, self._lock, lambda: self._make_anew(wait=_LAST_EDIT))
        self._map: OccupancyMap | None = None
        self._digest = ""
        self._map_came = 0.0
        self._station: Pose | None = None
        self._grown_by: Pose | None = None
        """Where the station is on the newest map that is being made; None for any other map."""
        self._outlines: RoomOutlines | None = None
        self._is_mapped: bool | None = None
        self._held: tuple[float, ToldMap] | None = None

    def start(self) -> None:
        """Connect."""
        self._zones.start()
        subscribe("mapping", Mapping, is_growing_of, self._on_mapping)
        subscribe("map", OccupancyGrid, told_map_of, self._on_map)
        subscribe("rooms", RoomArray, outlines_of, self._on_rooms)
        subscribe("station_pose", PoseStamped, pose_in_map, self._on_station)
        self._zones.serve()

    @property
    def missing(self) -> tuple[str, ...]:
        """The topics that a context needs and that were not heard yet."""
        heard = {"map": self._map, "station_pose": self._station}
        return tuple(topic for topic, value in heard.items() if value is None)

    @property
    def trouble(self) -> str:
        """Why there is no context of this map, in words; empty while one may still come."""
        return self._maker.trouble

    @property
    def is_changing(self) -> bool:
        """Whether a context that differs by more than new floor of a growing map is being made."""
        return self._maker.is_changing

    def take(self) -> KnownHome | None:
        """Return a context that was made since the last call."""
        return self._maker.take()

    def tick(self) -> None:
        """Request the first context as soon as all its inputs were heard."""
        held = self._held
        if held is not None and time.monotonic() > held[0] + self._deadlines.mapping:
            self._take_held()
        with self._lock:
            is_first = not self._maker.has_begun and not self.missing
            waits = self._outlines is None
            is_late = time.monotonic() > self._map_came + self._deadlines.rooms
            if is_first and (is_late or not waits):
                self._maker.make()
            self._maker.tick()

    def _inputs(self) -> ContextInputs | None:
        """Return the inputs of a context; None while one is missing; hold the lock."""
        if self._map is None or self._station is None:
            return None
        zones, unreadable = self._zones.zones, self._zones.unreadable
        return ContextInputs(
            self._map, self._digest, self._station, self._outlines, zones, unreadable
        )

    def _make_anew(self, wait: float = 0.0) -> None:
        """Request a context after an edit, unless the first one is still to come; hold the lock."""
        if self._maker.has_begun:
            self._maker.make(wait=wait)

    def _on_mapping(self, is_growing: bool) -> None:
        self._is_mapped = is_growing
        self._take_held()

    def _on_map(self, told: ToldMap) -> None:
        if not told.was_loaded and self._is_mapped is None:
            # It may be unfinished: if it is, the node that makes it says so on ``mapping``.
            with self._lock:
                self._held = (time.monotonic(), told)
            return
        self._hear_map(told, time.monotonic())

    def _take_held(self) -> None:
        """Take the map that waited until ``mapping`` told whether it is finished or growing."""
        with self._lock:
            held, self._held = self._held, None
        if held is not None:
            self._hear_map(held[1], held[0])

    def _hear_map(self, told: ToldMap, came: float) -> None:
        occupancy = told.occupancy
        # A growing map has load time 0, but other packages' finished maps may have that, too.
        is_growing = bool(self._is_mapped) and not told.was_loaded
        digest = GROWING if is_growing else map_digest(occupancy)
        with self._lock:
            if digest == self._digest and not is_growing:
                if self._zones.look_again():
                    self._make_anew()
                return
            is_first = self._map is None
            self._map, self._digest, self._map_came = occupancy, digest, came
            self._zones.follow_map(digest, self._old_in_new())
            self._grown_by = self._station if is_growing else None
            if not is_first:
                # The rooms of this map come after it.
                self._outlines = None
                self._maker.make(is_edited=not is_growing)

    def _old_in_new(self) -> Pose:
        """Return where the frame of the map that was being made lies in the finished one's frame.

        The station's pose on the finished map is published before that map.
        """
        before, now = self._grown_by, self._station
        return Pose() if before is None or now is None else old_in_new(before, now)

    def _on_rooms(self, outlines: RoomOutlines) -> None:
        with self._lock:
            before, self._outlines = self._outlines, outlines
            if before != outlines:
                self._make_anew()

    def _on_station(self, station: Pose) -> None:
        with self._lock:
            is_new, self._station = station != self._station, station
            if is_new:
                self._make_anew()
