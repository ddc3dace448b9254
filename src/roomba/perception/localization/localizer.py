"""Localization on a known map: the stages put together.

Dead reckoning says how it moved, a tracker corrects that by each scan, and when scans do not fit
any more, or it was carried, a relocation looks for it in the whole map. Plain values in and
out; times in s of the robot's clock.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.clock import ClockJumps
from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.sensors import GyroConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.calibration.kernels import apply_lidar
from roomba.perception.calibration.lidar import lidar_correction
from roomba.perception.localization.belief.belief import numbers_of, unknown_belief
from roomba.perception.localization.belief.correct_kernels import calibrate, deviation, is_calm
from roomba.perception.localization.belief.reckon_kernels import SET_BACK
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.localization.doubt import Doubt
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.perception.localization.expecting import searched_for, where_told
from roomba.perception.localization.recent_sight_kernels import Sights
from roomba.perception.localization.relocation import Expectation, Hypothesis, Relocation, Verdict
from roomba.perception.localization.search.near_search import best_near, matched
from roomba.perception.localization.search.particle_search import ParticleSearch
from roomba.perception.localization.tracker import Tracker
from roomba.perception.matching.pose_kernels import pose_then
from roomba.perception.matching.scan_view import Fit, LidarModel, PlacedScan, ScanView
from roomba.perception.matching.surface_field import SurfaceField

_ANYWHERE: Final = np.diag([100.0**2, 100.0**2, math.pi**2])
"""m2, rad2; of an unknown pose: so large that a reader of the covariance alone does not use it."""
_FOUND_SPREAD: Final = np.diag([0.05**2, 0.05**2, 0.03**2])
"""m2, rad2; of a place that was found, before scans narrow it down."""
_LEAST_OFFSET: Final = 0.15
"""Cells of the map; walls that are off by less stay where they are."""
_LEAST_OFFSET_BEAMS: Final = 100.0
"""Beams that must say so, each scan as far as it shows something new."""
_MOST_OFFSET: Final = 2.0
"""Cells that walls are off at most: some programs draw them thicker than they are."""
_HELP: Final = (
    "carry it to its station, or tell where it is (in RViz: 2D Pose Estimate), "
    "or let it look around (global_localization)"
)


class Localizer:
    """Keeps the estimate; tell it what the sensors say in the order of time.

    ``view`` is the newest scan; ``placed`` is that scan where it was taken on the map, None if that
    is not known. While it :attr:`is_calm`, kernels may do its work on ``belief``,
    ``path`` and ``numbers`` (see :mod:`roomba.perception.localization.belief.correct_kernels`), and
    on ``sights`` (see :mod:`roomba.perception.localization.recent_sight_kernels`), until it has
    :meth:`resumed`.
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

        Without a map it goes by wheels and gyro, until :meth:`use_map`. A scan that it is shown
        stands for so many of the lidar's, its ``stride``.
        """
        self._map = occupancy
        self.field = SurfaceField.of(occupancy) if occupancy else SurfaceField.unknown()
        self._walls_moved = 0.0
        self.view: ScanView | None = None
        self.placed: PlacedScan | None = None
        self._config, self._body_radius = config, body_radius
        self.belief = unknown_belief()
        self._row, self.numbers = self.belief[0], numbers_of(config, gyro, stride)
        self._doubt = Doubt(config, body_radius)
        self._reckoning = DeadReckoning(config, gyro, self.belief)
        self.path = self._reckoning.path
        self._is_lifted = self._is_blind = False
        self._now = -math.inf
        self._stamps, self._times = (ClockJumps(tolerance=SET_BACK) for _ in range(2))
        self._searching_since = self._tried = self._told_since = -math.inf
        self._has_clock = False
        self._told: Expectation | None = None
        self._compared: Expectation | None = None
        self._relocation: Relocation | None = None
        self._particles: ParticleSearch | None = None
        self._searched_from: Pose | None = None
        self._forgotten = ""
        self._expectation: Expectation | None = None
        self._verdict = Verdict.SEARCHING
        self.told(start, deviation)

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, if there is one.

        Raises ValueError for numbers that are not finite.
        """
        if not (odometry.is_finite and math.isfinite(turning or 0.0)):
            raise ValueError(f"expected finite numbers, got {odometry} and {turning} rad/s")
        self._follow_clock(stamp, self._stamps)
        self._reckoning.move(stamp, odometry, turning)

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air: the robot is being carried."""
        if self._is_lifted and not is_lifted:
            told = self._told
            self.forget("it was lifted and set down again")
            self._expectation = told
        self._is_lifted = is_lifted

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Take a scan, float32 [beams], m; raises ValueError for another number of beams."""
        still = lidar.at_once(stamp, ranges, self.path)
        self.view = view = lidar.view(still)
        self.placed = None
        reckoned = self._reckoning.at(stamp)
        self._row["beams"] = len(view)
        self._is_blind = len(view) == 0
        if self._is_blind or self._is_lifted or reckoned is None or self._map is None:
            return
        self._row["seen"] = stamp
        tells_places_apart = len(view) >= self._config.least_beams
        if not self._forgotten:
            self._follow(view, stamp, reckoned, tells_places_apart)
            self._doubt.note(stamp, reckoned, view)
        elif tells_places_apart:
            if self._relocation is None:
                self._relocation = self._begin_search(view, reckoned)
            self._search_on(self._relocation, view, reckoned)
        self.placed = PlacedScan(self._pose_then(reckoned), still, lidar)

    @property
    def is_calm(self) -> bool:
        """Whether the place is known and nothing waits to be done: the belief says it all."""
        if self._is_lifted or self._forgotten or self._map is None:
            return False
        if self._told is not None or self._compared is not None:
            return False
        return bool(is_calm(self.belief, self.numbers, self._now))

    def sights(self, beams: int) -> Sights:
        """Return what was seen in the last seconds, with room for scans of so many beams."""
        self._doubt.sight.reserve(beams)
        return self._doubt.sight.arrays

    def resumed(self, now: float) -> None:
        """Go on after kernels that brought the belief up to ``now``, s, from when it was calm."""
        self._stamps.last = float(self._row["stamp"])
        self._times.last = max(self._times.last or now, now)
        self._now = max(self._now, now)

    def reconsider(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Finish what kernels left of a scan that they corrected the pose by: it is not calm now.

        As of :meth:`see`.
        """
        still = lidar.at_once(stamp, ranges, self.path)
        self.view = view = lidar.view(still)
        self.placed = None
        self._is_blind = len(view) == 0
        if self._is_blind:
            return
        reckoned = self._reckoning.at(stamp)
        if reckoned is None:
            return
        if len(view) >= self._config.least_beams and self._tracker.is_doubtful:
            self._reconsider(stamp, view, reckoned)
        self._doubt.note(stamp, reckoned, view)
        self.placed = PlacedScan(self._pose_then(reckoned), still, lidar)

    def go_by_lidar(self) -> None:
        """Take the lidar for where it is, if that is known better by now; call it between scans.

        What was seen stays where it is on the map: it is the robot's body that is elsewhere.
        """
        if not self._row["calibration"]["is_lidar_due"]:
            return
        before = lidar_correction(self.belief)
        apply_lidar(self._row["calibration"])
        by = before.compose(lidar_correction(self.belief).inverse())
        self._tracker.pose = self._tracker.pose.compose(by)

    def pass_time(self, now: float) -> None:
        """Tell the time when no sensor does: silence counts, too."""
        if self._has_clock:
            self._follow_clock(now, self._times)

    def use_map(self, occupancy: OccupancyMap) -> None:
        """Go on with another map of the same frame; a pose that it does not fit is searched for."""
        if self._map is not None and (
            occupancy.frame == self._map.frame
            and np.array_equal(occupancy.values, self._map.values)
        ):
            return
        self._use_field_of(occupancy)
        estimate = self.estimate
        if self._forgotten:
            # A search goes on in the new map, with the time that is left of it.
            self._relocation = self._particles = None
            self._tracker = self._tracker_at(estimate.pose, _ANYWHERE.copy())
        else:
            self.told(estimate.pose, (estimate.position_deviation, estimate.heading_deviation))

    def go_on(self, occupancy: OccupancyMap, at: tuple[Pose, tuple[float, float]] | None) -> None:
        """Go on with another map without a search, as the place on it is known.

        ``at`` is the pose there, m and rad unsure; None: the same as before. Should a scan hardly
        fit there it is searched for all the same.
        """
        if at is None and self._forgotten:
            self.use_map(occupancy)
            return
        self._use_field_of(occupancy)
        if at is None:
            tracker = self._tracker
            self._tracker = self._tracker_at(tracker.pose, tracker.covariance)
        else:
            self.told(*at)
            self._needed = self._config.fit.fair_agree, self._config.fit.fair_through

    def _use_field_of(self, occupancy: OccupancyMap) -> None:
        self._map, self.field = occupancy, SurfaceField.of(occupancy)
        self._walls_moved, self._row["wall_offset"] = 0.0, 0.0
        self._doubt.drop()

    def told(self, pose: Pose, deviation: tuple[float, float]) -> None:
        """Expect the robot at a reported pose, with deviations in m and rad; scans confirm it."""
        spread = np.diag([deviation[0] ** 2, deviation[0] ** 2, deviation[1] ** 2])
        self._tracker = self._tracker_at(pose, spread)
        self._relocation = self._compared = self._particles = self._searched_from = None
        self._doubt.drop()
        self._forgotten = ""
        self._told, self._told_since = where_told(pose, deviation, self._config), self._now
        self._needed = self._config.fit.good_agree, self._config.fit.good_through

    def forget(self, reason: str) -> None:
        """Trust no pose any more; look for the robot in the whole map."""
        self._told = self._compared = self._relocation = None
        self._particles = self._searched_from = None
        self._doubt.drop()
        self._forgotten, self._expectation = reason, None
        self._verdict = Verdict.SEARCHING
        self._searching_since = self._now

    @property
    def estimate(self) -> Estimate:
        """What is known now."""
        tracker = self._tracker
        knowledge, reason = self._knowledge()
        covariance = tracker.covariance + tracker.map_spread
        if self._forgotten or self._is_lifted:
            covariance = _ANYWHERE
        agreement = 0.0 if self._is_blind else tracker.agreement
        return Estimate(tracker.pose, covariance, knowledge, agreement, reason)

    @property
    def needs_to_look_around(self) -> bool:
        """Whether more must be seen to find the robot's place, so that driving a little helps."""
        knowledge, _ = self._knowledge()
        sees_nothing = self._map is None or self._is_blind or self._is_late
        if knowledge is not Knowledge.SEARCHING or self._is_lifted or sees_nothing:
            return False
        if self._relocation is None:
            return self._now - self._searching_since > self._config.searching.wait_before_moving
        return self._relocation.verdict is not Verdict.SEARCHING

    @property
    def reckoned(self) -> Pose:
        """Where the robot is in a frame of its own, in which it never jumps but slowly drifts."""
        return self._reckoning.pose

    @property
    def map_to_odometry(self) -> Pose:
        """Where the frame of the wheels' odometry lies in the map."""
        return self._tracker.pose.compose(self._reckoning.odometry.inverse())

    @property
    def hypotheses(self) -> list[Pose]:
        """Where the robot may be, likeliest first: while it is searched for there may be many."""
        if self._relocation is None or not self._relocation.hypotheses:
            return [self._tracker.pose]
        reckoned = self._reckoning.pose
        return [each.frame.compose(reckoned) for each in self._relocation.hypotheses]

    def _follow_clock(self, time: float, clock: ClockJumps) -> None:
        """Take the time that a clock shows.

        Stamps and the time itself are two clocks: stamps are always a little late.
        """
        was_set = clock.at(time) != 0.0
        if not self._has_clock or was_set:
            # The first time, or a clock that was set back: what began before begins now.
            self._searching_since = self._tried = self._told_since = self._now = time
            self._row["seen"] = time if self._has_clock else -math.inf
            self._stamps.last = self._times.last = None
            clock.last = time
        self._has_clock = True
        self._now = max(self._now, time)

    def _knowledge(self) -> tuple[Knowledge, str]:
        if self._is_lifted:
            return (
                Knowledge.SEARCHING,
                "the wheels hang in the air: set the robot down on the floor",
            )
        if self._forgotten:
            return self._searching(self._forgotten)
        unsure = deviation(self._row["covariance"])
        was_just_told = self._now - self._told_since <= self._config.scan_timeout
        if unsure > self._config.lost_deviation and not was_just_told:
            return Knowledge.LOST, f"{self._why_unsure()}, for too long; {_HELP}"
        is_sure = unsure <= self._config.known_deviation and self._compared is None
        if self._is_late or self._is_blind or not is_sure:
            return Knowledge.ROUGH, f"{self._why_unsure()}; going by wheels and gyro"
        return Knowledge.KNOWN, ""

    @property
    def _is_late(self) -> bool:
        return not self._now - float(self._row["seen"]) <= self._config.scan_timeout

    def _searching(self, why: str) -> tuple[Knowledge, str]:
        if self._now - self._searching_since > self._config.search_timeout:
            unseen = self._is_late or self._is_blind or self._verdict is Verdict.SEARCHING
            what = self._why_unsure() if unseen else self._verdict.value
            return Knowledge.LOST, f"{why}, and {what}; {_HELP}"
        sees_nothing = self._is_blind or self._is_late
        return Knowledge.SEARCHING, f"{why}; {self._why_unsure()}" if sees_nothing else why

    def _why_unsure(self) -> str:
        if self._map is None:
            return "there is no map yet"
        if self._is_blind:
            return "the lidar sees next to nothing: it is blocked, or all is out of its reach"
        if self._is_late:
            return "the lidar sends no scans"
        if self._told is not None:
            return "the pose was told, and no scan has confirmed it yet"
        if self._compared is not None:
            return "the pose was told, fits in part, and is being compared with all others"
        return "what is in sight does not tell the place: a bare corridor, or next to nothing"

    def _follow(
        self, view: ScanView, stamp: float, reckoned: Pose, tells_places_apart: bool
    ) -> None:
        """Correct the pose by a scan that was taken at ``reckoned``, perhaps a little ago."""
        tracker = self._tracker
        since = None
        if not self._reckoning.is_newest(stamp):
            since = reckoned.inverse().compose(self._reckoning.pose)
            tracker.pose = tracker.pose.compose(since.inverse())
        unsure = deviation(self._row["covariance"])
        if self._told is None and unsure > self._config.astray_deviation:
            spread = (unsure, math.sqrt(tracker.covariance[2, 2]))
            self._told = where_told(tracker.pose, spread, self._config)
            self._needed = self._config.fit.good_agree, self._config.fit.good_through
        tracker.see(view)
        fit = tracker.judge(view) if tells_places_apart else None
        self._learn_walls()
        if since is not None:
            tracker.pose = tracker.pose.compose(since)
        calibrate(self.belief)
        if fit is None:
            return
        if self._told is not None:
            self._check_told(self._told, fit)
        elif self._compared is not None:
            self._compare_told(self._compared, view, reckoned)
        elif tracker.is_doubtful:
            self._reconsider(stamp, view, reckoned)

    def _pose_then(self, reckoned: Pose) -> Pose:
        """Return where the robot was on the map when dead reckoning had it at ``reckoned``."""
        pose, then = self._tracker.pose, np.array([reckoned.x, reckoned.y, reckoned.theta])
        here = np.array([pose.x, pose.y, pose.theta])
        return Pose(*pose_then(here, self._row["reckoned"], then))

    def _reconsider(self, stamp: float, view: ScanView, reckoned: Pose) -> None:
        """Forget the pose, unless what is in sight says that the home changed, and not the pose."""
        # Where all is as it was seen a moment ago, it is the home that changed.
        is_still = self._doubt.sight.is_still(stamp, reckoned, view)
        if not is_still and self._is_found_near(view, reckoned):
            return
        pose = self._tracker.pose
        expected = self._doubt.expected(self._now, stamp, view, reckoned, pose, self.field)
        if expected is not None:
            self.forget("the scan does not fit the map here any more")
            # What the place looks like may have changed as well.
            self._expectation = expected

    def _learn_walls(self) -> None:
        """Move the map's surfaces to where in its cells the walls are, as scans show them."""
        off, beams = self._row["wall_offset"].tolist()
        cell = self.field.frame.resolution
        if beams < _LEAST_OFFSET_BEAMS or abs(off) < _LEAST_OFFSET * cell * beams:
            return
        most = _MOST_OFFSET * cell
        self._move_walls(max(-0.5 * cell, min(most, self._walls_moved - off / beams)))

    def _move_walls(self, moved: float) -> None:
        """Move the map's surfaces into what is solid: so far, m, from where the map has them."""
        self.field.raise_by(moved - self._walls_moved)
        self._walls_moved = moved
        self._row["wall_offset"][0] = 0.0

    def _find_walls(self, view: ScanView, pose: Pose) -> Pose:
        """Move the map's surfaces to where a scan fits best from about a pose; return it there."""
        cell, tried = self.field.frame.resolution, []
        for moved in (0.5 * cell * number for number in range(int(2 * _MOST_OFFSET) + 1)):
            self._move_walls(moved)
            tried.append((*matched(view, self.field, pose, self._config.beam_deviation), moved))
        there, _, moved = max(tried, key=lambda each: each[1].evidence)
        self._move_walls(moved)
        return there

    def _is_found_near(self, view: ScanView, reckoned: Pose) -> bool:
        """Go on at a place near by that a scan fits as well as usual, if there is one."""
        since = reckoned.inverse().compose(self._reckoning.pose)
        here = self._tracker.pose.compose(since.inverse())
        found = best_near(view, self.field, here, self._config)
        if found is None:
            return False
        (pose, fit), worse = found, self._config.fit
        is_usual = (
            fit.agree >= float(self._row["usual_agree"]) - worse.near_worse
            and fit.through <= float(self._row["usual_through"]) + worse.near_through
        )
        lead = fit.evidence - view.fit(self.field, np.array([here.x, here.y, here.theta])).evidence
        if not is_usual or lead < self._config.needed_evidence:
            return False
        self._tracker = self._tracker_at(pose.compose(since), _FOUND_SPREAD.copy())
        self._tracker.trust(fit)
        return True

    def _check_told(self, told: Expectation, fit: Fit) -> None:
        """Take what was told if the scan fits well there; else compare it with the map.

        Where it fits in part, as on a map of another day, it goes by what was told meanwhile.
        """
        self._told = None
        least, most = self._needed
        if fit.agree >= least and fit.through <= most:
            return
        if fit.agree >= self._config.fit.told_agree:
            self._compared = told
        else:
            self._forget_told(told)

    def _compare_told(self, told: Expectation, view: ScanView, reckoned: Pose) -> None:
        is_elsewhere = self._doubt.is_elsewhere(self._now, view, reckoned, told, self.field)
        if is_elsewhere is not None:
            self._compared = None
        if is_elsewhere:
            self._forget_told(told)

    def _forget_told(self, told: Expectation) -> None:
        self.forget("what the lidar sees does not fit well where it was told to be")
        self._expectation = told

    def _begin_search(self, view: ScanView, reckoned: Pose) -> Relocation:
        """Begin to look for the robot in the whole map."""
        since = reckoned.inverse().compose(self._reckoning.pose)
        here = self._tracker.pose.compose(since.inverse())
        searched = self._now - self._searching_since
        expectation = self._expectation and searched_for(
            self._expectation, here, searched, self._config
        )
        return Relocation(self.field, self._config, self._body_radius, view, reckoned, expectation)

    def _tracker_at(self, pose: Pose, covariance: NDArray[np.float64]) -> Tracker:
        return Tracker(self.field, self._config, pose, covariance, self.belief, self.numbers)

    def _search_on(self, relocation: Relocation, view: ScanView, reckoned: Pose) -> None:
        if self._is_found_on_the_way(view, reckoned):
            return
        was_searching = relocation.verdict is Verdict.SEARCHING
        relocation.advance()
        relocation.see(view, reckoned)
        if relocation.verdict is Verdict.SEARCHING:
            return
        if was_searching:
            self._tried = self._now
        self._verdict = relocation.verdict
        if relocation.verdict is Verdict.FOUND and self._is_believed(relocation.hypotheses[0]):
            place = relocation.hypotheses[0]
            self._found(place.frame.compose(self._reckoning.pose), place.fit)
            return
        is_time = self._now - self._tried > self._config.searching.again_after
        if relocation.verdict is not Verdict.AMBIGUOUS and is_time:
            self._relocation = None

    def _is_believed(self, place: Hypothesis) -> bool:
        """Whether the likeliest place is taken; where many look alike it must convince."""
        return self._particles is None or place.is_expected or place.is_convincing(self._config.fit)

    def _is_found_on_the_way(self, view: ScanView, reckoned: Pose) -> bool:
        """Follow all places that may be, once it drove without finding one; go on where it is."""
        start = self._searched_from = self._searched_from or reckoned
        if self._particles is None:
            if start.distance_to(reckoned.x, reckoned.y) < self._config.searching.follow_after:
                return False
            self._particles = ParticleSearch(self.field, self._body_radius)
        self._particles.see(view, reckoned)
        pose = self._particles.found
        if pose is None:
            return False
        since = self._particles.reckoned.inverse().compose(reckoned)
        there = self._find_walls(view, pose.compose(since))
        fit = view.fit(self.field, np.array([there.x, there.y, there.theta]))
        since = reckoned.inverse().compose(self._reckoning.pose)
        self._found(there.compose(since), fit)
        return True

    def _found(self, pose: Pose, fit: Fit) -> None:
        self._tracker = self._tracker_at(pose, _FOUND_SPREAD.copy())
        self._tracker.trust(fit)
        self._relocation = self._particles = self._searched_from = None
        self._forgotten = ""
