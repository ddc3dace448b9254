"""Cleaning, path by path; while the map is being made, the robot explores as well."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

from roomba.clock import RobotTime
from roomba.configuration.mission import ExploringConfig
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.path_driver import DriveState
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.exploring.turn_to_see import TurnToSee
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases import exploring, returning
from roomba.mission.phases.charges import when_low
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import Failure, PhaseStep
from roomba.planning.path.planner import NoPathError
from roomba.vocabulary import NO_REASON, Reason

_WAITS: Final = Reason("all is seen; it waits for the map to be finished")
_NO_WHOLE_MAP: Final = (
    "the map is not finished: put the robot on its station once, so that the map knows where that "
    "is, or call map/finish; then resume"
)


class CleanPhase:
    """Drives over the floor that is left of the job's clean."""

    def __init__(
        self, job: Job, drives: Drives, retries: RetryPolicy, config: ExploringConfig
    ) -> None:
        """Begin with no path."""
        self._job, self._drives, self._retries, self._config = job, drives, retries, config
        self._begin(None)

    def _begin(self, cleaning: Cleaning | None) -> None:
        """Begin with another clean, before its first path."""
        self._cleaning = cleaning
        self._turn = TurnToSee(self._config)
        self._seen_all_of: PlanningContext | None = None
        self._waited: RobotTime | None = None

    def tick(self, senses: Senses, limit: float) -> PhaseStep:
        """Return what is wanted now; ``limit`` is the speed wanted, m/s."""
        cleaning, drives = self._job.cleaning, self._drives
        assert cleaning is not None
        if cleaning is not self._cleaning:
            self._begin(cleaning)
        if (charging := when_low(self._job, drives, senses)) is not None:
            return charging
        if self._job.bin.is_full:
            return PhaseStep(event=Event.BIN_FULL)
        if self._turn.is_under_way:
            return PhaseStep(self._turn.tick(senses))
        waiting = returning.wait_on(drives, self._retries, senses, limit)
        if waiting is not None:
            return waiting
        if drives.driver is not None:
            self._clean_dirty_at_hand(cleaning, senses)
            return self._drive_on(cleaning, senses, limit)
        ended = None
        if not drives.begin_to_leave_zone(senses):
            ended = self._begin_path(cleaning, senses)
        return ended or replace(self._drive_on(cleaning, senses, limit), reason=NO_REASON)

    def _begin_path(self, cleaning: Cleaning, senses: Senses) -> PhaseStep | None:
        """Begin the next path, or return what is to be done where there is none."""
        drives, retries = self._drives, self._retries
        if drives.context is self._seen_all_of and cleaning.explores:
            return self._wait_for_whole_map(senses)
        points = None
        if retries.gets_out:
            # The way out leads by the middle of gaps: along their sides, as it cleans, it may be
            # shut in.
            retries.gets_out = False
            points = drives.way_out(senses)
        if points is None and self._begin_look(senses, self._config.look_first):
            return None
        try:
            if points is None:
                points = cleaning.next_path(senses.pose, drives.obstacles.standing(senses.now))
        except NoPathError:
            points = drives.way_out(senses)
            if points is None and self._turns_to_see(senses):
                return PhaseStep()
            if points is None:
                return returning.wait("no way leads out of where it is", drives, retries, senses)
        if points is not None:
            drives.begin(points, senses, cleaning.plans_anew)
            return None
        if cleaning.explores:
            return self._look_or_wait(senses)
        if not cleaning.wants_another_look(drives.obstacles.edges()):
            return PhaseStep(event=Event.FINISHED)
        drives.obstacles.forget()
        return PhaseStep()

    def _begin_look(self, senses: Senses, farthest: float) -> bool:
        """Begin to drive to where more of the home can be seen; tell whether there is such a place.

        It is at most ``farthest`` m of way off.
        """
        exploration, drives = self._job.exploration, self._drives
        if exploration is None:
            return False
        obstacles = drives.obstacles.standing(senses.now)
        points = exploration.next_path(senses.pose, drives.context, obstacles, farthest)
        if points is not None:
            drives.begin(points, senses)
        return points is not None

    def _look_or_wait(self, senses: Senses) -> PhaseStep | None:
        """Explore further when all that is known is clean; ask for the whole map at the end."""
        exploration, drives = self._job.exploration, self._drives
        assert exploration is not None
        given_up = exploration.times_given_up
        if self._begin_look(senses, math.inf):
            return None
        # Some frontiers were given up just now, and others may not be tried yet.
        if exploration.times_given_up > given_up or exploring.forget_obstacles_once(
            exploration, drives
        ):
            return PhaseStep()
        if not drives.may_go_home(senses):
            # A robot that is shut in has not seen all.
            if self._turns_to_see(senses):
                return PhaseStep()
            reason = "no way leads out of where it is"
            return returning.try_home_again(reason, drives, self._retries, senses)
        self._seen_all_of, self._waited = drives.context, RobotTime(senses.now)
        return PhaseStep(reason=_WAITS, wants_whole_map=True)

    def _turns_to_see(self, senses: Senses) -> bool:
        """Begin to turn where a map in the making shows no way; tell whether it does."""
        return self._drives.context.is_growing and self._turn.begin(senses)

    def _wait_for_whole_map(self, senses: Senses) -> PhaseStep:
        assert self._waited is not None
        self._waited.tick(senses.now)
        if self._waited.elapsed < self._config.map_wait:
            return PhaseStep(wants_whole_map=True)
        self._seen_all_of = None
        return PhaseStep(failure=Failure(CleanOutcome.FAULT, _NO_WHOLE_MAP))

    def _clean_dirty_at_hand(self, cleaning: Cleaning, senses: Senses) -> None:
        """Let the path lead over dirty floor close by once more."""
        drives = self._drives
        assert drives.driver is not None
        if not (drives.is_round and drives.driver.is_tracking and cleaning.watches_dirt):
            return
        if not cleaning.dirty.may_be_at_hand((senses.pose.x, senses.pose.y), senses.now):
            return
        obstacles, rest = drives.obstacles.standing(senses.now), drives.driver.points_left
        points = cleaning.dirty_at_hand(senses.pose, rest, obstacles, senses.now)
        if points is not None:
            drives.begin(points, senses, cleaning.plans_anew)

    def _drive_on(self, cleaning: Cleaning, senses: Senses, limit: float) -> PhaseStep:
        drives, exploration = self._drives, self._job.exploration
        assert drives.driver is not None
        if exploration is not None and exploration.is_under_way:
            return exploring.look_on(exploration, drives, senses, limit, self._config.most_stuck)
        step = drives.driver.tick(senses, limit)
        if step.state is DriveState.STUCK:
            return PhaseStep(step.twist, failure=Failure(CleanOutcome.STUCK, step.reason))
        if step.state.is_over:
            if step.state is DriveState.CUT_OFF:
                cleaning.cut_off()
            drives.driver = None
        return PhaseStep(step.twist)
