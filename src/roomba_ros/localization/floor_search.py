"""Recognizes by the newest scans on which of its saved maps the robot is, on ROS."""

from __future__ import annotations

from roomba.configuration.mapping import FloorsConfig
from roomba.configuration.robot import RobotConfig
from roomba.perception.floors.recognition import (
    FloorPlace,
    FloorRecognition,
    FloorRecord,
    FloorVerdict,
)
from roomba.storage.map_store import StoredMap
from roomba_ros.localization.topics import LocalizationTopics


class FloorSearch:
    """Compares what is in sight with the maps of all ``floors``, by name, a little at a tick."""

    def __init__(
        self,
        now: float,
        config: RobotConfig,
        expected: FloorsConfig,
        place: LocalizationTopics,
        floors: dict[str, StoredMap],
        longest: float,
    ) -> None:
        """Begin at ``now``, s of the ROS clock; after ``longest`` s it is a new floor."""
        self.floors = floors
        self._place, self._since, self._longest = place, now, longest
        known = {
            name: FloorRecord(each.occupancy, config.body.docked_at(each.station))
            for name, each in floors.items()
        }
        self._recognition = FloorRecognition(
            known, config.localization, expected, config.body.radius
        )

    def tick(self) -> FloorPlace | None:
        """Compare a little further; return the floor and the place on it, once they are clear."""
        seen, localizer = self._place.seen, self._place.localizer
        if seen is not None and localizer is not None:
            self._recognition.see(seen.lidar.view(seen.ranges), localizer.reckoned)
        self._recognition.advance()
        return self._recognition.place

    def has_failed(self, now: float) -> bool:
        """Whether the robot is on none of the saved floors, as far as can be told by now."""
        is_late = not 0.0 <= now - self._since <= self._longest
        return is_late or self._recognition.verdict is FloorVerdict.NEW
