"""The mission: what the robot does from one command to the next, all of it put together.

No clock and no I/O: it is told commands and, 20 times a second, what the robot senses; it answers
with the twist it wants. :mod:`.machine` says what comes after what; :mod:`.cleaning`,
:mod:`.path_driver`, :mod:`.docking` and :mod:`.undocking` do it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.config import RobotConfig
from roomba.errors import RoombaError
from roomba.geometry import STANDSTILL, Twist
from roomba.grid import OccupancyMap
from roomba.mission.checkpoint import VERSION, CheckpointError, Values, request_of
from roomba.mission.clean_request import (
    CleanOutcome,
    CleanRequest,
    CleanResult,
    Missed,
)
from roomba.mission.cleaning import Cleaning
from roomba.mission.docking import Docking, DockSenses, DockState
from roomba.mission.docking_config import DockingConfig
from roomba.mission.energy import EnergyBook
from roomba.mission.exploration import Exploration, ExploreResult
from roomba.mission.machine import Errand, Event, MissionState, Phase, next_state
from roomba.mission.obstacles import Obstacles
from roomba.mission.path_driver import DriveState, PathDriver
from roomba.mission.rejoin import Rejoin
from roomba.mission.senses import Senses
from roomba.mission.site import Site
from roomba.mission.trail import Trail
from roomba.mission.undocking import Undocking, UndockState
from roomba.mission_config import MissionConfig
from roomba.perception.dirt_map import DirtMap
from roomba.perception.estimate import Knowledge
from roomba.perception.things import ThingLayer
from roomba.planning.path import NoPathError

_LONGEST_TICK: Final = 2.0
"""s; more between two ticks than this is a clock that was set."""
_SHARE_OF_SPEED: Final = 0.65
"""Of the speed it is given that a robot comes to on the whole: it turns a lot."""
_CARRIED: Final = 1.0
"""m; farther from where it last knew its place it did not drive itself while it looked around."""
_MOST_WAYS_HOME: Final = 5
"""So often it looks for a way home before it says that there is none."""
_WAIT: Final = 30.0
"""s; so long it waits, where no way leads home, before it looks for one again."""
_MOST_WAITS: Final = 40
"""Twenty minutes."""
_NEAR_STAGING: Final = 0.08
"""m; so near to the place before the station docking takes over."""


class CommandRefusedError(RoombaError):
    """A command that means nothing now; the message says why."""


@dataclass(frozen=True, slots=True)
class MissionStep:
    """What is wanted at a tick; ``looks_around``: the place must be found before it can go on."""

    twist: Twist = STANDSTILL
    looks_around: bool = False


class Mission:
    """One robot's mission in one home. ``message`` says why it does not do what was asked."""

    def __init__(
        self,
        site: Site,
        robot: RobotConfig,
        config: MissionConfig,
        docking: DockingConfig,
        things: ThingLayer,
        dirt: DirtMap,
        senses: Senses,
    ) -> None:
        """Begin standing, on the station or elsewhere."""
        self.site, self.dirt = site, dirt
        self._robot, self._config, self._docking_config = robot, config, docking
        self.obstacles = Obstacles(things, robot.walk, robot.body, config.driving)
        self.state = MissionState(Phase.DOCKED if senses.battery.is_docked else Phase.IDLE)
        self.message = ""
        self.cleaning: Cleaning | None = None
        self.exploration: Exploration | None = None
        self._explored: ExploreResult | None = None
        self.book = EnergyBook(config.energy, senses)
        self._rejoin = Rejoin(site, robot.body.radius, config.driving)
        self.driver: PathDriver | None = None
        self.trail = Trail()
        self._docking: Docking | None = None
        self._undocking: Undocking | None = None
        self._outcome: CleanOutcome | None = None
        self._is_told = False
        self._result: CleanResult | None = None
        self._was_docked = senses.battery.is_docked
        self._needed: float | None = None
        self._astray_since: float | None = None
        self._known_at = (senses.pose.x, senses.pose.y)
        self._last = senses
        self._started = senses.now
        self._dock_retries = 0
        self._waits_since, self._gets_out = -math.inf, False

    # ---------------------------------------------------------------- commands

    def clean(self, request: CleanRequest, senses: Senses) -> None:
        """Begin a clean; raises CleanRefusedError or CommandRefusedError with the reason."""
        if self.state.phase is Phase.EMERGENCY:
            self.command(Event.CLEAN, senses)
        self._require_charge(senses)
        cleaning = Cleaning(request, self.site, self.dirt, self._config.cleaning, senses.pose)
        self._end_errand(CleanOutcome.STOPPED, "a newer clean took over", senses)
        self._forget_errand()
        self.cleaning, self._outcome, self._is_told = cleaning, None, False
        self.book.begin(senses)
        self._started = senses.now
        self.obstacles.forget()
        self._go(Event.CLEAN, senses)

    def explore(self, senses: Senses) -> None:
        """Begin to look for what the map does not show yet; raises CommandRefusedError.

        Whoever calls it lets the map grow, and tells it by :meth:`use_site`.
        """
        if self.state.phase is Phase.EMERGENCY:
            self.command(Event.EXPLORE, senses)
        self._require_charge(senses)
        self._end_errand(CleanOutcome.STOPPED, "it was told to explore", senses)
        self._forget_errand()
        self.exploration, self._explored = Exploration(), None
        self._outcome, self._is_told = None, False
        self.book.begin(senses)
        self._started = senses.now
        self.obstacles.forget()
        self._go(Event.EXPLORE, senses)

    def command(self, event: Event, senses: Senses, reason: str = "") -> None:
        """Obey a command without further wishes; raises CommandRefusedError with the reason."""
        after = next_state(self.state, event)
        if after is None:
            raise CommandRefusedError(
                f"cannot {event.value} now: the robot is {self.state.phase.value}"
                + (f" ({self.message})" if self.message else "")
            )
        if event in (Event.DOCK, Event.UNDOCK, Event.STOP):
            self._end_errand(CleanOutcome.STOPPED, f"it was told to {event.value}", senses)
            self._forget_errand()
        if event is Event.EMERGENCY:
            self._end_errand(CleanOutcome.FAULT, f"emergency stop: {reason}", senses)
            self._forget_errand()
        if event is Event.RESUME:
            self._dock_retries, self._is_told = 0, False
        self._go(event, senses)
        self.message = reason if event is Event.EMERGENCY else ""
        if event is Event.RELEASE and senses.battery.is_docked:
            self._go(Event.CONTACT, senses)

    def _require_charge(self, senses: Senses) -> None:
        least = self._config.energy.least_to_start
        if senses.battery.level < least and not senses.battery.is_docked:
            raise CommandRefusedError(
                f"expected a battery of {least:.0%} or more to begin, got "
                f"{senses.battery.level:.0%}; bring the robot to its station"
            )

    def use_site(self, site: Site) -> None:
        """Go on with other zones or rooms, from the next tick on."""
        self.site = site
        self._rejoin = Rejoin(site, self._robot.body.radius, self._config.driving)
        if not self._goes_on_exploring():
            self._drop_driver()
        if self.cleaning is not None:
            self.cleaning.use_site(site)

    def use_map(self, site: Site, things: ThingLayer, dirt: DirtMap) -> None:
        """Go on with a map of the same frame that has grown; not while it cleans.

        ``things`` and ``dirt`` are those of that map. Raises ValueError while it cleans.
        """
        if self.cleaning is not None:
            raise ValueError("expected no clean under way: its floor is counted on the map it has")
        self.obstacles.use(things)
        self.dirt = dirt
        self.use_site(site)

    def wants_map(self, occupancy: OccupancyMap) -> bool:
        """Whether a map that has grown to this makes a difference to what it does."""
        if self.driver is None:
            return True
        return self.exploration is not None and self.exploration.wants_another(occupancy)

    def _goes_on_exploring(self) -> bool:
        """Whether it is on its way to a frontier that still is one, and nothing stands between."""
        if self.exploration is None or self.state.phase is not Phase.EXPLORING:
            return False
        if self.driver is None or self.exploration.wants_another(self.site.known):
            return False
        return self.site.paths.is_free(self.driver.tracker.rest)

    def take_exploration(self) -> ExploreResult | None:
        """Return the result of an exploration that ended, once."""
        result, self._explored = self._explored, None
        return result

    def take_result(self) -> CleanResult | None:
        """Return the result of a clean that ended, once."""
        result, self._result = self._result, None
        return result

    def checkpoint(self, senses: Senses) -> Values | None:
        """Return all that must be remembered to go on, as plain values; None without an errand."""
        if self.state.errand is Errand.NONE or self.state.errand is Errand.UNDOCK:
            return None
        resumes = self.state.resumes
        return {
            "version": VERSION,
            "phase": self.state.phase.name,
            "errand": self.state.errand.name,
            "resumes": None if resumes is None else resumes.name,
            "message": self.message,
            "outcome": None if self._outcome is None else self._outcome.name,
            "cleaning": None if self.cleaning is None else self.cleaning.values(),
            "exploration": None if self.exploration is None else self.exploration.values(),
            "book": [self.book.distance, self.book.energy, self.book.dirt],
            "duration": senses.now - self._started,
        }

    def restore(self, values: Values, senses: Senses) -> None:
        """Go on where a checkpoint was made, in the same map; raises CheckpointError.

        A robot that was under way goes on at once.
        """
        try:
            if values["version"] != VERSION:
                raise CheckpointError(f"expected version {VERSION}, got {values['version']}")
            resumes = values["resumes"]
            phase, errand = Phase[values["phase"]], Errand[values["errand"]]
            state = MissionState(phase, errand, None if resumes is None else Phase[resumes])
            cleaning = None
            if values["cleaning"] is not None:
                request = request_of(values["cleaning"]["request"])
                cleaning = Cleaning(
                    request, self.site, self.dirt, self._config.cleaning, senses.pose
                )
                cleaning.restore(values["cleaning"])
            elif errand is Errand.CLEAN:
                raise CheckpointError("expected the clean that it was on, got none")
            unseen = values["exploration"]
            exploration = None if unseen is None else Exploration.of(unseen)
            if errand is Errand.EXPLORE and exploration is None:
                raise CheckpointError("expected the exploration that it was on, got none")
            outcome = values["outcome"]
            self._outcome = None if outcome is None else CleanOutcome[outcome]
            distance, energy, dirt = (float(value) for value in values["book"])
            duration = float(values["duration"])
            if not all(math.isfinite(value) for value in (distance, energy, dirt, duration)):
                raise CheckpointError("expected finite numbers")
            self._started = senses.now - duration
            message = str(values["message"])
        except (LookupError, ArithmeticError, AttributeError, TypeError, ValueError) as error:
            raise CheckpointError(f"expected a checkpoint of this map: {error!r}") from error
        except RoombaError as error:
            raise CheckpointError(f"expected a checkpoint of this map: {error!r}") from error
        self.cleaning, self.message, self._is_told = cleaning, message, False
        self.exploration = exploration
        self.book.begin(senses)
        self.book.distance, self.book.energy, self.book.dirt = distance, energy, dirt
        self._last = senses
        self._was_docked = senses.battery.is_docked
        self.state = _taken_up(state, senses.battery.is_docked)
        if self.state.phase is Phase.DOCKED:
            self._end_errand(self._outcome or CleanOutcome.STOPPED, "", senses)

    # ---------------------------------------------------------------- ticks

    def tick(self, senses: Senses) -> MissionStep:
        """Return what is wanted now."""
        self._account(senses)
        self._notice(senses)
        step = self._act(senses)
        self._last = senses
        return step

    @property
    def is_undisturbed(self) -> bool:
        """Whether the next ticks are the driver's tracker's alone, while nothing comes up."""
        return (
            self.state.phase in (Phase.CLEANING, Phase.RETURNING)
            and self.driver is not None
            and self.driver.is_undisturbed
            and self._astray_since is None
        )

    def caught_up(self, senses: Senses, way: float) -> None:
        """Go on after ticks that were the tracker's alone: ``way`` m were driven in them."""
        if self.driver is not None:
            along = self.driver.tracker.along
            self.trail.follow(self.driver.tracker, along - way, along)
            self.driver.caught_up(senses)
        self.book.note(senses, way)
        self._last = senses

    @property
    def last_place(self) -> tuple[float, float]:
        """Where it was at the last tick, m."""
        return self._last.pose.x, self._last.pose.y

    @property
    def sweeps(self) -> bool:
        """Whether what it drives over counts as cleaned."""
        return self.cleaning is not None and self.state.drives

    def speed_limit(self, senses: Senses) -> float:
        """Return how fast it goes now, m/s."""
        is_exploring = self.state.phase is Phase.EXPLORING
        config = self._config
        speed = config.exploring.speed if is_exploring else config.driving.speed
        if senses.knowledge is Knowledge.ROUGH:
            return min(speed, self._robot.walk.careful_speed)
        return speed

    def seconds_to_go(self) -> float:
        """Return about how long the clean still takes, s of robot time; charging left out."""
        if self.cleaning is None:
            return 0.0
        driving = 0.0 if self.driver is None else self.driver.left
        if self.state.phase is Phase.CLEANING:
            driving = max(driving, self.cleaning.left / self.site.tool_width)
        return driving / (_SHARE_OF_SPEED * self._config.driving.speed)

    def _account(self, senses: Senses) -> None:
        """Keep the books: energy, way, floor swept, dirt met."""
        self.book.note(senses)
        if not 0.0 <= senses.now - self._last.now <= _LONGEST_TICK:
            self._started += senses.now - self._last.now
        cleaning = self.cleaning
        if cleaning is None or not senses.knowledge.is_usable or not self.sweeps:
            if cleaning is not None:
                cleaning.coverage.lift()
            return
        way = senses.pose.distance_to(self._last.pose.x, self._last.pose.y)
        elapsed = min(max(senses.now - self._last.now, 0.0), _LONGEST_TICK)
        cleaning.coverage.sweep(senses.pose.x, senses.pose.y)
        self.dirt.note(senses.pose.x, senses.pose.y, senses.grains * elapsed, way)

    def _notice(self, senses: Senses) -> None:
        """Find out what happened, and let the machine know."""
        is_docked = senses.battery.is_docked
        if is_docked != self._was_docked:
            self._was_docked = is_docked
            # Under way to it, docking says when the contact is good, and undocking when it is out.
            if self.state.phase not in (Phase.DOCKING, Phase.UNDOCKING):
                self._go(Event.CONTACT if is_docked else Event.CONTACT_LOST, senses)
        if not self.state.drives:
            self._astray_since = None
            return
        if senses.lifted:
            self._fail(
                CleanOutcome.FAULT, "a wheel hangs in the air: set it down and resume", senses
            )
        elif self.book.is_empty(senses):
            self._fail(
                CleanOutcome.BATTERY, "the battery is empty: carry it to its station", senses
            )
        elif self.state.phase is not Phase.DOCKING:
            self._notice_astray(senses)

    def _notice_astray(self, senses: Senses) -> None:
        if senses.knowledge.is_usable:
            if self._astray_since is not None:
                self._astray_since = None
                x, y = self._known_at
                if senses.pose.distance_to(x, y) > _CARRIED:
                    # It was carried, or wrong before: what it remembers is of another place.
                    self.trail.forget()
                    self.obstacles.forget()
            return
        if self._astray_since is None or senses.now < self._astray_since:
            self._astray_since = senses.now
            self._known_at = self.last_place
        waited = senses.now - self._astray_since
        if senses.knowledge is Knowledge.LOST or waited > self._robot.walk.astray_timeout:
            reason = f"the robot does not know where it is: {senses.trouble}"
            self._fail(CleanOutcome.LOST, reason, senses)

    def _act(self, senses: Senses) -> MissionStep:
        if self._astray_since is not None and self.state.phase is not Phase.DOCKING:
            return MissionStep(STANDSTILL, looks_around=self.state.drives)
        match self.state.phase:
            case Phase.UNDOCKING:
                return self._undock(senses)
            case Phase.CLEANING:
                return self._clean(senses)
            case Phase.EXPLORING:
                return self._explore(senses)
            case Phase.RETURNING:
                return self._return(senses)
            case Phase.DOCKING:
                return self._dock(senses)
            case Phase.CHARGING:
                if self._needed is None:
                    self._needed = self._needed_energy()
                if self.book.is_charged(senses, self._needed):
                    self._go(Event.CHARGED, senses)
        return MissionStep()

    # ---------------------------------------------------------------- phases

    def _undock(self, senses: Senses) -> MissionStep:
        if self._undocking is None:
            self._undocking = Undocking(
                self._docking_config, self.site.station, self._dock_senses(senses)
            )
        step = self._undocking.tick(self._dock_senses(senses))
        if step.state is UndockState.OUT:
            self._go(Event.OUT, senses)
        elif step.state is UndockState.FAILED:
            self._fail(CleanOutcome.STUCK, step.reason, senses)
        return MissionStep(step.twist)

    def _clean(self, senses: Senses) -> MissionStep:
        assert self.cleaning is not None
        if self.book.must_go_home(senses, self._way_home):
            self._go(Event.LOW, senses)
            return MissionStep()
        if self._is_waiting(senses):
            return MissionStep()
        if self.driver is None and not self._leave_zone(senses):
            obstacles = self.obstacles.standing(senses.now)
            points = None
            if self._gets_out:
                # By the middle of gaps: along their sides, as it cleans, it may have been shut in.
                self._gets_out = False
                points = self._rejoin.way_out(senses, self.obstacles, self.trail)
            try:
                if points is None:
                    points = self.cleaning.next_path(senses.pose, obstacles)
            except NoPathError:
                points = self._rejoin.way_out(senses, self.obstacles, self.trail)
                if points is None:
                    self._wait("no way leads out of where it is", senses)
                    return MissionStep()
            if points is None:
                if self.cleaning.wants_another_look(self.obstacles.edges()):
                    self.obstacles.forget()
                else:
                    self._go(Event.FINISHED, senses)
                return MissionStep()
            self.driver = self._drive(points, senses, self.cleaning.plans_anew)
        assert self.driver is not None
        step = self.driver.tick(senses, self.speed_limit(senses))
        if step.state is DriveState.STUCK:
            self._fail(CleanOutcome.STUCK, step.reason, senses)
        elif step.state.is_over:
            if step.state is DriveState.CUT_OFF:
                self.cleaning.cut_off()
            self.driver = None
        return MissionStep(step.twist)

    def _explore(self, senses: Senses) -> MissionStep:
        """Go to the nearest place from where more can be seen."""
        assert self.exploration is not None
        if self.book.must_go_home(senses, self._way_home):
            self._go(Event.LOW, senses)
            return MissionStep()
        if self.driver is None:
            obstacles = self.obstacles.standing(senses.now)
            points = self.exploration.next_path(senses.pose, self.site, obstacles)
            if points is None:
                self._go(Event.FINISHED, senses)
                return MissionStep()
            self.driver = self._drive(points, senses)
        step = self.driver.tick(senses, self.speed_limit(senses))
        is_stuck = step.state is DriveState.STUCK
        if is_stuck and self.exploration.times_stuck >= self._config.exploring.most_stuck:
            self._fail(CleanOutcome.STUCK, step.reason, senses)
        elif step.state.is_over:
            if step.state is not DriveState.DONE:
                self.exploration.cut_off(is_stuck=is_stuck)
            self.driver = None
        return MissionStep(step.twist)

    def _return(self, senses: Senses) -> MissionStep:
        staging = self.site.staging
        if senses.battery.is_docked:
            self._go(Event.CONTACT, senses)
            return MissionStep()
        if senses.pose.distance_to(staging.x, staging.y) < _NEAR_STAGING:
            self._go(Event.ARRIVED, senses)
            return MissionStep()
        if self._is_waiting(senses):
            return MissionStep()
        if self.driver is None and not self._leave_zone(senses):
            try:
                points = self._rejoin.way_home(senses, self.obstacles, self.trail)
            except NoPathError as error:
                self._try_home_again(f"no way home: {error}", senses)
                return MissionStep()
            self.driver = self._drive(points, senses)
        assert self.driver is not None
        step = self.driver.tick(senses, self.speed_limit(senses))
        if step.state is DriveState.STUCK:
            self._fail(CleanOutcome.STUCK, step.reason, senses)
        elif step.state is DriveState.CUT_OFF:
            self.driver = None
            self._try_home_again(step.reason, senses)
        elif step.state.is_over:
            self.driver = None
        return MissionStep(step.twist)

    def _leave_zone(self, senses: Senses) -> bool:
        """Begin to drive out of a no-go zone, should the robot be in one; tell whether it is."""
        here = (senses.pose.x, senses.pose.y)
        if not self.site.is_in_zone(here):
            return False
        try:
            points = self.site.way_out_of_zone(here, self.obstacles.standing(senses.now))
        except NoPathError:
            return False
        self.driver = self._drive(points, senses)
        return True

    def _try_home_again(self, reason: str, senses: Senses) -> None:
        """Once more without what was remembered; a door may open; then it says there is no way."""
        self._dock_retries += 1
        if self._dock_retries > _MOST_WAYS_HOME + _MOST_WAITS:
            self._fail(CleanOutcome.NOT_DOCKED, reason, senses)
            return
        if self._dock_retries > _MOST_WAYS_HOME:
            self._wait(reason, senses)
        self.obstacles.forget()

    def _wait(self, reason: str, senses: Senses) -> None:
        """Stand for a while, and then look anew: a door that is shut is opened again."""
        self.message = f"{reason}; it waits for a way to open"
        self._waits_since, self._gets_out = senses.now, True
        self.obstacles.forget()

    def _is_waiting(self, senses: Senses) -> bool:
        return 0.0 <= senses.now - self._waits_since < _WAIT

    def _dock(self, senses: Senses) -> MissionStep:
        if self._docking is None:
            self._docking = Docking(
                self._docking_config,
                self._robot.body,
                self._robot.station,
                self.site.station,
                self._dock_senses(senses),
            )
        step = self._docking.tick(self._dock_senses(senses))
        if step.state is DockState.DOCKED:
            self._was_docked = True
            self._go(Event.CONTACT, senses)
        elif step.state is DockState.FAILED:
            self._fail(CleanOutcome.NOT_DOCKED, step.reason, senses)
        return MissionStep(step.twist)

    # ---------------------------------------------------------------- transitions

    def _go(self, event: Event, senses: Senses) -> None:
        """Let an event change the state; what belonged to the old phase ends."""
        after = next_state(self.state, event)
        if after is None or after == self.state:
            return
        before, self.state = self.state, after
        self._drop_driver()
        self._docking = self._undocking = None
        self._needed = None
        if event is not Event.FAILED:
            self.message = ""
        if event is Event.FINISHED:
            self._outcome = CleanOutcome.COMPLETED
        if after.phase is Phase.DOCKED:
            self._dock_retries = 0
            if before.errand in (Errand.HOME, Errand.CLEAN):
                self._end_errand(self._outcome or CleanOutcome.STOPPED, "", senses)

    def _drop_driver(self) -> None:
        """Drive there no more; what was not driven of a round is planned again."""
        if self.driver is not None and self.cleaning is not None:
            self.cleaning.interrupted()
        self.driver = None

    def _fail(self, outcome: CleanOutcome, reason: str, senses: Senses) -> None:
        self._go(Event.FAILED, senses)
        self.message = reason
        self._end_errand(outcome, reason, senses)

    def _end_errand(self, outcome: CleanOutcome, message: str, senses: Senses) -> None:
        """Make the result of the errand under way, if there is one; it can still be resumed."""
        if self._is_told or (self.cleaning is None and self.exploration is None):
            return
        if self.cleaning is not None:
            self._result = self._clean_result(self.cleaning, outcome, message, senses)
        if self.exploration is not None:
            self._explored = self._explore_result(self.exploration, outcome, message, senses)
        self._is_told = True
        if self.state.phase is not Phase.ERROR:
            self._forget_errand()

    def _clean_result(
        self, cleaning: Cleaning, outcome: CleanOutcome, message: str, senses: Senses
    ) -> CleanResult:
        obstacles = self.obstacles.standing(senses.now)
        is_over = cleaning.stage is None
        missed: tuple[Missed, ...] = cleaning.missed(obstacles, is_over)
        return CleanResult(
            outcome,
            message,
            wanted=cleaning.coverage.wanted_area,
            covered=cleaning.clean_area,
            dirt=self.book.dirt,
            distance=self.book.distance,
            duration=senses.now - self._started,
            energy=self.book.energy,
            missed=missed,
        )

    def _explore_result(
        self, exploration: Exploration, outcome: CleanOutcome, message: str, senses: Senses
    ) -> ExploreResult:
        return ExploreResult(
            outcome,
            message,
            exploration.known_area(self.site),
            self.book.distance,
            senses.now - self._started,
            tuple(exploration.unseen),
        )

    def _forget_errand(self) -> None:
        """What was under way is over for good."""
        self.exploration = None
        if self.cleaning is not None:
            self.cleaning = None
            self.dirt.end_run()

    # ---------------------------------------------------------------- parts

    def _drive(
        self,
        points: NDArray[np.float64],
        senses: Senses,
        plans_anew: Callable[[float, float], bool] = lambda now, left: False,
    ) -> PathDriver:
        self.message = ""
        return PathDriver(
            points,
            self._rejoin,
            self.obstacles,
            self.trail,
            self._config.driving,
            self._robot.tracking,
            self._robot.body,
            senses,
            plans_anew,
        )

    def _dock_senses(self, senses: Senses) -> DockSenses:
        return DockSenses(
            senses.now,
            senses.pose,
            senses.beams.halo,
            senses.beams.green,
            senses.beams.red,
            senses.bumper_left,
            senses.bumper_right,
            senses.cliff,
            senses.battery.is_docked,
            senses.knowledge.is_usable,
        )

    def _way_home(self, senses: Senses) -> float:
        """Return how far it is home, m; what cannot be told is as far as the map is wide."""
        staging = self.site.staging
        try:
            obstacles = self.obstacles.standing(senses.now)
            here = (senses.pose.x, senses.pose.y)
            return self.site.paths.plan(here, (staging.x, staging.y), obstacles).length
        except NoPathError:
            left, right, low, high = self.site.known.frame.extent
            return right - left + high - low

    def _needed_energy(self) -> float:
        """Return what the rest of the errand takes, Wh; nobody knows that of an exploration."""
        if self.exploration is not None:
            return math.inf
        if self.cleaning is None:
            return 0.0
        return self.book.per_metre * 1.2 * self.cleaning.left / self.site.tool_width


def _taken_up(state: MissionState, is_docked: bool) -> MissionState:
    """Return the state in which a restored mission goes on, wherever the robot stands now."""
    if state.phase is Phase.CHARGING and not is_docked:
        return MissionState(Phase.RETURNING, state.errand)
    if state.resumes in (Phase.CLEANING, Phase.EXPLORING):
        # Should it stand on the station by now, it has to come out first.
        return replace(state, resumes=Phase.UNDOCKING)
    if not state.drives:
        return state
    if state.errand in (Errand.CLEAN, Errand.EXPLORE):
        if is_docked and state.phase in (Phase.RETURNING, Phase.DOCKING):
            return MissionState(Phase.CHARGING, state.errand)
        return MissionState(Phase.UNDOCKING, state.errand)
    if is_docked:
        return MissionState(Phase.DOCKED)
    return MissionState(Phase.RETURNING, state.errand)
