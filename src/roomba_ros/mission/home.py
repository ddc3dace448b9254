"""The home as the mission plans in it, on ROS: map, station, rooms, and zones that people edit."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import Mapping, RoomArray, ZoneArray
from roomba_robot.srv import (
    RemoveZone,
    RemoveZoneRequest,
    RemoveZoneResponse,
    SetZone,
    SetZoneRequest,
    SetZoneResponse,
)
from visualization_msgs.msg import MarkerArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.nodes import DeadlinesConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError, RoomsError
from roomba.geometry import Pose
from roomba.grid import FREE, OccupancyMap
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones, ZonesError
from roomba.storage.map_bound import map_digest, map_file_name
from roomba.storage.zones import load_zones, save_zones
from roomba.vocabulary import listed
from roomba_ros.convert.common import ToldMap, pose_in_map, told_map_of
from roomba_ros.convert.mapping import is_growing_of
from roomba_ros.convert.mission import (
    RoomOutlines,
    outlines_of,
    zone_of,
    zones_markers,
    zones_message,
)
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.subscriptions import subscribe

GROWING: Final = "growing"
"""The digest of maps that are being made."""
MOST_FINE_CELLS: Final = 40_000_000
"""Of a map that is cleaned: 4,000 m2, its walls and surroundings included."""
_LAST_EDIT: Final = 0.1
"""s of wall time without another edit, after which a context is made; of many edits there is one.

