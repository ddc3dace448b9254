"""The mission: the interface by which callers command the robot's behaviour and look at it.

No clock and no I/O: it gets commands and, 20 times a second, the senses; it returns the wanted
twist. It is put together from its parts: :mod:`.phases.machine` is the state machine,
:mod:`.transitions` changes the state by it, :mod:`.commands` obeys commands, :mod:`.ticks` does the
work of each tick, and :mod:`.phases.job` is the present errand.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import old_in_new
from roomba.grid import OccupancyMap
from roomba.mission.changed_home import ChangedHome
from roomba.mission.checkpoint import checkpoint_of, remembered, state_after, take_up
from roomba.mission.cleaning.checkpoint import Values
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.result import CleanOutcome, CleanResult
from roomba.mission.commands import Commands
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.path_driver import PathDriver
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.exploring.exploration import Exploration, ExploreResult
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.at_station import AtStation
from roomba.mission.phases.carpet import CarpetSense
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Errand, Event, MissionState, way_ended
from roomba.mission.phases.monitor import Monitor
from roomba.mission.steady import Steady
from roomba.mission.ticks import MissionStep, MissionTicks
from roomba.mission.transitions import Transitions
from roomba.perception.rooms.felt_carpets import CarpetVotes
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.vocabulary import Phase, Reason, RoomWay


class Mission:
    """One robot's mission in one home. ``reason`` says why it does not do what was asked."""

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
        self._config = config
        self.obstacles = Obstacles(things, robot.walk, robot.body, config.driving)
        self._job = Job(
            dirt, config, robot.brush.bin_capacity, senses, robot.localization.known_deviation
        )
        self.ledger = self._job.ledger
        self._drives = Drives(context, robot, config.driving, self.obstacles)
        self.trail = self._drives.trail
        retries = RetryPolicy(config.driving.waiting)
        at_station = AtStation(docking, robot)
        self._monitor = Monitor(robot.walk, self._drives, self.ledger, senses)
        begun = MissionState(Phase.DOCKED if senses.battery.is_docked else Phase.IDLE)
        self._transitions = Transitions(
            begun, self._job, self._drives, self.obstacles, at_station, retries
        )
        self._commands = Commands(
            config,
            robot.brush.bin_capacity,
            self._transitions,
            self._job,
            self._drives,
            self.obstacles,
            retries,
        )
        self._home = ChangedHome(self._transitions, self._job, self._drives, self.obstacles)
        self._ticks = MissionTicks(
            robot,
            config,
            transitions=self._transitions,
            job=self._job,
            drives=self._drives,
            at_station=at_station,
            monitor=self._monitor,
            retries=retries,
            senses=senses,
            max_speed=robot.body.max_speed if max_speed is None else max_speed,
        )

    def clean(self, request: CleanRequest, senses: Senses) -> None:
        """Begin a clean; raises CleanRefusedError or CommandRefusedError with the reason."""
        self._commands.clean(request, senses)

    def change_rooms(self, names: Sequence[str], each: Sequence[RoomWay] = ()) -> None:
        """Let the clean of rooms under way go on with ``names``, in this order, the first at once.

        ``each`` is how each room is cleaned. Without it, rooms of before stay as they were, and new
        ones are cleaned as the request says for all. Raises CleanRefusedError or
        CommandRefusedError with the reason.
        """
        self._commands.change_rooms(names, each)

    def explore(self, senses: Senses) -> None:
        """Begin to look for what the map does not show yet; raises CommandRefusedError.

        The caller lets the map grow, and passes it on by :meth:`use_map`.
        """
        self._commands.explore(senses)

    def command(self, event: Event, senses: Senses, reason: str = "") -> None:
        """Obey a command without arguments; raises CommandRefusedError with the reason.

        EMPTIED notes that the dust bin was emptied by hand, unless its level sensor says no; EMPTY
        lets the station empty it.
        """
        self._commands.obey(event, senses, reason)

    def use_context(self, context: PlanningContext) -> None:
        """Go on with other zones or rooms, from the next tick on."""
        self._home.use_context(context)

    def use_map(self, context: PlanningContext, things: ThingLayer, dirt: DirtMap) -> None:
        """Go on with a map that has grown, or with the whole one, from the next tick on.

        ``things`` and ``dirt`` are new and belong to that map.
        """
        moved = old_in_new(self.context.station, context.station)
        self._ticks.carpets = self.carpets.carried_to(context.occupancy, moved)
        self._home.use_map(context, things, dirt, moved)

    def wants_map(self, occupancy: OccupancyMap) -> bool:
        """Whether the grown map ``occupancy`` makes a difference to what the robot does."""
        return self._home.wants_map(occupancy)

    def take_exploration(self) -> ExploreResult | None:
        """Return the result of an exploration that ended, once."""
        return self._job.take_exploration()

    def take_result(self) -> CleanResult | None:
        """Return the result of a clean that ended, once."""
        return self._job.take_result()

    def way_ended(self, errand: Errand) -> CleanOutcome | None:
        """Return how a way into the station (DOCK) or out of it (UNDOCK) ended; None: not yet."""
        transitions = self._transitions
        return way_ended(transitions.state, errand, transitions.last_command)

    def checkpoint(self, senses: Senses) -> Values | None:
        """Return all that must be remembered to go on, as plain values; None without an errand."""
        return checkpoint_of(self.state, self._transitions.reason, self._job, senses.now)

    def restore(self, values: Values, senses: Senses) -> None:
        """Go on where a checkpoint was made, in the same map or more of it; raises CheckpointError.

        A robot that was under way goes on at once.
        """
        context, exploring = self.context, self._config.exploring
        found = remembered(
            values, lambda request: self._job.cleaning_of(request, context, senses), exploring
        )
        take_up(found, self._job, senses)
        self._job.look_no_more(context.known)
        self._ticks.last = senses
        is_docked = self._monitor.was_docked = senses.battery.is_docked
        transitions = self._transitions
        transitions.reason = found.reason
        transitions.state = state_after(found.state, is_docked=is_docked)
        if self.state.phase is Phase.DOCKED:
            transitions.end_job_at_station(senses)

    @property
    def state(self) -> MissionState:
        """Its phase and errand."""
        return self._transitions.state

    @property
    def reason(self) -> Reason:
        """Why it does not do what was asked, and what helps; empty when all is well."""
        if self._monitor.is_astray and self.state.drives:
            return Reason(f"it stands until it knows where it is: {self.last.trouble}")
        return self._transitions.told

    @property
    def message(self) -> str:
        """The :attr:`reason` as a sentence."""
        return self.reason.text

    @message.setter
    def message(self, message: str) -> None:
        self._transitions.reason = Reason(message)

    @property
    def dust(self) -> NDArray[np.void]:
        """What the dirt sensor tells of the bin: one row of :data:`DUST`."""
        return self._job.bin.rows

    @property
    def context(self) -> PlanningContext:
        """The planning context: the home as the mission plans in it."""
        return self._drives.context

    @property
    def dirt(self) -> DirtMap:
        """The dirt map: where the floor is dirty."""
        return self._job.dirt

    @property
    def cleaning(self) -> Cleaning | None:
        """The clean that it is on."""
        return self._job.cleaning

    @property
    def queue(self) -> tuple[str, ...]:
        """The rooms that its clean has still to do, the present one first."""
        return () if self.cleaning is None else self.cleaning.ledger.queue

    @property
    def queue_ways(self) -> tuple[RoomWay, ...]:
        """How each room of the :attr:`queue` is cleaned."""
        return () if self.cleaning is None else self.cleaning.ledger.queue_ways

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

    @property
    def max_speed(self) -> float:
        """The robot's top speed, m/s."""
        return self._ticks.max_speed

    @max_speed.setter
    def max_speed(self, max_speed: float) -> None:
        self._ticks.max_speed = max_speed

    @property
    def carpet(self) -> CarpetSense:
        """Whether its brush is on carpet, by the current of its motor."""
        return self._ticks.carpet

    @property
    def carpets(self) -> CarpetVotes:
        """Where it felt carpets, over all runs."""
        return self._ticks.carpets

    @property
    def is_on_carpet(self) -> bool:
        """Whether it is on carpet, by the brush's motor or by what is drawn on the map."""
        return self.carpet.is_on or self.context.is_on_carpet(*self.last_place)

    @property
    def last(self) -> Senses:
        """What it sensed at the last tick."""
        return self._ticks.last

    @property
    def last_place(self) -> tuple[float, float]:
        """Where it was at the last tick, m."""
        return self._ticks.last_place

    @property
    def sweeps(self) -> bool:
        """Whether what it drives over counts as cleaned."""
        return self._ticks.sweeps

    def speed_limit(self, senses: Senses) -> float:
        """Return how fast it goes now, m/s."""
        return self._ticks.speed_limit(senses)

    def seconds_to_go(self) -> float:
        """Return about how long the clean still takes, s of robot time; charging left out.

        While the robot charges, waits or is paused, that is the time for what comes afterwards.
        Once the floor is done and the robot is on its way home, it is 0.
        """
        if self.cleaning is None or self.state.errand is Errand.HOME:
            return 0.0
        driving = 0.0 if self.driver is None else self.driver.left
        if self.state.errand is Errand.CLEAN and self.state.phase is not Phase.EXPLORING:
            driving = max(driving, self.cleaning.ledger.left / self.context.tool_width)
        speed = min(self._config.driving.speed, self.max_speed)
        return driving / (self._config.driving.mean_speed * speed)

    def tick(self, senses: Senses) -> MissionStep:
        """Return what is wanted now."""
        return self._ticks.tick(senses)

    def steady(self, senses: Senses) -> Steady | None:
        """Return the steady ticks that come next; None if a usual tick must decide."""
        return self._ticks.steady(senses)

    def caught_up(self, senses: Senses, places: NDArray[np.float64], way: float) -> None:
        """Go on after steady ticks, the last of which began with these senses.

        They began at ``places``, float64 [n, 2], m; ``way`` m were driven from the tick before the
        first of them to the last.
        """
        self._ticks.caught_up(senses, places, way)
