"""The present job, a clean or an exploration: its ledgers, and the result at its end."""

from __future__ import annotations

import math
from typing import Final

from roomba.clean_request import CleanRequest
from roomba.clock import LONGEST_TICK
from roomba.configuration.mission import MissionConfig
from roomba.grid import OccupancyMap
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.missed import what_is_not_clean
from roomba.mission.cleaning.result import CleanOutcome, CleanResult
from roomba.mission.cleaning.room_dirt import dirt_of_rooms
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.exploring.exploration import Exploration, ExploreResult
from roomba.mission.exploring.open_edges import what_is_not_seen
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.dust_bin import DustBin
from roomba.mission.phases.energy import ChargeGains, EnergyLedger
from roomba.mission.phases.time_ledger import TimeLedger
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import OpenEdge

_TOO_FAR: Final = (
    "what is left is too far from the station: charge after charge went into the ways alone"
)
_DOUBTFUL: Final = 0.05
"""Share of the way; where the place was known only roughly on more of it, that is told."""


class Job:
    """``cleaning`` or ``exploration`` is under way, or both on a map that is being made, or none.

    ``outcome`` is how it will be told. ``bin`` is the dust bin, which it fills.

    Times are s of the robot's clock.
    """

    def __init__(
        self,
        dirt: DirtMap,
        config: MissionConfig,
        bin_capacity: float,
        senses: Senses,
        known_deviation: float = 0.0,
    ) -> None:
        """Begin with nothing to do, and with a dust bin that takes ``bin_capacity`` g.

        What is swept while the place is unsure by more than ``known_deviation``, m, is doubtful.
        """
        self.dirt, self._config = dirt, config
        self.cleaning: Cleaning | None = None
        self.exploration: Exploration | None = None
        self.outcome: CleanOutcome | None = None
        self.ledger = EnergyLedger(config.energy, senses)
        self.times = TimeLedger()
        self.bin = DustBin(config.bin, bin_capacity)
        self._known_deviation = known_deviation
        self._started = senses.now
        self._is_told = False
        self._cleaned: CleanResult | None = None
        self._explored: ExploreResult | None = None
        self._gains, self._is_too_far = ChargeGains(self._config.energy), False
        self.open_edges: tuple[OpenEdge, ...] = ()
        """Where the map was still open when there was nothing left to look for."""
        self.rough_way = 0.0
        """m that were driven while the robot swept and its place was known only roughly."""

    def cleaning_of(
        self, request: CleanRequest, context: PlanningContext, senses: Senses
    ) -> Cleaning:
        """Return the clean of a request, begun here; raises CleanRefusedError."""
        return Cleaning(request, context, self.dirt, self._config.cleaning, senses.pose)

    def begin_clean(self, cleaning: Cleaning, senses: Senses) -> None:
        """Begin a clean, with new ledgers; if it explores, it does so on the way."""
        self.cleaning = cleaning
        self.exploration = Exploration(self._config.exploring) if cleaning.explores else None
        self._begin(senses)

    def begin_exploration(self, senses: Senses) -> None:
        """Begin an exploration, with new ledgers."""
        self.exploration, self._explored = Exploration(self._config.exploring), None
        self._begin(senses)

    def _begin(self, senses: Senses) -> None:
        self.outcome, self._is_told, self.open_edges = None, False, ()
        self._gains, self._is_too_far = ChargeGains(self._config.energy), False
        self.rough_way = 0.0
        self.ledger.begin(senses)
        self.times.begin()
        self._started = senses.now

    def look_no_more(self, known: OccupancyMap) -> None:
        """On the whole map, as it is ``known``, a clean has nothing left to look for."""
        if self.exploration is None or self.cleaning is None or self.cleaning.explores:
            return
        self.open_edges = self.exploration.open_edges(known)
        self.exploration = None

    def take_up(self) -> None:
        """Go on after its result was told: it will have another one."""
        self._is_told = False

    def duration(self, now: float) -> float:
        """Return how long it has been under way, s."""
        return now - self._started

    def goes_on_after(self, duration: float, senses: Senses) -> None:
        """Go on with a job that has been under way for so long already, s."""
        self._is_told = False
        self.ledger.begin(senses)
        self._started = senses.now - duration

    def account(self, senses: Senses, last: Senses, *, drives: bool, sweeps: bool) -> None:
        """Keep the ledgers: energy, way, floor swept, dirt met."""
        self.ledger.note(senses, drives=drives)
        passed = senses.now - last.now
        if not 0.0 <= passed <= LONGEST_TICK:
            self._started += passed
        self.look_at_bin(senses)
        if self.cleaning is None:
            return
        # A full bin takes nothing up.
        sweeps = sweeps and not self.bin.is_full
        if not (sweeps and senses.knowledge.is_usable):
            self.cleaning.ledger.coverage.lift()
            return
        pose = senses.pose
        way = pose.distance_to(last.pose.x, last.pose.y)
        elapsed = min(max(passed, 0.0), LONGEST_TICK)
        coverage = self.cleaning.ledger.coverage
        swept = coverage.swept_cells
        coverage.sweep(pose.x, pose.y)
        if senses.knowledge is Knowledge.ROUGH and senses.unsure > self._known_deviation:
            # A lidar that is slow, or a home that changed, alone says nothing against the place.
            self.rough_way += way
        self.bin.note(pose.x, pose.y, senses.grains, way, coverage.swept_cells - swept)
        self.dirt.note(pose.x, pose.y, senses.grains * elapsed, way)

    def look_at_bin(self, senses: Senses) -> None:
        """Find out whether the bin is full; what was swept in vain is not clean."""
        cell = 0.0 if self.cleaning is None else self.cleaning.ledger.coverage.cell_area
        if self.bin.look(senses.in_bin, cell, self.dirt.usual) and self.cleaning is not None:
            self.cleaning.ledger.coverage.take_back(self.bin.swept_in_vain())

    def note_charge(self, known: float) -> bool:
        """Note that the robot goes home to charge; return whether charges take the job no further.

        ``known`` is the floor on the map, m2. What is left is then too far from the station.
        """
        done = 0.0 if self.cleaning is None else self.cleaning.ledger.clean_area
        left = 0.0 if self.cleaning is None else self.cleaning.ledger.left
        self._is_too_far = self._gains.note_charge(done, -left, known)
        return self._is_too_far

    def needed_energy(self, tool_width: float) -> float:
        """Return the energy that the rest takes, Wh; infinite, as unknown, for an exploration."""
        if self.exploration is not None:
            return math.inf
        if self.cleaning is None:
            return 0.0
        # Behind a few patches that are still missed there may be a long way.
        way = max(self.cleaning.ledger.left / tool_width, self.cleaning.broken_off)
        return self.ledger.per_metre * self._config.cleaning.detours * way

    def end(
        self,
        outcome: CleanOutcome,
        message: str,
        context: PlanningContext,
        obstacles: Obstacles,
        senses: Senses,
        *,
        can_go_on: bool,
    ) -> None:
        """Make its result, unless that was told before; forget it, unless it can be resumed."""
        if not self._is_told:
            self._tell(outcome, message, context, obstacles, senses)
        if not can_go_on:
            self.forget()

    def _tell(
        self,
        outcome: CleanOutcome,
        message: str,
        context: PlanningContext,
        obstacles: Obstacles,
        senses: Senses,
    ) -> None:
        """Make the result of what is under way, if there is something."""
        if self.cleaning is not None:
            self._cleaned = self._clean_result(
                self.cleaning, outcome, message, context, obstacles, senses
            )
        elif self.exploration is not None:
            edges = self.exploration.open_edges(context.known)
            if outcome is CleanOutcome.COMPLETED:
                too_far = _TOO_FAR if self._is_too_far else ""
                message = message or "; ".join(filter(None, (what_is_not_seen(edges), too_far)))
            self._explored = ExploreResult(
                outcome,
                message,
                context.occupancy.free_area,
                self.ledger.distance,
                self.duration(senses.now),
                self.exploration.still_unseen(context.known),
                edges,
            )
        self._is_told = True

    def _clean_result(
        self,
        cleaning: Cleaning,
        outcome: CleanOutcome,
        message: str,
        context: PlanningContext,
        obstacles: Obstacles,
        senses: Senses,
    ) -> CleanResult:
        missed = cleaning.missed(
            obstacles.standing(senses.now), cleaning.ledger.stage is None, obstacles.edges()
        )
        wanted, covered = cleaning.ledger.coverage.wanted_area, cleaning.ledger.clean_area
        if outcome is CleanOutcome.COMPLETED:
            reasons = (
                message or what_is_not_clean(wanted, covered, missed),
                _TOO_FAR if self._is_too_far else "",
                what_is_not_seen(self.open_edges),
                self._what_is_doubtful(),
            )
            message = "; ".join(filter(None, reasons))
        return CleanResult(
            outcome,
            message,
            wanted,
            covered,
            dirt=self.ledger.dirt,
            distance=self.ledger.distance,
            duration=self.duration(senses.now),
            energy=self.ledger.energy,
            missed=missed,
            times=self.times.spent(cleaning.mean_passes * covered, context.tool_width),
            rooms=dirt_of_rooms(cleaning.ledger.clean, context, self.dirt),
            open_edges=self.open_edges,
        )

    def _what_is_doubtful(self) -> str:
        """Return on how much of its way it swept by a place that was not well known."""
        way = self.ledger.distance
        if self.rough_way <= _DOUBTFUL * way:
            return ""
        return (
            f"on {self.rough_way:.0f} of {way:.0f} m of way its place was known roughly: what "
            "counts as clean there may be other floor"
        )

    def forget(self) -> None:
        """End the job for good."""
        self.exploration = None
        if self.cleaning is not None:
            self.cleaning = None
            self.dirt.end_run()

    def take_result(self) -> CleanResult | None:
        """Return the result of a clean that ended, once."""
        result, self._cleaned = self._cleaned, None
        return result

    def take_exploration(self) -> ExploreResult | None:
        """Return the result of an exploration that ended, once."""
        result, self._explored = self._explored, None
        return result
