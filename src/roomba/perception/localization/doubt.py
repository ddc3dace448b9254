"""Doubt of the pose if scans do not fit the map: the home changed, or the robot is elsewhere.

What the robot sees now is compared with what it saw a moment ago: if that is the same, the robot
was not carried. But its pose may have been wrong before, and is compared with all other places.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from roomba.configuration.localization import LocalizationConfig
from roomba.geometry import Pose
from roomba.perception.localization.recent_sight import RecentSight
from roomba.perception.localization.search.expecting import where_known
from roomba.perception.localization.search.relocation import Expectation, Relocation, Verdict
from roomba.perception.matching.scan_view import ScanView
from roomba.perception.matching.surface_field import SurfaceField


class Compared(NamedTuple):
    """The result of comparing a place with all others."""

    verdict: Verdict
    is_expected: bool
    """Whether the likeliest place is the one that was compared."""

    @property
    def is_elsewhere(self) -> bool:
        """Whether the robot must be at another place."""
        return self.verdict is Verdict.FOUND and not self.is_expected

    @property
    def is_unsure(self) -> bool:
        """Whether the robot may be at another place: that one is likelier, or several fit alike."""
        return self.is_elsewhere or self.verdict is Verdict.AMBIGUOUS


class Doubt:
    """The doubt about a known pose. It gets each scan; ``sight`` has those of the last seconds.

    ``reckoned`` is the pose of dead reckoning at which a scan was taken.
    """

    def __init__(self, config: LocalizationConfig, body_radius: float) -> None:
        """Begin with nothing seen."""
        self._config, self._body_radius = config, body_radius
        self.sight = RecentSight(config.recent_sight)
        self._comparison: Relocation | None = None
        self._compared = -math.inf
        self._last: Pose | None = None
        self._way = 0.0
        """m; driven while scans did not correct the pose; turns on the spot do not count."""

    def note(self, stamp: float, reckoned: Pose, view: ScanView) -> None:
        """Remember a scan that was taken at a time, s."""
        self.sight.note(stamp, reckoned, view)

    def drop(self) -> None:
        """End a comparison that is under way: the map is another one, or the pose not known."""
        self._comparison = None
        self.end()

    def end(self) -> None:
        """Doubt no more: scans fit again."""
        self._last, self._way = None, 0.0

    def follow(self, reckoned: Pose, *, fits: bool) -> None:
        """Take where dead reckoning is at a scan, and whether scans correct the pose."""
        if fits:
            self.end()
            return
        last = self._last or reckoned
        self._way += last.distance_to(reckoned.x, reckoned.y)
        self._last = reckoned

    @property
    def lasts(self) -> bool:
        """Whether the robot drove on by dead reckoning for so long that its place is unsure."""
        return self._way > self._config.searching.doubted_way

    def expected(
        self,
        now: float,
        stamp: float,
        view: ScanView,
        reckoned: Pose,
        pose: Pose,
        field: SurfaceField,
    ) -> Expectation | None:
        """Return where to expect the robot in a search, or None if ``pose`` is to be kept.

        A comparison takes some scans: meanwhile the pose is kept. ``now`` and ``stamp`` are in s.
        """
        is_still = self.sight.is_still(stamp, reckoned, view)
        here = where_known(pose, self._config, is_still=is_still)
        if is_still:
            since, again = now - self._compared, self._config.searching.compare_after
            is_soon = self._comparison is None and 0.0 <= since < again
            compared = None if is_soon else self.compare(now, view, reckoned, here, field)
            if compared is None or not compared.is_elsewhere:
                return None
        return here

    def compare(
        self, now: float, view: ScanView, reckoned: Pose, here: Expectation, field: SurfaceField
    ) -> Compared | None:
        """Compare the place with all others, a piece at each scan; return the result.

        None means that the comparison goes on at the next scan. ``now`` is in s.
        """
        if self._comparison is None:
            self._comparison = Relocation(
                field, self._config, self._body_radius, view, reckoned, here
            )
        comparison = self._comparison
        comparison.advance()
        if comparison.verdict is Verdict.SEARCHING:
            return None
        self._comparison, self._compared = None, now
        is_expected = bool(comparison.hypotheses) and comparison.hypotheses[0].is_expected
        return Compared(comparison.verdict, is_expected)
