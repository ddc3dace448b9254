"""Finding a robot on its own growing map after it was carried: over all of the map, at any heading.

One scan may fit in several places. The place must fit clearly better than all others, and a second
scan, taken elsewhere, must be found where the first one and dead reckoning say.
"""

from __future__ import annotations

from roomba.arrays import Floats
from roomba.configuration.mapping import MappingConfig
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.slam.submaps.places import clearly_best
from roomba.perception.slam.submaps.pose_graph import composed, relative_to
from roomba.perception.slam.submaps.submap import Submap


class MapRelocation:
    """Keeps whether the robot is carried, and where the scan before was found.

    The robot ``is_lifted`` while its wheels hang in the air. It ``is_lost`` from when it is set
    down until its place is known again.
    """

    def __init__(self, config: MappingConfig) -> None:
        """Begin with the robot on the floor, where the map begins."""
        self._config = config
        self.is_lifted = self.is_lost = False
        self._searched_at: Floats | None = None
        self._found: Floats | None = None

    @property
    def is_placed(self) -> bool:
        """Whether the robot's place on the map is known, as it was followed all the way."""
        return not (self.is_lifted or self.is_lost)

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air; once set down, the robot is lost.

        A place that was found before is forgotten.
        """
        if self.is_lifted and not is_lifted:
            self.is_lost = True
            self._searched_at = self._found = None
        self.is_lifted = is_lifted

    def set_down(self) -> None:
        """Take the robot as on the floor, at an unknown place, but not as lost."""
        self.is_lifted = self.is_lost = False

    def find(
        self, points: Floats, reckoned: Floats, submaps: list[Submap], poses: Floats
    ) -> Floats | None:
        """Return where the robot is, [3], map frame, or None as long as that is not sure.

        ``points`` [n, 4] are those of a scan, ``reckoned`` [3] its pose by dead reckoning,
        ``poses`` [m, 3] those of the submaps.
        """
        config = self._config.relocation
        if len(points) < self._config.following.least_points:
            return None
        before, earlier = self._searched_at, self._found
        if before is not None and not is_apart(reckoned, before, config.moved, config.turned):
            return None
        self._searched_at = reckoned.copy()
        (place,) = clearly_best([points], submaps, poses, self._config, config.likelihood)
        self._found = found = None if place is None else place.pose
        if found is None or earlier is None or before is None:
            return None
        expected = composed(earlier[None], relative_to(before[None], reckoned[None]))[0]
        if is_apart(found, expected, config.same_place, config.same_heading):
            return None
        return found
