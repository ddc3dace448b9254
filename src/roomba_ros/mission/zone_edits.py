"""The zones of the map, on ROS: kept for each map, told, and edited by people."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Final

import rospy
from roomba_robot.msg import ZoneArray
from roomba_robot.srv import (
    RemoveZone,
    RemoveZoneRequest,
    RemoveZoneResponse,
    SetZone,
    SetZoneRequest,
    SetZoneResponse,
)
from visualization_msgs.msg import MarkerArray

from roomba.files.kept import remove_kept
from roomba.geometry import Pose
from roomba.perception.floors.carry_over import moved
from roomba.perception.rooms.zones import Zones, ZonesError
from roomba.storage.map_bound import map_file_name
from roomba.storage.zones import load_zones, save_zones
from roomba.vocabulary import listed
from roomba_ros.convert.rooms import zone_of, zones_markers, zones_message
from roomba_ros.mission.known_home import GROWING
from roomba_ros.runtime.parameters import robot_name, robot_run

_SAME: Final = Pose()
"""Where a map lies in another one that has its frame."""


class ZoneEdits:
    """Keeps the zones of the newest map; edits are saved at once.

    Zones of a map that is being made count only in this run, and move to the finished map.
    Publishes: ``zones`` (ZoneArray, latched), ``zones/markers`` (MarkerArray, latched, for RViz).
    Services: ``set_zone`` (SetZone), ``remove_zone`` (RemoveZone).
    """

    def __init__(self, folder: Path, lock: threading.Lock, on_edit: Callable[[], None]) -> None:
        """Connect nothing yet; ``on_edit`` is called under the lock when zones were edited."""
        self._folder, self._lock, self._on_edit = folder, lock, on_edit
        self._digest = self._growing = ""
        self.zones: Zones | None = None
        """None before there is a map, and when the zones cannot be read: then nothing is
        cleaned."""
        self.unreadable = ""
        """Why zones cannot be read, and what to do."""

    def start(self) -> None:
        """Advertise the topics; nothing can be edited yet."""
        robot, run = robot_name(), robot_run()
        self._growing = f"{GROWING}-{robot}-{run}"
        self._forget_other_runs(robot, run)
        self._zones_publisher = rospy.Publisher("zones", ZoneArray, queue_size=1, latch=True)
        self._markers = rospy.Publisher("zones/markers", MarkerArray, queue_size=1, latch=True)

    def serve(self) -> None:
        """Let zones be edited from now on."""
        rospy.Service("set_zone", SetZone, self._on_set)
        rospy.Service("remove_zone", RemoveZone, self._on_remove)

    def follow_map(self, digest: str, old_in_new: Pose = _SAME) -> None:
        """Go on with the zones of another map; hold the lock.

        A map that grows keeps its zones. When it is finished, its old frame lies at ``old_in_new``
        in the frame of the finished map.
        """
        before, self._digest = self._digest, digest
        if digest == before == GROWING:
            return
        if before and digest == GROWING:  # another map is begun
            self._forget_growing()
        self.zones = self._kept(digest)
        if digest != GROWING:
            self._carry_over(old_in_new)
        self._tell()

    def look_again(self) -> bool:
        """Read the zones again; return whether they changed; hold the lock.

        Zones may have been saved for a map before it is published once more.
        """
        kept = self._kept(self._digest)
        if kept == self.zones:
            return False
        self.zones = kept
        self._tell()
        return True

    def _carry_over(self, old_in_new: Pose) -> None:
        """Move the zones of the map that was being made to the finished one, if it has none."""
        growing = self._kept(GROWING)
        if growing is None or self.zones is None:
            return
        if growing.all and not self.zones.all:
            self.zones = moved(growing, old_in_new)
            try:
                save_zones(self.zones, self._digest, self._path(self._digest))
            except OSError as error:
                rospy.logerr("the zones cannot be saved: %s", error)
                return
        self._forget_growing()

    def _kept(self, digest: str) -> Zones | None:
        """Return the zones of a map; None when they cannot be read."""
        try:
            return load_zones(self._path(digest), digest, rospy.logerr)
        except ZonesError as error:
            self.unreadable = str(error)
            rospy.logerr("%s", error)
            return None

    def _path(self, digest: str) -> Path:
        name = self._growing if digest == GROWING else map_file_name(digest)
        return self._folder / f"{name}.yaml"

    def _forget_growing(self) -> None:
        """Forget the zones of a map that was being made: it is whole, or given up."""
        try:
            remove_kept(self._path(GROWING))
        except OSError as error:
            rospy.logerr("zones of a map that was being made are not forgotten: %s", error)

    def _forget_other_runs(self, robot: str, run: str) -> None:
        """Remove the zones of unfinished maps of the robot's earlier runs."""
        for path in self._folder.glob(f"{GROWING}-{robot}-*"):
            if not run or not path.name.startswith(self._growing):
                with contextlib.suppress(OSError):
                    path.unlink()

    def _tell(self) -> None:
        now, zones = rospy.get_time(), self.zones or Zones()
        self._zones_publisher.publish(zones_message(now, zones, "map"))
        self._markers.publish(zones_markers(now, zones, "map"))

    def _edit(self, change: Callable[[Zones], Zones]) -> tuple[bool, str]:
        """Change the zones, tell and save them; return whether that was done, and what or why."""
        with self._lock:
            if not self._digest:
                return False, "there is no map yet; is home_sim_node running?"
            if self.zones is None:
                return False, f"{self.unreadable}; then restart"
            try:
                zones = change(self.zones)
                save_zones(zones, self._digest, self._path(self._digest))
            except ZonesError as error:
                return False, str(error)
            except OSError as error:
                return False, f"the zones cannot be saved: {error}; nothing was changed"
            self.zones = zones
            self._tell()
            self._on_edit()
            return True, f"the zones are: {listed(zones.names)}"

    def _on_set(self, request: SetZoneRequest) -> SetZoneResponse:
        return SetZoneResponse(*self._edit(lambda zones: zones.with_zone(zone_of(request.zone))))

    def _on_remove(self, request: RemoveZoneRequest) -> RemoveZoneResponse:
        return RemoveZoneResponse(*self._edit(lambda zones: zones.without(request.name)))
