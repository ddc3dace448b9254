"""The mission: the robot's behaviour from one command to the next, put together from its parts.

No clock and no I/O: it gets commands and, 20 times a second, the senses; it returns the wanted
twist. :mod:`.phases.machine` is the state machine, :mod:`.phases.phases` and
:mod:`.phases.at_station` do the work of a phase, :mod:`.phases.job` is the present errand, and
:mod:`.phases.monitor` notices what comes up in any phase.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError
from roomba.geometry import STANDSTILL, Twist
from roomba.grid import OccupancyMap
from roomba.mission.checkpoint import checkpoint_of, remembered, state_after, take_up
from roomba.mission.cleaning.checkpoint import Values
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.request import CleanOutcome, CleanRequest, CleanResult
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.path_driver import PathDriver
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.exploring.exploration import Exploration, ExploreResult
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases import phases
from roomba.mission.phases.at_station import AtStation
from roomba.mission.phases.cleaning import CleanPhase
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Errand, Event, MissionState, Phase, next_state
from roomba.mission.phases.monitor import Monitor
from roomba.mission.phases.step import PhaseStep
from roomba.mission.steady import Steady
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer

_BIN_FULL: Final = "bin full: empty the dust bin, and tell the robot (empty_bin)"


class CommandRefusedError(RoombaError):
    """A command that is not possible now; the message says why."""


@dataclass(frozen=True, slots=True)
class MissionStep:
    """What is wanted at a tick.

    ``looks_around``: the place must be found before it can go on. ``wants_whole_map``: all that can
    be seen of a map in the making was seen; it goes on when it is told the whole one.
    """

    twist: Twist = STANDSTILL
    looks_around: bool = False
    wants_whole_map: bool = False


class Mission:
    """One robot's mission in one home. ``message`` says why it does not do what was asked."""

    def __init__(
        self,
        context: PlanningContext,
        robot: RobotConfig,
        config: MissionConfig,
        docking: DockingConfig,
        things: ThingLayer,
        dirt: DirtMap,
        senses: Senses,
        max_speed: float | None = None,
    ) -> None:
        """Begin standing, on the station or elsewhere; raises ConfigError for impossible speeds.

        ``max_speed`` is the robot's top speed, m/s, which may be set later; by default the body's.
        """
        config.require_possible(robot.body)
        self._robot, self._config = robot, config
        self.max_speed = robot.body.max_speed if max_speed is None else max_speed
        self.obstacles = Obstacles(things, robot.walk, robot.body, config.driving)
        self.state = MissionState(Phase.DOCKED if senses.battery.is_docked else Phase.IDLE)
        self._message = ""
        self._job = Job(dirt, config, robot.brush.bin_capacity, senses)
        self.ledger = self._job.ledger
        self._drives = Drives(context, robot, config.driving, self.obstacles)
        self.trail = self._drives.trail
        self._retries = RetryPolicy(config.driving.waiting)
        self._clean_phase = CleanPhase(self._job, self._drives, self._retries, config.exploring)
        self._at_station = AtStation(docking, robot)
        self._monitor = Monitor(robot.walk, self._drives, self.ledger, senses)
        self._last = senses

    # ---------------------------------------------------------------- commands

    def clean(self, request: CleanRequest, senses: Senses) -> None:
        """Begin a clean; raises CleanRefusedError or CommandRefusedError with the reason."""
        self._require_start(Event.CLEAN, senses)
        self._require_room_in_bin(senses)
        cleaning = self._cleaning_of(request, senses)
        self._end_job(CleanOutcome.STOPPED, "a newer clean took over", senses)
        self._job.forget()
        self._job.begin_clean(cleaning, senses)
        self.obstacles.forget()
        self._go(Event.CLEAN, senses)

    def explore(self, senses: Senses) -> None:
        """Begin to look for what the map does not show yet; raises CommandRefusedError.

        The caller lets the map grow, and passes it on by :meth:`use_map`.
        """
        self._require_start(Event.EXPLORE, senses)
        self._end_job(CleanOutcome.STOPPED, "it was told to explore", senses)
        self._job.forget()
        self._job.begin_exploration(senses)
        self.obstacles.forget()
        self._go(Event.EXPLORE, senses)

    def command(self, event: Event, senses: Senses, reason: str = "") -> None:
        """Obey a command without arguments; raises CommandRefusedError with the reason."""
        if next_state(self.state, event) is None:
            raise CommandRefusedError(
                f"cannot {event.value} now: the robot is {self.state.phase.value}"
                + (f" ({self.message})" if self.message else "")
            )
        if event in (Event.DOCK, Event.UNDOCK, Event.STOP):
            self._end_job(CleanOutcome.STOPPED, f"it was told to {event.value}", senses)
            self._job.forget()
        if event is Event.EMERGENCY:
            self._end_job(CleanOutcome.FAULT, f"emergency stop: {reason}", senses)
            self._job.forget()
        if event is Event.RESUME:
            self._retries.renew()
            self._job.take_up()
        self._go(event, senses)
        self._message = reason if event is Event.EMERGENCY else ""
        if event in (Event.RELEASE, Event.STOP) and senses.battery.is_docked:
            self._go(Event.CONTACT, senses)

    def _require_start(self, event: Event, senses: Senses) -> None:
        if self.state.phase is Phase.EMERGENCY:
            self.command(event, senses)
        least = self._config.energy.least_to_start
        if senses.battery.level < least and not senses.battery.is_docked:
            raise CommandRefusedError(
                f"expected a battery of {least:.0%} or more to begin, got "
                f"{senses.battery.level:.0%}; bring the robot to its station"
            )

    def _require_room_in_bin(self, senses: Senses) -> None:
        self._job.look_at_bin(senses)
        if self._job.bin.is_full:
            raise CommandRefusedError(f"expected room in the dust bin, got none: {_BIN_FULL}")

    def empty_bin(self, senses: Senses) -> None:
        """Go by an emptied dust bin; raises CommandRefusedError if its level sensor says no."""
        level = senses.in_bin / self._robot.brush.bin_capacity
        if level >= self._config.bin.full:
            raise CommandRefusedError(
                f"expected an empty dust bin, got one that is {level:.0%} full by its level sensor"
            )
        self._job.bin.emptied()
        self._go(Event.EMPTIED, senses)

    def _cleaning_of(self, request: CleanRequest, senses: Senses) -> Cleaning:
        return Cleaning(request, self.context, self.dirt, self._config.cleaning, senses.pose)

    def use_context(self, context: PlanningContext) -> None:
        """Go on with other zones or rooms, from the next tick on."""
        self._drives.use_context(context)
        if not self._goes_on_looking():
            self._drop_driver()
        if self.cleaning is not None:
            self.cleaning.use_context(context, self.dirt)
            self._look_no_more()

    def _look_no_more(self) -> None:
        """On the whole map a clean has nothing left to look for."""
        if self.cleaning is not None and not self.cleaning.explores:
            self._job.exploration = None

    def use_map(self, context: PlanningContext, things: ThingLayer, dirt: DirtMap) -> None:
        """Go on with a map that has grown, or with the whole one, from the next tick on.

        ``things`` and ``dirt`` are new ones of that map.
        """
        dirt.carry_on(self.dirt, context.station.compose(self.context.station.inverse()))
        self.obstacles.use(things)
        self._job.dirt = dirt
        self._job.bin.forget_places()
        self.use_context(context)

    def wants_map(self, occupancy: OccupancyMap) -> bool:
        """Whether a map that has grown to this makes a difference to what it does."""
        if self.driver is None:
            # By its station it goes by beams, and a new map would make it late.
            return self.state.phase not in (Phase.UNDOCKING, Phase.DOCKING)
        if self.state.phase is Phase.RETURNING:
            # Its way leads over known floor; a path planned anew each time begins with a turn.
            return False
        return self.exploration is not None and self.exploration.wants_another(occupancy)

    def _goes_on_looking(self) -> bool:
        """Whether it is on its way to a frontier that still is one, and nothing stands between."""
        looks = self.state.phase in (Phase.EXPLORING, Phase.CLEANING)
        if not (looks and self.exploration is not None and self.exploration.is_under_way):
            return False
        if self.driver is None or self.exploration.wants_another(self.context.known):
            return False
        return self.context.paths.is_free(self.driver.tracker.rest)

    def take_exploration(self) -> ExploreResult | None:
        """Return the result of an exploration that ended, once."""
        return self._job.take_exploration()

    def take_result(self) -> CleanResult | None:
        """Return the result of a clean that ended, once."""
        return self._job.take_result()

    def checkpoint(self, senses: Senses) -> Values | None:
        """Return all that must be remembered to go on, as plain values; None without an errand."""
        return checkpoint_of(self.state, self._message, self._job, senses.now)

    def restore(self, values: Values, senses: Senses) -> None:
        """Go on where a checkpoint was made, in the same map or more of it; raises CheckpointError.

        A robot that was under way goes on at once.
        """
        exploring = self._config.exploring
        found = remembered(values, lambda request: self._cleaning_of(request, senses), exploring)
        take_up(found, self._job, senses)
        self._look_no_more()
        self._message = found.message
        self._last = senses
        is_docked = self._monitor.was_docked = senses.battery.is_docked
        self.state = state_after(found.state, is_docked=is_docked)
        if self.state.phase is Phase.DOCKED:
            self._end_job(self._job.outcome or CleanOutcome.STOPPED, "", senses)

    # ---------------------------------------------------------------- what others may look at

    @property
    def message(self) -> str:
        """Why it does not do what was asked, and what helps; empty when all is well."""
        return self._message or (_BIN_FULL if self._job.bin.is_full else "")

    @message.setter
    def message(self, message: str) -> None:
        self._message = message

    @property
    def dust(self) -> NDArray[np.void]:
        """What the dirt sensor tells of the bin: one row of :data:`DUST`."""
        return self._job.bin.rows

    @property
    def context(self) -> PlanningContext:
        """The home as it plans in it."""
        return self._drives.context

    @property
    def dirt(self) -> DirtMap:
        """Where it is dirty."""
        return self._job.dirt

    @property
    def cleaning(self) -> Cleaning | None:
        """The clean that it is on."""
        return self._job.cleaning

    @property
    def exploration(self) -> Exploration | None:
        """The exploration that it is on."""
        return self._job.exploration

    @property
    def driver(self) -> PathDriver | None:
        """What drives the present path; None: a path is wanted at the next tick."""
        return self._drives.driver

    @driver.setter
    def driver(self, driver: PathDriver | None) -> None:
        self._drives.driver = driver

    def steady(self, senses: Senses) -> Steady | None:
        """Return what it does until something comes up; None: a tick decides."""
        phase, driver = self.state.phase, self.driver
        if phase is Phase.CHARGING:
            needed = self._at_station.needed
            if needed is None:
                return None
            return Steady(None, most_energy=self.ledger.charged_at(senses, needed))
        is_driving = phase in (Phase.CLEANING, Phase.EXPLORING, Phase.RETURNING)
        if not is_driving or driver is None or not driver.is_undisturbed or self._monitor.is_astray:
            return None
        if self._retries.is_pending and phase is not Phase.EXPLORING:
            return None
        limit, empty = self.speed_limit(senses), self.ledger.empty
        if phase is Phase.RETURNING:
            staging = self.context.staging
            goal = (staging.x, staging.y)
            near = self.context.staging_tolerance
            steady = Steady(driver, limit, least_level=empty, goal=goal, near=near)
        else:
            steady = Steady(driver, limit, self.ledger.next_check, empty)
        return self._until_bin_full(steady, senses)

    def _until_bin_full(self, steady: Steady, senses: Senses) -> Steady:
        """Let steady ticks end when the bin may have become full."""
        dust_bin = self._job.bin
        if not self.sweeps:
            return steady
        most_silent = dust_bin.most_silent if dust_bin.heeds_silence(senses.in_bin) else math.inf
        return replace(steady, most_in_bin=dust_bin.full_from, most_silent=most_silent)

    @property
    def last(self) -> Senses:
        """What it sensed at the last tick."""
        return self._last

    @property
    def last_place(self) -> tuple[float, float]:
        """Where it was at the last tick, m."""
        return self._last.pose.x, self._last.pose.y

    @property
    def sweeps(self) -> bool:
        """Whether what it drives over counts as cleaned."""
        return self.cleaning is not None and self.state.drives and not self._job.bin.is_full

    def speed_limit(self, senses: Senses) -> float:
        """Return how fast it goes now, m/s."""
        is_exploring = self.state.phase is Phase.EXPLORING
        config = self._config
        speed = config.exploring.speed if is_exploring else config.driving.speed
        speed = min(speed, self.max_speed)
        if senses.knowledge is Knowledge.ROUGH:
            return min(speed, self._robot.walk.careful_speed)
        return speed

    def seconds_to_go(self) -> float:
        """Return about how long the clean still takes, s of robot time; charging left out."""
        if self.cleaning is None:
            return 0.0
        driving = 0.0 if self.driver is None else self.driver.left
        if self.state.phase is Phase.CLEANING:
            driving = max(driving, self.cleaning.left / self.context.tool_width)
        speed = min(self._config.driving.speed, self.max_speed)
        return driving / (self._config.driving.mean_speed * speed)

    # ---------------------------------------------------------------- ticks

    def tick(self, senses: Senses) -> MissionStep:
        """Return what is wanted now."""
        self._job.account(senses, self._last, sweeps=self.sweeps)
        self._notice(senses)
        step = self._act(senses)
        self._last = senses
        return step

    def caught_up(self, senses: Senses, places: NDArray[np.float64], way: float) -> None:
        """Go on after steady ticks, the last of which began with these senses.

        They began at ``places``, float64 [n, 2], m; ``way`` m were driven from the tick before the
        first of them to the last.
        """
        self._drives.caught_up(senses, places)
        if self.sweeps:
            self._job.bin.passed(places)
        self.ledger.note(senses, way)
        self._last = senses

    def _notice(self, senses: Senses) -> None:
        """Find out what happened, and let the machine know."""
        # Under way to it, docking says when the contact is good, and undocking when it is out.
        at_station = self.state.phase in (Phase.DOCKING, Phase.UNDOCKING)
        if self._monitor.contact_changed(senses) and not at_station:
            self._go(Event.CONTACT if senses.battery.is_docked else Event.CONTACT_LOST, senses)
        failure = self._monitor.failure(self.state, senses, self.last_place)
        if failure is not None:
            self._fail(failure.outcome, failure.reason, senses)

    def _act(self, senses: Senses) -> MissionStep:
        if self._monitor.is_astray and self.state.phase is not Phase.DOCKING:
            return MissionStep(STANDSTILL, looks_around=self.state.drives)
        step = self._step(senses)
        if step.message is not None:
            self._message = step.message
        if step.event is Event.CONTACT:
            self._monitor.was_docked = True
        if step.event is not None:
            self._go(step.event, senses)
        if step.failure is not None:
            self._fail(step.failure.outcome, step.failure.reason, senses)
        return MissionStep(step.twist, wants_whole_map=step.wants_whole_map)

    def _step(self, senses: Senses) -> PhaseStep:
        """Let the present phase say what it wants."""
        job, drives, limit = self._job, self._drives, self.speed_limit(senses)
        match self.state.phase:
            case Phase.UNDOCKING:
                return self._at_station.undock(senses, self.context.station)
            case Phase.CLEANING:
                return self._clean_phase.tick(senses, limit)
            case Phase.EXPLORING:
                most_stuck = self._config.exploring.most_stuck
                return phases.explore(job, drives, senses, limit, most_stuck)
            case Phase.RETURNING:
                return phases.go_home(drives, self._retries, senses, limit)
            case Phase.DOCKING:
                return self._at_station.dock(senses, self.context.station)
            case Phase.CHARGING:
                return self._at_station.charge(senses, job, self.context.tool_width)
            case Phase.BIN_FULL:
                return PhaseStep(event=None if job.bin.is_full else Event.EMPTIED)
        return PhaseStep()

    # ---------------------------------------------------------------- transitions

    def _go(self, event: Event, senses: Senses) -> None:
        """Let an event change the state; what belonged to the old phase ends."""
        after = next_state(self.state, event)
        if after is None or after == self.state:
            return
        before, self.state = self.state, after
        self._drop_driver()
        self._at_station.forget()
        if event is not Event.FAILED:
            self._message = ""
        if event is Event.FINISHED:
            self._job.outcome = CleanOutcome.COMPLETED
        if after.phase is Phase.DOCKED:
            self._retries.renew()
            if before.errand in (Errand.HOME, Errand.CLEAN):
                self._end_job(self._job.outcome or CleanOutcome.STOPPED, "", senses)

    def _drop_driver(self) -> None:
        """Drive there no more; what was not driven of a round is planned again."""
        if self.driver is not None and self.cleaning is not None and self._drives.is_round:
            self.cleaning.interrupted(self.driver.left)
        self._drives.driver = None

    def _fail(self, outcome: CleanOutcome, reason: str, senses: Senses) -> None:
        self._go(Event.FAILED, senses)
        self._message = reason
        self._end_job(outcome, reason, senses)

    def _end_job(self, outcome: CleanOutcome, message: str, senses: Senses) -> None:
        """Tell the result of the job under way, if there is one; after an error it can go on."""
        can_go_on = self.state.phase is Phase.ERROR
        self._job.end(outcome, message, self.context, self.obstacles, senses, can_go_on=can_go_on)
