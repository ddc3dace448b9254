"""Making a map on ROS: a mapper in place of the localizer, until its map is whole.

The map is saved while it grows, and resumed by the next process if this one is killed.
"""

from __future__ import annotations

import threading

import rospy

from roomba.configuration.mapping import MappingConfig
from roomba.configuration.nodes import PlacingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.slam.map_drawing import MapDrawing
from roomba.perception.slam.mapper import Mapper
from roomba_ros.localization.topics import LocalizationTopics
from roomba_ros.maps.map_memory import MapMemory
from roomba_ros.runtime.background import Background


class MapMaker:
    """Begins a map where the robot stands, lets it grow, and finishes it.

    ``station`` is the pose of the station, looking into it, map frame, once the robot stood on it;
    ``is_docked`` is whether the robot stands on it now, as the last :meth:`note_station` said.
    ``has_dock`` is whether the body ever sent a dock status. For a body that did not, the place
    where the map began is taken for the station.
    """

    def __init__(
        self,
        config: RobotConfig,
        mapping: MappingConfig,
        placing: PlacingConfig,
        place: LocalizationTopics,
        background: Background,
        memory: MapMemory,
    ) -> None:
        """Begin nothing yet."""
        self._config, self._mapping, self._placing = config, mapping, placing
        self._place, self._background, self._memory = place, background, memory
        self._drawing: MapDrawing | None = None
        self._lock = threading.Lock()
        self._whole: OccupancyMap | None = None
        self.is_docked = False
        self.has_dock = False
        self.station: Pose | None = None
        self._station_from_start: Pose | None = None

    @property
    def is_growing(self) -> bool:
        """Whether a map is being made."""
        return self._place.mapper is not None

    def begin(self) -> None:
        """Begin where the robot is by what was told; needs odometry."""
        config = self._config
        self._memory.forget()
        self._memory.forget_whole()
        here = self._place.place_heard_from
        self._map_with(Mapper(self._mapping, config.localization, config.gyro, here))
        self.station = self._station_from_start = None
        rospy.loginfo("the robot begins a map of its own")

    def take_up(self) -> bool:
        """Go on with the map that a killed process was making; return whether there is one.

        Needs odometry that went on since then.
        """
        kept = self._memory.recall()
        if kept is None:
            return False
        config = self._config
        here = self._place.place_heard_from
        if kept.station is not None and self.is_docked:
            here = config.body.docked_at(kept.station)
        self._map_with(
            Mapper.taken_up(self._mapping, config.localization, config.gyro, kept.state, here)
        )
        self.station, self._station_from_start = kept.station, kept.station_from_start
        rospy.logwarn("this node ended while it made a map; it is taken up")
        return True

    def note_station(self, is_docked: bool) -> bool:
        """Remember the station's pose while the robot stands on it; return whether it is new."""
        self.is_docked = is_docked
        mapper = self._place.mapper
        if mapper is None or not (is_docked and mapper.version):
            return False
        if self.station is None:
            self._remember_station(mapper, mapper.pose)
            return True
        if mapper.estimate.knowledge is Knowledge.LOST and not self._place.is_mapping_held:
            # The robot was carried home.
            mapper.told(self._config.body.docked_at(self.station))
        return False

    def keep(self, now: float) -> None:
        """Remember the map, if it is due, and only once a restarted node would know the place."""
        mapper = self._place.mapper
        if mapper is None or self._place.is_mapping_held or not self._place.is_place_kept:
            return
        is_lost = mapper.estimate.knowledge is Knowledge.LOST
        if not self._memory.is_due(now, mapper.version, is_lost=is_lost):
            return
        state = mapper.state()
        if state is not None:
            self._memory.keep(now, state, self.station, self._station_from_start)

    def grown(self, now: float) -> OccupancyMap | None:
        """Return the map as it is now, if it is time to publish it."""
        if self._drawing is None or self._place.is_mapping_held:
            return None
        return self._drawing.draw(now)

    def finish(self) -> None:
        """Finish the map in the background; the robot should stand meanwhile."""
        mapper = self._place.mapper
        if mapper is None or self._place.is_mapping_held:
            return
        # The mapper still tells the pose, by the wheels, but adds nothing to the map.
        self._place.is_mapping_held = True
        if self.station is None and not self.has_dock:
            self._remember_station(mapper, mapper.start)
        self._background.do("the map does not become whole", lambda: self._finish(mapper))

    def take_whole(self) -> OccupancyMap | None:
        """Return the finished map, once, as soon as it is there; the localizer goes on with it."""
        with self._lock:
            whole, self._whole = self._whole, None
        mapper = self._place.mapper
        if whole is None or mapper is None:
            return None
        if self._station_from_start is not None:
            # Finishing turned the map a little.
            self.station = mapper.start.compose(self._station_from_start)
        self._place.go_on(whole, mapper.pose, self._placing.on_finished)
        self._place.map_with(None)
        self._drawing = None
        return whole

    def _remember_station(self, mapper: Mapper, docked: Pose) -> None:
        """Remember the station by the pose of a robot that stands, or stood, docked; map frame."""
        self.station = self._config.body.docked_at(docked)
        self._station_from_start = mapper.start.inverse().compose(self.station)

    def _map_with(self, mapper: Mapper) -> None:
        self._place.map_with(mapper)
        self._drawing = MapDrawing(mapper, self._config.timing)

    def _finish(self, mapper: Mapper) -> None:
        try:
            whole = mapper.finish()
        except BaseException:
            self._place.is_mapping_held = False
            raise
        with self._lock:
            self._whole = whole
