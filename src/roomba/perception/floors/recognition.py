"""Recognition of the floor on which the robot woke, and of its pose there; or of a new floor.

All places of all floors are compared by how well the same scans fit there; so is the hypothesis
that the floor is new. The hypothesis that is clearly the likeliest is believed; until there is one,
more scans from other places are needed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import FloorsConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.search.relocation import Expectation, Relocation, Verdict
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField


class FloorVerdict(Enum):
    """What is known of the floor."""

    SEARCHING = "places are being compared"
    """Call :meth:`FloorRecognition.advance`; before that, show it a scan."""
    UNSURE = "more than one place fits"
    """Scans from other places may decide; on floors that look alike they never will."""
    KNOWN = "one place fits"
    """The place is :attr:`FloorRecognition.place`."""
    NEW = "no floor fits"
    """The robot was never here."""


@dataclass(frozen=True, slots=True, eq=False)
class FloorRecord:
    """A floor that is known: its map, and the docked robot's pose in it."""

    occupancy: OccupancyMap
    station: Pose


@dataclass(frozen=True, slots=True)
class FloorPlace:
    """Where the robot may be: a floor by name, the pose in its map at the newest scan that counted.

    ``evidence`` of all scans so far compares places and floors; ``fit`` is that of the newest scan.
    """

    floor: str
    pose: Pose
    evidence: float
    fit: Fit


class FloorRecognition:
    """One attempt to recognise the floor; ``reckoned`` poses are those of DeadReckoning.

    Show it scans with :meth:`see` and let it work with :meth:`advance` until the verdict is KNOWN
    or NEW.
    """

    def __init__(
        self,
        floors: Mapping[str, FloorRecord],
        config: LocalizationConfig,
        expected: FloorsConfig,
        body_radius: float,
    ) -> None:
        """``floors`` by name; ``body_radius``, m, tells where the robot can stand."""
        self._floors = dict(floors)
        self._fields = {name: SurfaceField.of(each.occupancy) for name, each in floors.items()}
        self._config, self._expected, self._body_radius = config, expected, body_radius
        self._searches: dict[str, Relocation] = {}
        self._reckoned = Pose()
        self._beams = 0
        self.views = 0
        """How many scans counted."""

    def see(self, view: ScanView, reckoned: Pose) -> None:
        """Take a scan that was taken at ``reckoned``.

        The scan counts if it has enough beams, and if the robot has moved or turned since the last
        scan that counted. While places are being searched for, scans are left out.
        """
        if len(view) < self._config.least_beams or not self._floors:
            return
        if not self._searches:
            self._begin(view, reckoned)
            return
        if any(search.verdict is Verdict.SEARCHING for search in self._searches.values()):
            return
        for search in self._searches.values():
            search.see(view, reckoned)
        if max(search.views for search in self._searches.values()) > self.views:
            self._count(view, reckoned)

    def advance(self) -> None:
        """Search on for some 10 ms, if a search is not finished yet."""
        for search in self._searches.values():
            if search.verdict is Verdict.SEARCHING:
                search.advance()
                return

    @property
    def verdict(self) -> FloorVerdict:
        """What is known by now."""
        if not self._floors:
            return FloorVerdict.NEW
        if not self._searches or any(
            search.verdict is Verdict.SEARCHING for search in self._searches.values()
        ):
            return FloorVerdict.SEARCHING
        places, needed = self.places, self._config.needed_evidence
        likeliest = [place.evidence for place in places[:2]]
        if not places or self._new_evidence - likeliest[0] > needed:
            return FloorVerdict.NEW
        next_best = max([self._new_evidence, *likeliest[1:]])
        return FloorVerdict.KNOWN if likeliest[0] - next_best > needed else FloorVerdict.UNSURE

    @property
    def place(self) -> FloorPlace | None:
        """Where the robot is, when that is known."""
        return self.places[0] if self.verdict is FloorVerdict.KNOWN else None

    @property
    def places(self) -> tuple[FloorPlace, ...]:
        """Where the robot may be on all floors, likeliest first; none until a search has places."""
        found = [
            FloorPlace(name, each.frame.compose(self._reckoned), each.evidence, each.fit)
            for name, search in self._searches.items()
            for each in search.hypotheses
        ]
        return tuple(sorted(found, key=lambda place: (-place.evidence, place.floor)))

    @property
    def _new_evidence(self) -> float:
        return self._expected.new_evidence * self._beams

    def _begin(self, view: ScanView, reckoned: Pose) -> None:
        """Search all floors for where the first scan was taken; their stations are tried first."""
        for name, floor in self._floors.items():
            docked = Expectation(
                floor.station,
                self._expected.station_radius,
                self._expected.station_turn,
                self._expected.station_evidence,
            )
            self._searches[name] = Relocation(
                self._fields[name], self._config, self._body_radius, view, reckoned, docked
            )
        self._count(view, reckoned)

    def _count(self, view: ScanView, reckoned: Pose) -> None:
        self.views += 1
        self._beams += len(view)
        self._reckoned = reckoned
