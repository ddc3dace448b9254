"""Relocation: places that fit a scan, compared by further scans until one is the likeliest."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import FitConfig, LocalizationConfig
from roomba.geometry import Pose, wrap_angle
from roomba.perception.localization.search.matched import FROM_AFAR, FROM_NEAR, matched
from roomba.perception.localization.search.place_search import PlaceSearch
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField

CANDIDATES: Final = 300
"""Places of a search that are matched and judged."""
KEPT: Final = 60
"""Places that are compared further."""
_ALIKE: Final = 0.2
_ALIKE_TURN: Final = 0.2
"""m and rad; places nearer to each other than both are the same."""
_TYPICAL: Final = 25.0
"""Natural logarithm; minus the evidence down to which differences count in full. If even the
likeliest place has less, the map does not show the home as it is now, and the map's errors favour
one place or another."""
_FINE_CELL: Final = 0.05
"""m; size of cells up to which a map is as exact as the evidence assumes."""


class Verdict(Enum):
    """What is known of where the robot is."""

    SEARCHING = "places are being looked for"
    AMBIGUOUS = "several places fit"
    NOWHERE = "no place fits"
    FOUND = "one place fits"


@dataclass(frozen=True, slots=True)
class Expectation:
    """Where the robot should be: up to ``radius``, m, and ``turn``, rad, away from a pose.

    ``evidence`` is the advantage of such a place when places are compared. There it is also enough
    if half as many beams agree as elsewhere, and walls may be gone: a changed home is more frequent
    than a robot that is elsewhere.
    """

    pose: Pose
    radius: float
    turn: float
    evidence: float

    def is_met(self, pose: Pose) -> bool:
        """Whether a pose is within these limits."""
        near = pose.distance_to(self.pose.x, self.pose.y) <= self.radius
        return near and abs(wrap_angle(pose.theta - self.pose.theta)) <= self.turn

    def drifted(self, pose: Pose, more: float) -> Expectation:
        """Return it about ``pose``, to which dead reckoning led, wider by ``more``, m and rad."""
        return Expectation(pose, self.radius + more, self.turn + more, self.evidence)


@dataclass(slots=True)
class Hypothesis:
    """A place where the robot may be, as the pose of dead reckoning's ``frame`` in the map."""

    frame: Pose
    evidence: float
    fit: Fit
    is_expected: bool = False

    def is_possible(self, needed: FitConfig) -> bool:
        """Whether the scan fits at all there."""
        if self.is_expected:
            return self.fit.agree > 0.5 * needed.found_agree
        return self.fit.agree >= needed.found_agree and self.fit.through <= needed.found_through

    def is_convincing(self, needed: FitConfig) -> bool:
        """Whether enough of the scan fits to believe that the robot is not where it is expected.

        Otherwise furniture may have been moved around the expected place, so that another place
        only looks a little likelier.
        """
        return self.fit.agree >= needed.carried_agree and self.fit.through <= needed.carried_through


