"""Changes of the robot's own map, on ROS: detected, offered, refused."""

from __future__ import annotations

import rospy
from roomba_robot.msg import MapUpdate

from roomba.configuration.mapping import MapChangesConfig
from roomba.grid import OccupancyMap
from roomba.perception.floors.map_changes import Change, MapChanges
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.storage.map_store import MapStoreError
from roomba_ros.convert.mapping import update_message
from roomba_ros.localization.topics import LocalizationTopics


class ChangeTopics:
    """Detects changes against the map by scans, and offers them.

    Publishes: ``map/update`` (MapUpdate, latched).
    """

    def __init__(self, place: LocalizationTopics, config: MapChangesConfig, period: float) -> None:
        """Connect nothing yet; a scan is looked through each ``period`` s."""
        self._place, self._config, self._period = place, config, period
        self._changes: MapChanges | None = None
        self._seen = -1.0
        self._offered: tuple[Change, ...] = ()

    def start(self) -> None:
        """Connect."""
        self._publisher = rospy.Publisher("map/update", MapUpdate, queue_size=1, latch=True)

    def begin(self, now: float, occupancy: OccupancyMap) -> None:
        """Go on with another map, of which nothing was seen yet."""
        self._changes = MapChanges(occupancy, self._config)
        self._offered = ()
        self._tell(now)

    def look(self, now: float, estimate: Estimate, *, is_docked: bool) -> None:
        """Use a scan now and then; offer the changes when the robot is on its station."""
        seen, changes = self._place.seen, self._changes
        if changes is None or seen is None or estimate.knowledge is not Knowledge.KNOWN:
            return
        if not 0.0 <= seen.stamp - self._seen < self._period:
            self._seen = seen.stamp
            changes.see(seen.stamp, seen.ranges, seen.lidar.arrays(), estimate.pose)
        if is_docked:
            self._offer(now, changes)

    def proposed(self) -> OccupancyMap:
        """Return the map as it is offered; raises MapStoreError when nothing is."""
        return self._offering().proposed()

    def refuse(self, now: float) -> None:
        """Offer this no more; raises MapStoreError when nothing is offered."""
        changes = self._offering()
        for change in changes.changes():
            changes.dismissed(change)
        self._offer(now, changes)

    def _offering(self) -> MapChanges:
        if self._changes is None or not self._offered:
            raise MapStoreError("expected an offer (see map/update), got none")
        return self._changes

    def _offer(self, now: float, changes: MapChanges) -> None:
        offered = changes.changes()
        if offered == self._offered:
            return
        self._offered = offered
        self._tell(now)
        if offered:
            rospy.loginfo("%d changes against the map are offered; see map/update", len(offered))

    def _tell(self, now: float) -> None:
        self._publisher.publish(update_message(now, self._offered, "map"))
