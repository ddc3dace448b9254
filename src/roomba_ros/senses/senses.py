"""The readings of a robot on ROS: those of its body, and its published place."""

from __future__ import annotations

from dataclasses import replace

from roomba.configuration.nodes import HearingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.inputs.senses import Senses
from roomba.perception.matching.scan_view import PlacedScan, plain_ranges
from roomba.robot.lookout import Lookout
from roomba.robot.place import ScanSelection
from roomba.robot.readings import Readings, ScanReading, senses_of
from roomba_ros.senses.body_topics import BodyTopics
from roomba_ros.senses.heard_place import HeardPlace


class HeardSenses:
    """Puts together what a node senses that does not localize the robot itself."""

    def __init__(self, config: RobotConfig, hearing: HearingConfig, *topics: str) -> None:
        """Connect nothing yet."""
        self._body = BodyTopics(config, *topics, "lidar_correction")
        self.place = HeardPlace(config, hearing)
        self._scans = ScanSelection(config.timing)
        self._readings: Readings | None = None
        self._scan: ScanReading | None = None

    def start(self) -> None:
        """Connect."""
        self.place.start()
        self._body.start()

    def missing(self, *topics: str) -> tuple[str, ...]:
        """Return those of the body's topics, and ``pose``, of which nothing was heard yet."""
        without_pose = ("pose",) if self.place.told is None else ()
        return without_pose + self._body.missing(*topics)

    def at(self, now: float) -> Senses | None:
        """Take the messages since the last call; return all readings for a time, s.

        None until place and odometry were heard.
        """
        self._scan = None
        for readings in self._body.take():
            self._readings = readings
            self.place.move(readings)
            if self._scans.selects(readings.scan):
                self._scan = readings.scan
        pose = self.place.at(now)
        if pose is None or self._readings is None:
            return None
        knowledge, trouble = self.place.knowledge
        return senses_of(
            replace(self._readings, time=now),
            pose,
            knowledge,
            trouble=trouble,
            unsure=self.place.deviation,
        )

    def show(self, lookout: Lookout) -> None:
        """Let a lookout search the newest scan for things, if there is a new one with a pose."""
        scan = self._scan
        pose = None if scan is None else self.place.at(scan.stamp)
        if scan is not None and pose is not None:
            still = scan.lidar.at_once(scan.stamp, scan.ranges, self.place.path)
            placed = PlacedScan(pose, still, plain_ranges(scan.ranges), scan.lidar)
            lookout.look(placed, self.place.knowledge[0], self.place.deviation)

    @property
    def pose(self) -> Pose | None:
        """Where the robot was told to be last, map frame; None before that."""
        return self.place.told
