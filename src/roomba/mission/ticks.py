"""The ticks of a mission: what is noticed at each, where its time goes, and what is wanted.

:mod:`.phases.cleaning`, :mod:`.phases.exploring`, :mod:`.phases.returning` and
:mod:`.phases.at_station` do the work of a phase, and :mod:`.phases.monitor` notices what comes up
in any phase. Ticks whose work is known in advance are those of :mod:`.steady`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.clock import LONGEST_TICK
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import STANDSTILL, Twist
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases import exploring, returning
from roomba.mission.phases.at_station import AtStation
from roomba.mission.phases.carpet import CarpetSense
from roomba.mission.phases.cleaning import CleanPhase
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.monitor import Monitor
from roomba.mission.phases.step import PhaseStep
from roomba.mission.steady import Steady, SteadyTicks
from roomba.mission.transitions import Transitions
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.rooms.felt_carpets import CarpetVotes
from roomba.vocabulary import Phase

_SAYS_CONTACT: Final = (Phase.DOCKING, Phase.UNDOCKING, Phase.CHARGING, Phase.EMPTYING)
"""Phases that say themselves when the contact is good, and when it is lost."""


@dataclass(frozen=True, slots=True)
class MissionStep:
    """What is wanted at a tick.

    ``looks_around``: the place must be found before it can go on. ``wants_whole_map``: all that can
    be seen of a map in the making was seen; it goes on when it is told the whole one. ``empties``:
    its station is to empty its bin.
    """

    twist: Twist = STANDSTILL
    looks_around: bool = False
    wants_whole_map: bool = False
    empties: bool = False


class MissionTicks:
    """Lets the parts of a mission go on, tick by tick.

    ``last`` is what was sensed at the last tick, ``max_speed`` the robot's top speed, m/s;
    ``carpet`` tells whether the brush is on carpet, and ``carpets`` where it felt some, over all
    runs.
    """

    def __init__(
        self,
        robot: RobotConfig,
        config: MissionConfig,
        *,
        transitions: Transitions,
        job: Job,
        drives: Drives,
        at_station: AtStation,
        monitor: Monitor,
        retries: RetryPolicy,
        senses: Senses,
        max_speed: float,
    ) -> None:
        """Take the mission's parts; nothing was done yet."""
        self._robot, self._config = robot, config
        self._transitions, self._job, self._drives = transitions, job, drives
        self._at_station, self._monitor, self._retries = at_station, monitor, retries
        self._clean_phase = CleanPhase(job, drives, retries, config.exploring)
        self._steady = SteadyTicks(job, drives, at_station, monitor, retries)
        self.carpet = CarpetSense(robot.brush)
        self.carpets = CarpetVotes(drives.context.occupancy)
        self.last, self.max_speed = senses, max_speed

    def tick(self, senses: Senses) -> MissionStep:
        """Return what is wanted now."""
        self.carpet.note(senses.brush_current)
        self._job.ledger.longest_way_home = self._drives.context.longest_way
        drives = self._is_under_way and not self._stands(senses)
        self._job.account(senses, self.last, drives=drives, sweeps=self.sweeps)
        self._note_carpet(senses, np.array([self.last_place]))
        here, (x, y) = senses.pose, self.last_place
        self._count_time(senses, np.array([np.hypot(here.x - x, here.y - y)]))
        self._notice(senses)
        step = self._act(senses)
        self.last = senses
        return step

    def steady(self, senses: Senses) -> Steady | None:
        """Return the steady ticks that come next; None if a usual tick must decide."""
        if not 0.0 <= senses.now - self.last.now <= LONGEST_TICK:
            # A clock that was set changes when all this began.
            return None
        if self._drives.context.zones.has_carpets:
            # Where a drawn carpet ends is looked at tick by tick.
            return None
        limit = self.speed_limit(senses)
        return self._steady.after(senses, self._phase, limit, sweeps=self.sweeps)

    def caught_up(self, senses: Senses, places: NDArray[np.float64], way: float) -> None:
        """Go on after steady ticks, the last of which began with these senses.

        They began at ``places``, float64 [n, 2], m; ``way`` m were driven from the tick before the
        first of them to the last.
        """
        self._drives.caught_up(senses, places)
        if self.sweeps:
            self._job.bin.passed(places)
        self._note_carpet(senses, places)
        self._job.ledger.note(senses, way, drives=self._is_under_way)
        ways = np.diff(np.vstack((self.last_place, places)), axis=0)
        self._count_time(senses, np.hypot(ways[:, 0], ways[:, 1]))
        self.last = senses

    def speed_limit(self, senses: Senses) -> float:
        """Return how fast it goes now, m/s."""
        is_exploring = self._phase is Phase.EXPLORING
        config = self._config
        speed = config.exploring.speed if is_exploring else config.driving.speed
        speed = min(speed, self.max_speed)
        if senses.knowledge is Knowledge.ROUGH:
            return min(speed, self._robot.walk.careful_speed)
        return speed

    @property
    def sweeps(self) -> bool:
        """Whether what it drives over counts as cleaned."""
        return self._job.cleaning is not None and self._is_under_way and not self._job.bin.is_full

    @property
    def last_place(self) -> tuple[float, float]:
        """Where it was at the last tick, m."""
        return self.last.pose.x, self.last.pose.y

    @property
    def _phase(self) -> Phase:
        return self._transitions.state.phase

    @property
    def _is_under_way(self) -> bool:
        return self._transitions.state.drives

    def _note_carpet(self, senses: Senses, places: NDArray[np.float64]) -> None:
        """Note what floor the brush feels at ``places``, float64 [n, 2], m.

        A brush whose current is not told feels nothing.
        """
        if self.sweeps and senses.brush_current > 0.0:
            self.carpets.note(places, is_on=self.carpet.is_on)

    def _count_time(self, senses: Senses, ways: NDArray[np.float64]) -> None:
        """Count what the time since the last tick went into.

        ``ways``, float64 [ticks], m, were driven from each tick to the next.

        When the clock was set, nothing is counted.
        """
        each = (senses.now - self.last.now) / len(ways)
        if not 0.0 <= each <= LONGEST_TICK:
            return
        cleaning = self._job.cleaning
        self._job.times.note(
            self._phase,
            ways,
            each,
            self.speed_limit(senses),
            is_again=cleaning is not None and cleaning.is_again,
            stands=self._is_under_way and self._stands(senses),
        )

    def _stands(self, senses: Senses) -> bool:
        """Whether it stands amid its way: it waits, or does not know its place."""
        waits = self._drives.driver is None and self._retries.is_waiting(senses.now)
        return waits or self._monitor.is_astray

    def _notice(self, senses: Senses) -> None:
        """Find out what happened, and let the machine know."""
        if self._monitor.note_contact(senses) and self._phase not in _SAYS_CONTACT:
            event = Event.CONTACT if senses.battery.is_docked else Event.CONTACT_LOST
            self._transitions.go(event, senses)
        failure = self._monitor.failure(self._transitions.state, senses, self.last_place)
        if failure is not None:
            self._transitions.fail(failure.outcome, failure.reason, senses)

    def _act(self, senses: Senses) -> MissionStep:
        if self._monitor.is_astray and self._phase is not Phase.DOCKING:
            return MissionStep(STANDSTILL, looks_around=self._is_under_way)
        step = self._step(senses)
        if step.event is Event.CONTACT:
            self._monitor.was_docked = True
        if step.event is not None:
            self._transitions.go(step.event, senses)
        if step.reason is not None:
            self._transitions.reason = step.reason
        if step.failure is not None:
            self._transitions.fail(step.failure.outcome, step.failure.reason, senses)
            if step.failure.awaits_beams:
                self._at_station.await_beams(senses)
        return MissionStep(step.twist, wants_whole_map=step.wants_whole_map, empties=step.empties)

    def _step(self, senses: Senses) -> PhaseStep:
        """Let the present phase say what it wants."""
        job, drives, limit = self._job, self._drives, self.speed_limit(senses)
        context = drives.context
        match self._phase:
            case Phase.UNDOCKING:
                stand = self._config.exploring.stand_first if context.is_growing else 0.0
                is_empty = job.ledger.is_empty(senses)
                return self._at_station.undock(senses, context.station, stand, is_empty=is_empty)
            case Phase.CLEANING:
                return self._clean_phase.tick(senses, limit)
            case Phase.EXPLORING:
                most_stuck = self._config.exploring.most_stuck
                return exploring.explore(job, drives, senses, limit, most_stuck)
            case Phase.RETURNING:
                return returning.go_home(drives, self._retries, senses, limit)
            case Phase.DOCKING:
                return self._at_station.dock(senses, context.station, context.staging)
            case Phase.CHARGING:
                return self._at_station.charge(senses, job, context.tool_width, context.station)
            case Phase.EMPTYING:
                return self._at_station.empty(senses, job, context.station)
            case Phase.BIN_FULL:
                return PhaseStep(event=None if job.bin.is_full else Event.EMPTIED)
            case Phase.ERROR:
                return self._at_station.look_for_beams(senses)
        return PhaseStep()
