"""The rooms of the map on ROS: found, told, edited by people, and kept."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path

import rospy
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import RoomArray
from roomba_robot.srv import (
    JoinRooms,
    JoinRoomsRequest,
    JoinRoomsResponse,
    RenameRoom,
    RenameRoomRequest,
    RenameRoomResponse,
    SplitRoom,
    SplitRoomRequest,
    SplitRoomResponse,
)
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse
from visualization_msgs.msg import MarkerArray

from roomba.errors import RoombaError, RoomsError
from roomba.grid import OccupancyMap
from roomba.perception.rooms.rooms import Rooms, segment
from roomba.storage.map_bound import map_digest, map_file_name
from roomba.storage.rooms import load_rooms, save_rooms
from roomba_ros.convert.common import map_of
from roomba_ros.convert.rooms import rooms_markers, rooms_message
from roomba_ros.runtime.parameters import folder_of, read_rooms_config
from roomba_ros.runtime.subscriptions import subscribe


class RoomTopics:
    """Cuts each map into rooms, unless people have edited those of this map before.

    Publishes: ``rooms`` (RoomArray, latched), ``rooms/markers`` (MarkerArray, latched, for RViz).
    Subscribes: ``map``.
    Services: ``rooms/rename`` (RenameRoom), ``rooms/join`` (JoinRooms), ``rooms/split``
    (SplitRoom), ``rooms/segment`` (Trigger: forget all edits), ``rooms/undo`` (Trigger: take back
    the newest edit). Edits are saved at once.
    Parameters: ``~rooms_folder`` (default: roomba_robot/rooms in the ROS home folder),
    ``rooms_config`` (path of a configuration file; by default the shipped one).
    """

    def __init__(self) -> None:
        """Connect nothing yet."""
        self._lock = threading.Lock()
        self._map: OccupancyMap | None = None
        self._rooms: Rooms | None = None
        self._before: Rooms | None = None
        self.is_growing: Callable[[], bool] = lambda: False
        """Returns whether the map is being made; the maker of maps sets this function."""

    def start(self) -> None:
        """Connect."""
        self._folder = folder_of("~rooms_folder", "rooms")
        self._config = read_rooms_config()
        self._publisher = rospy.Publisher("rooms", RoomArray, queue_size=1, latch=True)
        self._markers = rospy.Publisher("rooms/markers", MarkerArray, queue_size=1, latch=True)
        rospy.Service("rooms/rename", RenameRoom, self._on_rename)
        rospy.Service("rooms/join", JoinRooms, self._on_join)
        rospy.Service("rooms/split", SplitRoom, self._on_split)
        rospy.Service("rooms/segment", Trigger, self._on_segment)
        rospy.Service("rooms/undo", Trigger, self._on_undo)
        subscribe("map", OccupancyGrid, self._whole_map_of, self._on_map)

    def _whole_map_of(self, message: OccupancyGrid) -> OccupancyMap | None:
        """Return the map of a message; None for one that is being made."""
        if self.is_growing() and message.info.map_load_time.is_zero():
            return None
        return map_of(message)

    def _on_map(self, occupancy: OccupancyMap | None) -> None:
        if occupancy is None:
            # Rooms are found when the map is finished.
            self._publisher.publish(RoomArray())
            return
        # Found here and not in a tick: nothing waits for rooms, but the robot's pose must not wait.
        with self._lock:
            self._map, self._rooms, self._before = occupancy, self._kept(occupancy), None
            if self._rooms is None:
                self._rooms = self._segmented(occupancy)
            self._tell(self._rooms)

    @property
    def rooms(self) -> Rooms | None:
        """The rooms as they are now."""
        with self._lock:
            return self._rooms

    def use(self, rooms: Rooms) -> None:
        """Use these rooms for the present map, and save them; raises OSError."""
        with self._lock:
            if self._map is None or rooms.frame != self._map.frame:
                return
            save_rooms(rooms, self._map, self.path_of(self._map))
            self._rooms, self._before = rooms, None
            self._tell(rooms)

    def _kept(self, occupancy: OccupancyMap) -> Rooms | None:
        """Return the rooms that people made of this map, or None."""
        try:
            return load_rooms(self.path_of(occupancy), occupancy, rospy.logwarn)
        except RoomsError as error:
            rospy.logwarn("the rooms are cut anew: %s", error)
            return None

    def path_of(self, occupancy: OccupancyMap) -> Path:
        """Return where the rooms of a map are kept."""
        return self._folder / f"{map_file_name(map_digest(occupancy))}.yaml"

    def _tell(self, rooms: Rooms) -> None:
        now = rospy.get_time()
        self._publisher.publish(rooms_message(now, rooms, "map"))
        self._markers.publish(rooms_markers(now, rooms, "map"))

    def _edit(self, change: Callable[[Rooms, OccupancyMap], Rooms]) -> tuple[bool, str]:
        """Change the rooms, tell and save them; return whether that was done, and what or why."""
        with self._lock:
            if self._map is None or self._rooms is None:
                return False, "there is no map yet; is home_sim_node running?"
            try:
                rooms = change(self._rooms, self._map)
                save_rooms(rooms, self._map, self.path_of(self._map))
            except RoombaError as error:
                return False, str(error)
            except OSError as error:
                return False, f"the rooms cannot be saved: {error}; nothing was changed"
            self._rooms, self._before = rooms, self._rooms
            self._tell(rooms)
            return True, f"the rooms are: {', '.join(rooms.names)}"

    def _on_rename(self, request: RenameRoomRequest) -> RenameRoomResponse:
        return RenameRoomResponse(
            *self._edit(lambda rooms, _: rooms.renamed(request.name, request.new_name))
        )

    def _on_join(self, request: JoinRoomsRequest) -> JoinRoomsResponse:
        return JoinRoomsResponse(*self._edit(lambda rooms, _: rooms.joined(*request.names)))

    def _on_split(self, request: SplitRoomRequest) -> SplitRoomResponse:
        start, end = request.start, request.end
        return SplitRoomResponse(
            *self._edit(
                lambda rooms, _: rooms.split(request.name, (start.x, start.y), (end.x, end.y))
            )
        )

    def _on_segment(self, _: TriggerRequest) -> TriggerResponse:
        return TriggerResponse(*self._edit(lambda _, occupancy: self._segmented(occupancy)))

    def _on_undo(self, _: TriggerRequest) -> TriggerResponse:
        answer = TriggerResponse(*self._edit(self._before_edit))
        if answer.success:
            with self._lock:
                self._before = None
        return answer

    def _before_edit(self, _: Rooms, __: OccupancyMap) -> Rooms:
        if self._before is None:
            raise RoomsError("expected an edit of the rooms to take back, there was none")
        return self._before

    def _segmented(self, occupancy: OccupancyMap) -> Rooms:
        began = time.monotonic()
        rooms = segment(occupancy, self._config)
        took = time.monotonic() - began
        rospy.loginfo("the map has %d rooms (found in %.2f s)", len(rooms.names), took)
        return rooms
