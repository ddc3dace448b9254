"""Localization on a known map: the stages put together.

Dead reckoning says how the robot moved, and a tracker corrects that by each scan. When scans no
longer fit, or the robot was carried, a global search looks for it on the whole map. Plain values
in and out; times in s of the robot's clock.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.clock import ClockJumps
from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.sensors import GyroConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.belief.correct_kernels import is_calm
from roomba.perception.localization.belief.reckon_kernels import SET_BACK
from roomba.perception.localization.confirmation import Confirmation
from roomba.perception.localization.doubt import Doubt
from roomba.perception.localization.estimate import UNKNOWN_COVARIANCE, Estimate, Knowledge
from roomba.perception.localization.global_search import FoundPlace, GlobalSearch
from roomba.perception.localization.knowledge import Circumstances, knowledge_in
from roomba.perception.localization.place_follower import PlaceFollower
from roomba.perception.localization.recent_sight_kernels import Sights
from roomba.perception.localization.search.near_search import better_near
from roomba.perception.localization.search.relocation import Expectation
from roomba.perception.localization.tracker import Tracker
from roomba.perception.matching.scan_view import Fit, LidarModel, PlacedScan, ScanView, plain_ranges
from roomba.perception.matching.surface_field import SurfaceField

_FOUND_SPREAD: Final = np.diag([0.05**2, 0.05**2, 0.03**2])
"""m2, rad2; covariance of a place that was just found, before scans narrow it down."""


class Localizer:
    """Keeps the estimate; tell it what the sensors say in the order of time.

    ``reckoning`` is its dead reckoning. ``view`` is the newest scan; ``placed`` is that scan at the
    pose on the map where it was taken, None if that is not known. While the localizer
    :attr:`is_calm`, kernels may do its work on
    ``belief``, ``path`` and ``numbers`` (see :mod:`.belief.correct_kernels`), and on ``sights``
    (see :mod:`.recent_sight_kernels`), until :meth:`resumed` is called.
    """

    def __init__(
        self,
        occupancy: OccupancyMap | None,
        config: LocalizationConfig,
        gyro: GyroConfig,
        body_radius: float,
        start: Pose,
        deviation: tuple[float, float] = (0.05, 0.05),
        stride: int = 1,
    ) -> None:
        """Begin near ``start``, map frame, unsure by ``deviation``, m and rad.

        Without a map it goes by wheels and gyro, until :meth:`use_map`. It is shown every
        ``stride``-th scan of the lidar.
        """
        self._map = occupancy
        self.view: ScanView | None = None
        self.placed: PlacedScan | None = None
        self._config, self._body_radius = config, body_radius
        self._followed = PlaceFollower(occupancy, config, gyro, stride)
        self.belief, self.numbers = self._followed.belief, self._followed.numbers
        self._row, self.reckoning = self._followed.row, self._followed.reckoning
        self.path = self.reckoning.path
        self._doubt = Doubt(config, body_radius)
        self._confirmation = Confirmation(config, self._doubt)
        self._search: GlobalSearch | None = None
        self._is_lifted = self._is_blind = False
        self._now = -math.inf
        self._stamps, self._times = (ClockJumps(tolerance=SET_BACK) for _ in range(2))
        self._has_clock = False
        self.told(start, deviation)

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, if there is one.

        Raises ValueError for numbers that are not finite.
        """
        if not (odometry.is_finite and math.isfinite(turning or 0.0)):
            raise ValueError(f"expected finite numbers, got {odometry} and {turning} rad/s")
        self._follow_clock(stamp, self._stamps)
        self.reckoning.move(stamp, odometry, turning)

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air: the robot is being carried."""
        if self._is_lifted and not is_lifted:
            awaited = self._confirmation.awaited
            self._search_for("it was lifted and set down again", awaited)
        self._is_lifted = is_lifted

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Take a scan, float32 [beams], m; raises ValueError for another number of beams."""
        taken = stamp - self.latency
        still = lidar.at_once(taken, ranges, self.path)
        self.view = view = lidar.view(still)
        self.placed = None
        reckoned = self.reckoning.at(taken)
        self._row["beams"] = len(view)
        self._is_blind = len(view) == 0
        if self._is_blind or self._is_lifted or reckoned is None or self._map is None:
            return
        self._row["seen"] = self._now
        tells_places_apart = len(view) >= self._config.least_beams
        if self._search is None:
            self._follow(view, taken, reckoned, tells_places_apart)
            self._doubt.note(taken, reckoned, view)
        elif tells_places_apart:
            newest, believed = self.reckoning.pose, self.pose
            found = self._search.see(self._now, view, reckoned, newest, believed)
            if found is not None:
                self._go_on_at(found)
        self.placed = PlacedScan(
            self._followed.pose_then(reckoned), still, plain_ranges(ranges), lidar
        )

    @property
    def latency(self) -> float:
        """How late scans are against odometry, s, as learned so far."""
        return self._followed.latency

    @property
    def is_calm(self) -> bool:
        """Whether the place is known and nothing is under way, so that the belief says it all.

        It is not calm if scans come late: kernels take each scan for one that comes in time.
        """
        if self._is_lifted or self._search is not None or self._map is None or self.latency:
            return False
        if self._confirmation.is_open:
            return False
        return bool(is_calm(self.belief, self.numbers, self._now))

    def sights(self, beams: int) -> Sights:
        """Return what was seen in the last seconds, with room for scans of so many beams."""
        self._doubt.sight.reserve(beams)
        return self._doubt.sight.arrays

    def resumed(self, now: float) -> None:
        """Go on after kernels brought the belief, calm so far, up to the time ``now``, s."""
        self._stamps.last = float(self._row["stamp"])
        self._followed.forget_heading()
        self._times.last = max(self._times.last or now, now)
        self._now = max(self._now, now)

    def reconsider(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Finish a scan by which kernels corrected the pose, after which it is not calm any more.

        The arguments are those of :meth:`see`.
        """
        still = lidar.at_once(stamp, ranges, self.path)
        self.view = view = lidar.view(still)
        self.placed = None
        self._is_blind = len(view) == 0
        if self._is_blind:
            return
        reckoned = self.reckoning.at(stamp)
        if reckoned is None:
            return
        if len(view) >= self._config.least_beams and self._tracker.is_doubtful:
            self._doubt.follow(reckoned, fits=self._fits)
            self._reconsider(stamp, view, reckoned)
        self._doubt.note(stamp, reckoned, view)
        self.placed = PlacedScan(
            self._followed.pose_then(reckoned), still, plain_ranges(ranges), lidar
        )

    def feel(self, radius: float, first: float, last: float) -> None:
        """Ignore a touch: the localizer goes by its map."""

    def go_by_lidar(self) -> None:
        """Apply the lidar's measured mount, if it is known better by now; call this between scans.

        Points that were seen stay where they are on the map: the pose of the robot's body moves.
        """
        self._followed.go_by_lidar()

    def pass_time(self, now: float) -> None:
        """Tell the time while no sensor does, so that their silence is noticed."""
        if self._has_clock:
            self._follow_clock(now, self._times)

    def use_map(self, occupancy: OccupancyMap) -> None:
        """Go on with another map in the same frame; search for the robot if scans do not fit it."""
        if self._map is not None and (
            occupancy.frame == self._map.frame
            and np.array_equal(occupancy.values, self._map.values)
        ):
            return
        self._use_field_of(occupancy)
        estimate = self.estimate
        if self._search is not None:
            self._search.use(self._followed.walls)
            self._followed.begin_at(estimate.pose, UNKNOWN_COVARIANCE)
        else:
            self.told(estimate.pose, (estimate.position_deviation, estimate.heading_deviation))

    def go_on(self, occupancy: OccupancyMap, at: tuple[Pose, tuple[float, float]] | None) -> None:
        """Go on with another map without a search, as the place on it is known.

        ``at`` is the pose on it and its deviations, m and rad; None means the same pose as before.
        If a scan hardly fits there, the robot is searched for all the same.
        """
        if at is None and self._search is not None:
            self.use_map(occupancy)
            return
        self._use_field_of(occupancy)
        if at is None:
            self._followed.begin_at(self.pose, self._tracker.covariance)
        else:
            self.told(*at)
            self._confirmation.need_less()

    def _use_field_of(self, occupancy: OccupancyMap) -> None:
        self._map = occupancy
        self._followed.use(occupancy)
        self._doubt.drop()

    def told(self, pose: Pose, deviation: tuple[float, float]) -> None:
        """Expect the robot at a reported pose, with deviations in m and rad; scans confirm it."""
        spread = np.diag([deviation[0] ** 2, deviation[0] ** 2, deviation[1] ** 2])
        self._followed.begin_at(pose, spread)
        self._search = None
        self._doubt.drop()
        self._confirmation.told(self._now, pose, deviation)

    def forget(self, reason: str) -> None:
        """Trust no pose any more; look for the robot in the whole map."""
        self._search_for(reason, None)

    @property
    def pose(self) -> Pose:
        """Where the robot is taken to be, map frame."""
        return self._tracker.pose

    @property
    def field(self) -> SurfaceField:
        """The surfaces of the map."""
        return self._followed.field

    @property
    def estimate(self) -> Estimate:
        """What is known now."""
        tracker = self._tracker
        knowledge, reason = self._knowledge()
        covariance = tracker.covariance + tracker.map_spread
        if self._search is not None or self._is_lifted:
            covariance = UNKNOWN_COVARIANCE
        agreement = 0.0 if self._is_blind else tracker.agreement
        return Estimate(tracker.pose, covariance, knowledge, agreement, reason)

    @property
    def sight_to_look_around(self) -> tuple[Pose, Floats] | None:
        """The reckoned pose and the beams' ends, if driving a little helps to find the robot."""
        search, sees_nothing = self._search, self._map is None or self._is_blind or self._is_late
        if search is None or self.view is None or self._is_lifted or sees_nothing:
            return None
        looks = self._knowledge()[0] is Knowledge.SEARCHING and search.needs_views(self._now)
        return (self.reckoned, self.view.ends) if looks else None

    def look_anew(self) -> None:
        """Give a search under way its whole time again: the robot begins to look around."""
        if self._search is not None:
            self._search.look_anew(self._now)

    @property
    def reckoned(self) -> Pose:
        """Where the robot is in a frame of its own, in which it never jumps but slowly drifts."""
        return self.reckoning.pose

    @property
    def map_to_odometry(self) -> Pose:
        """Where the frame of the wheels' odometry lies in the map."""
        return self.pose.compose(self.reckoning.odometry.inverse())

    @property
    def hypotheses(self) -> list[Pose]:
        """Where the robot may be, likeliest first: while it is searched for there may be many."""
        places = self._search.hypotheses(self.reckoning.pose) if self._search is not None else []
        return places or [self.pose]

    def _follow_clock(self, time: float, clock: ClockJumps) -> None:
        """Take the time that a clock shows.

        Stamps and the time itself are two clocks: stamps are always a little late.
        """
        was_set = clock.at(time) != 0.0
        if not self._has_clock or was_set:
            # The first time, or a clock that was set back: what began before begins now.
            self._now = self._confirmation.told_at = time
            if self._search is not None:
                self._search.clock_set(time)
            self._row["seen"] = time if self._has_clock else -math.inf
            self._stamps.last = self._times.last = None
            clock.last = time
        self._has_clock = True
        self._now = max(self._now, time)

    def _knowledge(self) -> tuple[Knowledge, str]:
        search, told_at = self._search, self._confirmation.told_at
        now = Circumstances(
            deviation=self._followed.position_deviation,
            has_map=self._map is not None,
            is_lifted=self._is_lifted,
            is_late=self._is_late,
            is_blind=self._is_blind,
            was_just_told=self._now - told_at <= self._config.scan_timeout,
            is_doubted=self._doubt.lasts,
            is_awaited=self._confirmation.awaited is not None,
            is_compared=self._confirmation.compared is not None,
            searched=None if search is None else search.so_far(self._now),
        )
        return knowledge_in(now, self._config)

    @property
    def _is_late(self) -> bool:
        return not self._now - float(self._row["seen"]) <= self._config.scan_timeout

    @property
    def _fits(self) -> bool:
        """Whether enough of the newest scans agrees with the map for them to correct the pose."""
        return bool(self._row["agree"] >= self._config.fit.doubt_agree)

    @property
    def _tracker(self) -> Tracker:
        return self._followed.tracker

    def _follow(
        self, view: ScanView, stamp: float, reckoned: Pose, tells_places_apart: bool
    ) -> None:
        """Correct the pose by a scan taken at ``reckoned``, and react if the scan does not fit."""
        followed = self._followed
        unsure = followed.position_deviation
        if self._confirmation.awaited is None and unsure > self._config.astray_deviation:
            there = followed.pose_then(reckoned)
            self._confirmation.await_at(there, (unsure, followed.heading_deviation))
        fit = followed.correct(view, stamp, reckoned, tells_places_apart=tells_places_apart)
        if fit is not None:
            self._doubt.follow(reckoned, fits=self._fits)
            self._heed(fit, stamp, view, reckoned)

    def _heed(self, fit: Fit, stamp: float, view: ScanView, reckoned: Pose) -> None:
        """Look for the robot if a scan says that it is elsewhere."""
        if self._confirmation.is_open:
            refuted = self._confirmation.refuted(self._now, fit, view, reckoned, self.field)
            if refuted is not None:
                self._search_for(refuted.why, refuted.expectation)
        elif self._tracker.is_doubtful:
            self._reconsider(stamp, view, reckoned)

    def _reconsider(self, stamp: float, view: ScanView, reckoned: Pose) -> None:
        """Forget the pose, unless scans show that it is the home that changed."""
        # If everything looks as it did a moment ago, it is the home that changed.
        is_still = self._doubt.sight.is_still(stamp, reckoned, view)
        if not is_still and self._is_found_near(view, reckoned):
            return
        expected = self._doubt.expected(self._now, stamp, view, reckoned, self.pose, self.field)
        if expected is not None:
            # The robot may still be here, if the look of the place has changed as well.
            self._search_for("the scan does not fit the map here any more", expected)

    def _is_found_near(self, view: ScanView, reckoned: Pose) -> bool:
        """Go on at a place near by that a scan fits as well as usual, if there is one."""
        since = reckoned.inverse().compose(self.reckoning.pose)
        here = self.pose.compose(since.inverse())
        usual = float(self._row["usual_agree"]), float(self._row["usual_through"])
        found = better_near(view, self.field, here, usual, self._config)
        if found is None:
            return False
        pose, fit = found
        self._go_on_at(FoundPlace(pose.compose(since), fit))
        refuted = self._confirmation.compare_near(self._now, pose, view, reckoned, self.field)
        if refuted is not None:
            self._search_for(refuted.why, refuted.expectation)
        return True

    def _search_for(self, why: str, expectation: Expectation | None) -> None:
        """Trust no pose any more, and begin to look for the robot."""
        self._confirmation.drop()
        self._doubt.drop()
        self._search = GlobalSearch(
            why, self._now, expectation, self._followed.walls, self._config, self._body_radius
        )

    def _go_on_at(self, found: FoundPlace) -> None:
        """Follow the robot from where it was found."""
        self._search = None
        self._doubt.end()
        self._followed.begin_at(found.pose, _FOUND_SPREAD)
        self._tracker.trust(found.fit)
