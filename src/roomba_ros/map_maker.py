"""Making a map on ROS: a mapper in place of the localizer, until its map is whole."""

from __future__ import annotations

import threading
from typing import Final

import rospy

from roomba.config import RobotConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.estimate import Knowledge
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.mapping_config import MappingConfig
from roomba_ros.background import Background
from roomba_ros.localization_topics import LocalizationTopics

MAP_PERIOD: Final = 1.0
"""s of the ROS clock between two maps that are told while it grows."""
_FINISHED_DEVIATION: Final = (0.03, 0.02)
"""m, rad; how unsure the place on the whole map is before a scan confirms it."""


class MapMaker:
    """Begins a map where the robot stands, lets it grow, and makes it whole.

    ``station`` is where the robot stood on its station, map frame, once it did.
    """

    def __init__(
        self,
        config: RobotConfig,
        mapping: MappingConfig,
        place: LocalizationTopics,
        background: Background,
    ) -> None:
        """Begin nothing yet."""
        self._config, self._mapping = config, mapping
        self._place, self._background = place, background
        self._mapper: Mapper | None = None
        self._told = (-1.0, -1)
        self._lock = threading.Lock()
        self._whole: OccupancyMap | None = None
        self._finishes = False
        self.station: Pose | None = None
        self._station_from_start: Pose | None = None

    @property
    def is_growing(self) -> bool:
        """Whether a map is being made."""
        return self._mapper is not None

    def begin(self) -> None:
        """Begin where the robot is by what was told; needs odometry."""
        config = self._config
        self._mapper = Mapper(self._mapping, config.localization, config.gyro, self._place.place)
        self._place.mapper = self._mapper
        self._told = (-1.0, -1)
        self.station = self._station_from_start = None
        rospy.loginfo("the robot begins a map of its own")

    def note_station(self, is_docked: bool) -> bool:
        """Remember where the station is while the robot stands on it; tell whether that is new."""
        mapper = self._mapper
        if mapper is None or not (is_docked and mapper.version):
            return False
        if self.station is None:
            self.station = mapper.pose
            self._station_from_start = mapper.start.inverse().compose(mapper.pose)
            return True
        if mapper.estimate.knowledge is Knowledge.LOST and not self._finishes:
            # Somebody carried it home.
            mapper.told(self.station)
        return False

    def grown(self, now: float) -> OccupancyMap | None:
        """Return the map as it is by now, if it is time to tell it."""
        mapper = self._mapper
        if mapper is None or self._finishes or not mapper.version:
            return None
        told, version = self._told
        if mapper.version == version or 0.0 <= now - told < MAP_PERIOD:
            return None
        self._told = (now, mapper.version)
        return mapper.occupancy()

    def finish(self) -> None:
        """Make the map whole, in the background; the robot should stand meanwhile."""
        mapper = self._mapper
        if mapper is None or self._finishes:
            return
        self._finishes = True
        # Its place is told on, by the wheels, but nothing is added any more.
        self._place.is_mapping_held = True
        self._background.do("the map does not become whole", lambda: self._finish(mapper))

    def take_whole(self) -> OccupancyMap | None:
        """Return the whole map, once, as soon as it is; the localizer goes on with it."""
        with self._lock:
            whole, self._whole = self._whole, None
        mapper, localizer = self._mapper, self._place.localizer
        if whole is None or mapper is None or localizer is None:
            return None
        if self._station_from_start is not None:
            # To be whole the map was turned a little.
            self.station = mapper.start.compose(self._station_from_start)
        localizer.use_map(whole)
        localizer.told(mapper.pose, _FINISHED_DEVIATION)
        self._place.mapper = self._mapper = None
        self._place.is_mapping_held = self._finishes = False
        return whole

    def _finish(self, mapper: Mapper) -> None:
        try:
            whole = mapper.finish()
        except BaseException:
            self._finishes = self._place.is_mapping_held = False
            raise
        with self._lock:
            self._whole = whole
