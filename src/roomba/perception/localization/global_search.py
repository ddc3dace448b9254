"""A search for the robot on the whole map, from when its place is forgotten until it is found.

Relocations compare places by what is in sight. If none is found while the robot drives some way,
particles follow all places where it may be.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from roomba.configuration.localization import LocalizationConfig
from roomba.geometry import Pose
from roomba.perception.localization.knowledge import Searched
from roomba.perception.localization.learned_walls import LearnedWalls
from roomba.perception.localization.search.expecting import searched_for
from roomba.perception.localization.search.particle_search import ParticleSearch
from roomba.perception.localization.search.relocation import (
    Expectation,
    Hypothesis,
    Relocation,
    Verdict,
)
from roomba.perception.matching.scan_view import Fit, ScanView


class FoundPlace(NamedTuple):
    """Where the robot is now, map frame, and how well the scan fits by which it was found."""

    pose: Pose
    fit: Fit


class GlobalSearch:
    """A search under way: ``since`` when, s of the robot's clock, and ``why``.

    ``reckoned`` poses are those of DeadReckoning.
    """

    def __init__(
        self,
        why: str,
        since: float,
        expectation: Expectation | None,
        walls: LearnedWalls,
        config: LocalizationConfig,
        body_radius: float,
    ) -> None:
        """Begin on the map of ``walls``; ``expectation`` is where the robot should be, if any."""
        self.why, self.since, self.verdict = why, since, Verdict.SEARCHING
        self._counted_from = since
        self._expectation, self._walls = expectation, walls
        self._config, self._body_radius = config, body_radius
        self._relocation: Relocation | None = None
        self._told: Relocation | None = None
        """The newest relocation that has compared places; one that has just begun has not."""
        self._particles: ParticleSearch | None = None
        self._from: Pose | None = None
        self._tried = -math.inf

    def use(self, walls: LearnedWalls) -> None:
        """Go on searching in another map; the time since the search began still counts."""
        self._walls = walls
        self._relocation = self._told = self._particles = None

    def clock_set(self, now: float) -> None:
        """Begin all times anew, as the clock was set."""
        self.since = self._counted_from = self._tried = now

    def look_anew(self, now: float) -> None:
        """Count the time of the search from now on, s: the robot begins to look around."""
        self._counted_from = now

    def so_far(self, now: float) -> Searched:
        """Return the state of the search at a time, s."""
        return Searched(self.why, now - self._counted_from, self.verdict)

    def see(
        self, now: float, view: ScanView, reckoned: Pose, newest: Pose, believed: Pose
    ) -> FoundPlace | None:
        """Search on by a scan that was taken at ``reckoned``; return the place once it is found.

        At the time ``now``, s, dead reckoning is at its ``newest`` pose, which is ``believed`` on
        the map if the pose was right before the search.
        """
        since = reckoned.inverse().compose(newest)
        if self._relocation is None:
            here = believed.compose(since.inverse())
            self._relocation = self._begun(now, view, reckoned, here)
        return self._followed(view, reckoned, since) or self._compared(
            self._relocation, now, view, reckoned, newest
        )

    def needs_views(self, now: float) -> bool:
        """Whether the scans up to a time, s, do not tell the place, and other views would help."""
        if self._relocation is None:
            return now - self.since > self._config.searching.wait_before_moving
        return self._relocation.verdict is not Verdict.SEARCHING

    def hypotheses(self, reckoned: Pose) -> list[Pose]:
        """Return where the robot may be, map frame, likeliest first; [] before places are compared.

        ``reckoned`` is where dead reckoning is now.
        """
        places = self._relocation.hypotheses if self._relocation is not None else []
        return [each.frame.compose(reckoned) for each in places]

    def _begun(self, now: float, view: ScanView, reckoned: Pose, here: Pose) -> Relocation:
        """Begin to compare places; by dead reckoning alone the robot is ``here`` on the map."""
        expectation = self._expectation and searched_for(
            self._expectation, here, now - self.since, self._config
        )
        return Relocation(
            self._walls.field, self._config, self._body_radius, view, reckoned, expectation
        )

    def _followed(self, view: ScanView, reckoned: Pose, since: Pose) -> FoundPlace | None:
        """Follow all places by particles, once the robot drove some way without being found.

        Of places that look the same all the way, particles are left at one by chance. So as long as
        the relocation cannot tell places apart, none is believed.
        """
        start = self._from = self._from or reckoned
        if self._particles is None:
            if start.distance_to(reckoned.x, reckoned.y) < self._config.searching.follow_after:
                return None
            self._particles = ParticleSearch(self._walls.field, self._body_radius)
        self._particles.see(view, reckoned)
        pose = self._particles.found
        if pose is None or self._told is None:
            return None
        scan = self._particles.reckoned.inverse().compose(reckoned)
        there = self._walls.find(view, pose.compose(scan), self._config.beam_deviation)
        if self._told.is_tied(there, reckoned):
            return None
        fit = view.fit(self._walls.field, there.as_array())
        return FoundPlace(there.compose(since), fit)

    def _compared(
        self, relocation: Relocation, now: float, view: ScanView, reckoned: Pose, newest: Pose
    ) -> FoundPlace | None:
        """Compare places by the scan; after a while begin anew, unless several places fit."""
        was_searching = relocation.verdict is Verdict.SEARCHING
        relocation.advance()
        relocation.see(view, reckoned)
        if relocation.verdict is Verdict.SEARCHING:
            return None
        self._told = relocation
        if was_searching:
            self._tried = now
        self.verdict = relocation.verdict
        if relocation.verdict is Verdict.FOUND and self._is_believed(relocation.hypotheses[0]):
            place = relocation.hypotheses[0]
            return FoundPlace(place.frame.compose(newest), place.fit)
        is_time = now - self._tried > self._config.searching.again_after
        if relocation.verdict is not Verdict.AMBIGUOUS and is_time:
            self._relocation = None
        return None

    def _is_believed(self, place: Hypothesis) -> bool:
        """Whether the likeliest place is believed; once particles search, it must be convincing."""
        return self._particles is None or place.is_expected or place.is_convincing(self._config.fit)
