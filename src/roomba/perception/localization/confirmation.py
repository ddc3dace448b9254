"""A pose that was reported, or is no longer believed: scans confirm it, or refute it."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from roomba.configuration.localization import LocalizationConfig
from roomba.geometry import Pose
from roomba.perception.localization.doubt import Doubt
from roomba.perception.localization.search.expecting import where_found_near, where_told
from roomba.perception.localization.search.relocation import Expectation
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField

_TOLD: Final = "what the lidar sees does not fit well where it was told to be"
_NEAR: Final = "it may have been carried: another place fits what the lidar sees as well"


class Refuted(NamedTuple):
    """A pose that is not to be kept: where the robot was expected, and why not there."""

    expectation: Expectation
    why: str


class Confirmation:
    """The pose to be confirmed: ``awaited`` until the next scan that tells, then ``compared``.

    It is compared with all other places only if that scan does not decide. ``told_at`` is when a
    pose was reported last, s of the robot's clock.
    """

    def __init__(self, config: LocalizationConfig, doubt: Doubt) -> None:
        """Begin with nothing told; ``doubt`` compares places."""
        self._config, self._doubt = config, doubt
        self.told_at = -math.inf
        self.awaited: Expectation | None = None
        self.compared: Expectation | None = None
        self._is_near = False
        self._least, self._most = config.fit.good_agree, config.fit.good_through

    @property
    def is_open(self) -> bool:
        """Whether a pose is still to be confirmed."""
        return self.awaited is not None or self.compared is not None

    def told(self, now: float, pose: Pose, deviation: tuple[float, float]) -> None:
        """Await a reported pose, map frame, with deviations in m and rad, in place of any other."""
        self.compared, self.told_at = None, now
        self.await_at(pose, deviation)

    def await_at(self, pose: Pose, deviation: tuple[float, float]) -> None:
        """Have the next scan confirm a pose that is so unsure, m and rad."""
        self.awaited = where_told(pose, deviation, self._config)
        self._least, self._most = self._config.fit.good_agree, self._config.fit.good_through

    def need_less(self) -> None:
        """Let a fair fit confirm the pose: more speaks for it than for a reported one."""
        self._least, self._most = self._config.fit.fair_agree, self._config.fit.fair_through

    def compare_near(
        self, now: float, pose: Pose, view: ScanView, reckoned: Pose, field: SurfaceField
    ) -> Refuted | None:
        """Begin to compare a pose, which a scan fits best of all near by, with all others.

        It is compared however well it fits: in a symmetric room others fit as well. The result is
        that of :meth:`refuted`, which goes on with the comparison.
        """
        self._doubt.drop()
        self.compared, self._is_near = where_found_near(pose, self._config), True
        return self._go_on_comparing(self.compared, now, view, reckoned, field)

    def drop(self) -> None:
        """Confirm nothing any more: the pose is not believed."""
        self.awaited = self.compared = None

    def refuted(
        self, now: float, fit: Fit, view: ScanView, reckoned: Pose, field: SurfaceField
    ) -> Refuted | None:
        """Take a scan and its fit; return the pose if it is refuted, None if it is to be kept.

        ``now`` is in s, ``reckoned`` the pose of dead reckoning at which the scan was taken.
        """
        if self.awaited is not None:
            return self._checked(self.awaited, fit)
        if self.compared is None:
            return None
        return self._go_on_comparing(self.compared, now, view, reckoned, field)

    def _go_on_comparing(
        self, here: Expectation, now: float, view: ScanView, reckoned: Pose, field: SurfaceField
    ) -> Refuted | None:
        compared = self._doubt.compare(now, view, reckoned, here, field)
        if compared is None:
            return None
        self.compared = None
        if self._is_near:
            return Refuted(here, _NEAR) if compared.is_unsure else None
        return Refuted(here, _TOLD) if compared.is_elsewhere else None

    def _checked(self, told: Expectation, fit: Fit) -> Refuted | None:
        """Confirm the awaited pose if the scan fits well there; refute it if the scan hardly fits.

        If the scan fits in part, as on a map of another day, the pose is kept and compared with all
        other places.
        """
        self.awaited = None
        if fit.agree >= self._least and fit.through <= self._most:
            return None
        if fit.agree < self._config.fit.told_agree:
            return Refuted(told, _TOLD)
        self.compared, self._is_near = told, False
        return None