Until there is one the robot stands.
"""


@dataclass(frozen=True, slots=True, eq=False)
class KnownHome:
    """A planning context, the surface field of its map, and the map's digest.

    All stages of a map that is being made have the same ``digest``.
    """

    context: PlanningContext
    field: SurfaceField
    digest: str

    def is_edit_of(self, before: KnownHome) -> bool:
        """Whether station or zones are others than before: that is obeyed at once."""
        now, then = self.context, before.context
        return (now.station, now.zones) != (then.station, then.zones)


class HomeTopics:
    """Makes contexts in the background: a new one for each map, edit of rooms, and edit of zones.

    Publishes: ``zones`` (ZoneArray, latched), ``zones/markers`` (MarkerArray, latched, for RViz).
    Subscribes: ``map``, ``mapping`` (whether it is being made), ``rooms``, ``station_pose``
    (PoseStamped: where the docked robot stands).
    Services: ``set_zone`` (SetZone), ``remove_zone`` (RemoveZone). Edits are saved at once.
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
        self._robot, self._mission, self._docking = robot, mission, docking
        self._deadlines = deadlines
        self._background, self._folder = background, folder
        self._lock = threading.Lock()
        self._map: OccupancyMap | None = None
        self._digest = ""
        self._field: SurfaceField | None = None
        self._station: Pose | None = None
        self._outlines: RoomOutlines | None = None
        self._zones: Zones | None = None
        self._unreadable = ""
        """Why zones cannot be read, and what to do."""
        self._map_came = 0.0
        self._made: KnownHome | None = None
        self._wanted = self._tried = 0
        self._make_after: float | None = None
        self._is_edited = False
        self._is_mapped: bool | None = None
        self._held: tuple[float, ToldMap] | None = None
        self.trouble = ""
        """Why there is no context of this map, in words; empty while one may still come."""

    def start(self) -> None:
        """Connect."""
        self._zones_publisher = rospy.Publisher("zones", ZoneArray, queue_size=1, latch=True)
        self._markers = rospy.Publisher("zones/markers", MarkerArray, queue_size=1, latch=True)
        subscribe("mapping", Mapping, is_growing_of, self._on_mapping)
        subscribe("map", OccupancyGrid, told_map_of, self._on_map)
        subscribe("rooms", RoomArray, outlines_of, self._on_rooms)
        subscribe("station_pose", PoseStamped, pose_in_map, self._on_station)
        rospy.Service("set_zone", SetZone, self._on_set)
        rospy.Service("remove_zone", RemoveZone, self._on_remove)

    @property
    def missing(self) -> tuple[str, ...]:
        """The topics without which there is no context and that were not heard yet."""
        heard = {"map": self._map, "station_pose": self._station}
        return tuple(topic for topic, value in heard.items() if value is None)

    @property
    def is_changing(self) -> bool:
        """Whether another context is being made than the one in use, but for more map."""
        with self._lock:
            is_another = self._wanted != self._tried or self._made is not None
            return is_another and self._is_edited

    def take(self) -> KnownHome | None:
        """Return a context that was made since the last call."""
        with self._lock:
            if self._wanted != self._tried:
                return None
            made, self._made = self._made, None
            return made

    def tick(self) -> None:
        """Let the first context be made as soon as all that it takes was heard."""
        held = self._held
        if held is not None and time.monotonic() > held[0] + self._deadlines.mapping:
            self._take_held()
        with self._lock:
            is_first = self._tried == self._wanted == 0 and not self.missing
            waits = self._outlines is None
            is_late = time.monotonic() > self._map_came + self._deadlines.rooms
            if is_first and (is_late or not waits):
                self._make()
            if self._make_after is not None and time.monotonic() > self._make_after:
                self._make_soon()

    def _make(self, *, is_edited: bool = True, wait: float = 0.0) -> None:
        """Let a context be made ``wait`` s from now, of what is known then; hold the lock."""
        self._is_edited = is_edited or (self._is_edited and self._wanted != self._tried)
        self._wanted += 1
        if wait > 0.0:
            self._make_after = time.monotonic() + wait
        else:
            self._make_soon()

    def _make_soon(self) -> None:
        self._make_after = None
        self._background.do("no context for the mission", self._make_now)

    def _make_now(self) -> None:
        with self._lock:
            wanted, occupancy, station = self._wanted, self._map, self._station
            outlines, zones, field = self._outlines, self._zones, self._field
            digest = self._digest
        made, trouble = None, ""
        began = time.monotonic()
        try:
            if occupancy is not None and station is not None:
                if zones is None:
                    raise ZonesError(self._unreadable)
                _require_small(occupancy, self._mission.coverage.cell)
                field = field or SurfaceField.of(occupancy)
                context = PlanningContext(
                    occupancy,
                    station,
                    self._robot,
                    self._mission,
                    self._docking,
                    _rooms(outlines, occupancy),
                    zones,
                    is_growing=digest == GROWING,
                )
                if not context.is_growing:
                    # It takes a while, and the mission shall not wait for it.
                    _ = context.coverage
                made = KnownHome(context, field, digest)
        except (RoombaError, ValueError, MemoryError) as error:
            trouble = f"nothing can be cleaned in this map: {error}"
            rospy.logwarn(trouble)
        rospy.logdebug("a context was made in %.2f s", time.monotonic() - began)
        with self._lock:
            if wanted != self._wanted:
                # A newer one waits already.
                return
            self._tried, self._made, self.trouble = wanted, made, trouble
            self._field = field

    def _on_mapping(self, is_growing: bool) -> None:
        self._is_mapped = is_growing
        self._take_held()

    def _on_map(self, told: ToldMap) -> None:
        if not told.was_loaded and self._is_mapped is None:
            # It may be one that is being made; its maker says so, if there is one.
            with self._lock:
                self._held = (time.monotonic(), told)
            return
        self._hear_map(told, time.monotonic())

    def _take_held(self) -> None:
        """Take the map that waited to be known for a whole or a growing one."""
        with self._lock:
            held, self._held = self._held, None
        if held is not None:
            self._hear_map(held[1], held[0])

    def _hear_map(self, told: ToldMap, came: float) -> None:
        occupancy = told.occupancy
        # A map that is being made was never loaded; other people's may not say when they were.
        is_growing = bool(self._is_mapped) and not told.was_loaded
        digest = GROWING if is_growing else map_digest(occupancy)
        with self._lock:
            if digest == self._digest and not is_growing:
                self._take_carried(occupancy)
                return
            before, self._digest = self._digest, digest
            is_first = self._map is None
            self._map, self._field = occupancy, None
            self._map_came = came
            if not (is_growing and before == GROWING):
                self._zones = self._kept_or_carried(occupancy, before)
                self._tell()
            if not is_first:
                # Rooms of this map are told after it.
                self._outlines = None
                self._make(is_edited=not is_growing)

    def _on_rooms(self, outlines: RoomOutlines) -> None:
        with self._lock:
            before, self._outlines = self._outlines, outlines
            if before != outlines and self._wanted > 0:
                self._make()

    def _on_station(self, station: Pose) -> None:
        with self._lock:
            is_new, self._station = station != self._station, station
            if is_new and self._wanted > 0:
                self._make()

    def _kept_or_carried(self, occupancy: OccupancyMap, before: str) -> Zones | None:
        """Return the zones of a map; those of a map that was made go on in the whole one."""
        kept, zones = self._kept(occupancy), self._zones
        if before != GROWING or zones is None or not zones.all or kept is None or kept.all:
            return kept
        try:
            save_zones(zones, occupancy, self._path())
        except OSError as error:
            rospy.logerr("the zones cannot be saved: %s", error)
        return zones

    def _take_carried(self, occupancy: OccupancyMap) -> None:
        """Go on with other zones that are kept by now: a map that is told again took some over."""
        kept = self._kept(occupancy)
        if kept == self._zones:
            return
        self._zones = kept
        self._tell()
        if self._wanted > 0:
            self._make()

    def _kept(self, occupancy: OccupancyMap) -> Zones | None:
        """Return the zones of a map; None when they cannot be read: then nothing is cleaned."""
        try:
            return load_zones(self._path(), occupancy, rospy.logerr)
        except ZonesError as error:
            self._unreadable = str(error)
            rospy.logerr("%s", error)
            return None

    def _path(self) -> Path:
        return self._folder / f"{map_file_name(self._digest)}.yaml"

    def _tell(self) -> None:
        now, zones = rospy.get_time(), self._zones or Zones()
        self._zones_publisher.publish(zones_message(now, zones, "map"))
        self._markers.publish(zones_markers(now, zones, "map"))

    def _edit(self, change: Callable[[Zones], Zones]) -> tuple[bool, str]:
        """Change the zones, tell and save them; return whether that was done, and what or why."""
        with self._lock:
            if self._map is None:
                return False, "there is no map yet; is home_sim_node running?"
            if self._zones is None:
                return False, f"{self._unreadable}; then restart"
            try:
                zones = change(self._zones)
                save_zones(zones, self._map, self._path())
            except ZonesError as error:
                return False, str(error)
            except OSError as error:
                return False, f"the zones cannot be saved: {error}; nothing was changed"
            self._zones = zones
            self._tell()
            if self._wanted > 0:
                self._make(wait=_LAST_EDIT)
            return True, f"the zones are: {listed(zones.names)}"

    def _on_set(self, request: SetZoneRequest) -> SetZoneResponse:
        return SetZoneResponse(*self._edit(lambda zones: zones.with_zone(zone_of(request.zone))))

    def _on_remove(self, request: RemoveZoneRequest) -> RemoveZoneResponse:
        return RemoveZoneResponse(*self._edit(lambda zones: zones.without(request.name)))


def _require_small(occupancy: OccupancyMap, cell: float) -> None:
    frame = occupancy.frame
    cells = frame.rows * frame.columns * max(1, round(frame.resolution / cell)) ** 2
    if cells > MOST_FINE_CELLS:
        raise RoombaError(
            f"expected a map of {MOST_FINE_CELLS * cell**2:g} m2 at most, got one of "
            f"{cells * cell**2:g} m2; cut it to what is to be cleaned"
        )


def _rooms(outlines: RoomOutlines | None, occupancy: OccupancyMap) -> Rooms | None:
    if not outlines:
        return None
    try:
        return Rooms.from_outlines(occupancy.frame, occupancy.values == FREE, outlines)
    except (RoomsError, ValueError) as error:
        rospy.logwarn("the mission knows no rooms: %s", error)
        return None
