"""What is checked at each tick: contact with the station, and what holds the robot up."""

from __future__ import annotations

from roomba.clock import RobotTime
from roomba.configuration.loops import WalkConfig
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.search_patience import SearchPatience
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.energy import EnergyLedger
from roomba.mission.phases.machine import MissionState
from roomba.mission.phases.step import Failure
from roomba.vocabulary import Phase


class Monitor:
    """Looks at every tick; ``was_docked`` is whether the station's contact was there before."""

    def __init__(
        self, config: WalkConfig, drives: Drives, ledger: EnergyLedger, senses: Senses
    ) -> None:
        """Begin where the robot stands, knowing its place."""
        self._config, self._drives, self._ledger = config, drives, ledger
        self.was_docked = senses.battery.is_docked
        self._astray: RobotTime | None = None
        self._patience = SearchPatience(config, senses.knowledge)
        self._hanging: RobotTime | None = None
        self._known_at = (senses.pose.x, senses.pose.y)

    @property
    def is_astray(self) -> bool:
        """Whether the robot does not know its place."""
        return self._astray is not None

    def note_contact(self, senses: Senses) -> bool:
        """Note whether the station's contact is there; return whether it came or went."""
        changed = senses.battery.is_docked != self.was_docked
        self.was_docked = senses.battery.is_docked
        return changed

    def failure(
        self, state: MissionState, senses: Senses, last_place: tuple[float, float]
    ) -> Failure | None:
        """Return what ends a drive; ``last_place``, m, is where the robot was a tick before."""
        if not state.drives:
            self._astray = self._hanging = None
            self._patience.begin(senses.knowledge)
            return None
        if senses.lifted:
            self._drives.obstacles.forget_edges_felt_now(senses.now)
        if self._hangs_for_long(senses) or senses.lifted:
            reason = "a wheel hangs in the air: set it down and resume"
            return Failure(CleanOutcome.FAULT, reason)
        if self._ledger.is_empty(senses) and not senses.battery.is_docked:
            reason = "the battery is empty: carry it to its station"
            return Failure(CleanOutcome.BATTERY, reason)
        # Docking finds its way by the station's beams.
        return None if state.phase is Phase.DOCKING else self._lost(senses, last_place)

    def _hangs_for_long(self, senses: Senses) -> bool:
        """Whether a wheel hangs in the air for longer than at a sill."""
        if not senses.wheel_hangs:
            self._hanging = None
            return False
        if self._hanging is None:
            self._hanging = RobotTime(senses.now)
        self._hanging.tick(senses.now)
        return self._hanging.elapsed > self._config.hanging_wheel

    def _lost(self, senses: Senses, last_place: tuple[float, float]) -> Failure | None:
        if senses.knowledge.is_usable:
            self._patience.begin(senses.knowledge)
            if self.is_astray:
                self._found_again(senses)
            return None
        if self._astray is None:
            self._astray = RobotTime(senses.now)
            self._known_at = last_place
        self._astray.tick(senses.now)
        if self._patience.is_over(senses.knowledge, self._astray.elapsed):
            reason = f"the robot does not know where it is: {senses.trouble}"
            return Failure(CleanOutcome.LOST, reason)
        return None

    def _found_again(self, senses: Senses) -> None:
        self._astray = None
        if senses.pose.distance_to(*self._known_at) > self._config.carried:
            # It was carried, or wrong before.
            self._drives.forget_place()