class Relocation:
    """One attempt to find the robot; ``reckoned`` poses are those of DeadReckoning.

    ``hypotheses`` are the possible places, likeliest first, after ``views`` scans that counted.
    """

    def __init__(
        self,
        field: SurfaceField,
        config: LocalizationConfig,
        body_radius: float,
        view: ScanView,
        reckoned: Pose,
        expectation: Expectation | None = None,
    ) -> None:
        """Search the map for the place that ``view`` was seen from."""
        self.hypotheses: list[Hypothesis] = []
        self.views = 0
        self._field, self._config = field, config
        self._search: PlaceSearch | None = PlaceSearch(field, view.ends, body_radius)
        self._view, self._reckoned = view, reckoned
        self._expectation = expectation

    @property
    def verdict(self) -> Verdict:
        """What is known by now."""
        if self._search is not None:
            return Verdict.SEARCHING
        needed = self._config.fit
        if not self.hypotheses or not self.hypotheses[0].is_possible(needed):
            return Verdict.NOWHERE
        best = self.hypotheses[0]
        is_elsewhere = self._expectation is not None and not best.is_expected
        if is_elsewhere and not best.is_convincing(needed):
            return Verdict.NOWHERE
        return Verdict.FOUND if self._is_clear() else Verdict.AMBIGUOUS

    def advance(self) -> None:
        """Search on for a while, if the search is not finished yet."""
        if self._search is not None and self._search.advance():
            starts = self._search.best(CANDIDATES)
            self._search = None
            self._compare(starts)

    def see(self, view: ScanView, reckoned: Pose) -> None:
        """Compare the places by another scan; it counts when the robot has moved since the last."""
        if self._search is not None or not self._is_new(reckoned):
            return
        self._view, self._reckoned = view, reckoned
        for hypothesis in self.hypotheses:
            pose, fit = self._matched(hypothesis.frame.compose(reckoned), FROM_NEAR)
            hypothesis.frame = pose.compose(reckoned.inverse())
            hypothesis.evidence += fit.evidence
            hypothesis.fit = fit
        self.views += 1
        self._sort()

    def is_tied(self, pose: Pose, reckoned: Pose) -> bool:
        """Whether all scans fit another possible place about as well as this one.

        False before places are compared, and if this place is not one of those compared. ``pose``
        is where the robot would be, map frame, when dead reckoning is at ``reckoned``.
        """
        frame = pose.compose(reckoned.inverse())
        this = next((each for each in self.hypotheses if self._are_alike(each.frame, frame)), None)
        return this is not None and any(
            other is not this
            and other.is_possible(self._config.fit)
            and this.evidence - other.evidence <= self._clear_lead
            for other in self.hypotheses
        )

    def _compare(self, starts: NDArray[np.float64]) -> None:
        """Match and judge the places that the search found."""
        back, expected = self._reckoned.inverse(), self._expectation
        tries = [(Pose(*start), FROM_AFAR) for start in starts.tolist()]
        if expected is not None:
            # Also match to near surfaces alone: new furniture would draw off a wider match.
            tries = [(expected.pose, FROM_NEAR), (expected.pose, FROM_AFAR), *tries]
            # The expected pose itself, unmatched, is a candidate, too, with its prior evidence.
            self._weigh(expected.pose, self._view.fit(self._field, expected.pose.as_array()), back)
        for start, scales in tries:
            self._weigh(*self._matched(start, scales), back)
        self.views = 1
        self._sort()

    def _weigh(self, pose: Pose, fit: Fit, back: Pose) -> None:
        """Add a place, with the advantage of an expected one if it is expected."""
        expected = self._expectation
        hypothesis = Hypothesis(pose.compose(back), fit.evidence, fit)
        if expected is not None and expected.is_met(pose):
            hypothesis.evidence += expected.evidence
            hypothesis.is_expected = True
        self.hypotheses.append(hypothesis)

    def _matched(self, start: Pose, scales: NDArray[np.float64]) -> tuple[Pose, Fit]:
        return matched(self._view, self._field, start, self._config.beam_deviation, scales)

    def _sort(self) -> None:
        """Sort the best place first; drop duplicates, and places whose evidence is hopeless."""
        kept: list[Hypothesis] = []
        best = max((each.evidence for each in self.hypotheses), default=0.0)
        hopeless = best - self._config.searching.hopeless * _unlike(best)
        for hypothesis in sorted(self.hypotheses, key=lambda each: -each.evidence):
            if hypothesis.evidence < hopeless:
                break
            if not any(self._are_alike(hypothesis.frame, other.frame) for other in kept):
                kept.append(hypothesis)
        self.hypotheses = kept[:KEPT]

    def _are_alike(self, one: Pose, other: Pose) -> bool:
        """Whether two frames of dead reckoning put the robot at the same place."""
        first, second = one.compose(self._reckoned), other.compose(self._reckoned)
        near = first.distance_to(second.x, second.y) < _ALIKE
        return near and abs(wrap_angle(first.theta - second.theta)) < _ALIKE_TURN

    def _is_new(self, reckoned: Pose) -> bool:
        since, new = self._reckoned.inverse().compose(reckoned), self._config.searching
        return math.hypot(since.x, since.y) > new.new_way or abs(since.theta) > new.new_turn

    def _is_clear(self) -> bool:
        """Whether the best place is so much better than the next that it can be believed."""
        if len(self.hypotheses) == 1:
            only = self.hypotheses[0]
            return only.is_expected or only.is_convincing(self._config.fit)
        return self.hypotheses[0].evidence - self.hypotheses[1].evidence > self._clear_lead

    @property
    def _clear_lead(self) -> float:
        """The lead in evidence that one place must have over another to be told apart from it."""
        # The walls of a coarse map are farther off, and the evidence errs with them.
        coarse = max(1.0, self._field.frame.resolution / _FINE_CELL)
        return self._config.needed_evidence * coarse * _unlike(self.hypotheses[0].evidence)


def _unlike(evidence: float) -> float:
    """Return the factor by which a lead must be larger, if the best place has this evidence."""
    return max(1.0, -evidence / _TYPICAL)
