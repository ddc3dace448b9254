"""Looking out for what the map does not show, in the scans that the robot looks at."""

from __future__ import annotations

from roomba.configuration.robot import RobotConfig
from roomba.configuration.things import ThingConfig
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.scan_view import LidarModel, PlacedScan
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer


class Lookout:
    """Keeps the layer of ``things`` besides a map, from the first map on."""

    def __init__(self, robot: RobotConfig, config: ThingConfig | None = None) -> None:
        """Begin without a map: nothing is a thing."""
        self._stride, self._config = robot.scan_stride, config
        self._known_deviation = robot.localization.known_deviation
        self.things: ThingLayer | None = None
        self._beams: tuple[LidarModel, LidarBeams] | None = None

    def look_beside(self, field: SurfaceField) -> ThingLayer:
        """Look from now on for what the map of ``field`` does not show; return the new layer."""
        self.things = ThingLayer(field, self._config)
        return self.things

    def look(self, scan: PlacedScan | None, knowledge: Knowledge, unsure: float) -> None:
        """Look for things in ``scan``, if there is one, and only if the place is well known.

        ``unsure`` is the deviation of the place, m. A place that is ROUGH because the home changed
        is still known that well, and what changed is what is to be seen.
        """
        is_known = knowledge is Knowledge.KNOWN or (
            knowledge.is_usable and unsure <= self._known_deviation
        )
        if scan is not None and self.things is not None and is_known:
            beams = self.beams_of(scan.lidar)
            self.things.see(scan.ranges, beams, scan.pose, self._stride, scan.measured, unsure)

    def beams_of(self, lidar: LidarModel) -> LidarBeams:
        """Return a lidar in the form that compiled kernels take, made once for each lidar."""
        if self._beams is None or self._beams[0] is not lidar:
            self._beams = lidar, lidar.arrays()
        return self._beams[1]
