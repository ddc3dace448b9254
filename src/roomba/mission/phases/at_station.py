"""The phases at the station: undocking, docking, and charging."""

from __future__ import annotations

from roomba.configuration.docking import DockingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.cleaning.request import CleanOutcome
from roomba.mission.docking.docking import Docking, DockSenses, DockState
from roomba.mission.docking.expected_time import RobotTime
from roomba.mission.docking.undocking import Undocking, UndockState
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import Failure, PhaseStep


class AtStation:
    """One phase at a time; :meth:`forget` when it is over."""

    def __init__(self, config: DockingConfig, robot: RobotConfig) -> None:
        """Begin with none."""
        self._config, self._robot = config, robot
        self.forget()

    def forget(self) -> None:
        """Leave what was under way: it begins anew next time."""
        self._docking: Docking | None = None
        self._undocking: Undocking | None = None
        self._stood: RobotTime | None = None
        self._needed: float | None = None

    def undock(self, senses: Senses, station: Pose, stand_first: float = 0.0) -> PhaseStep:
        """Drive out of the station; if docked, after it stood there for ``stand_first`` s."""
        self._stood = self._stood or RobotTime(senses.now)
        self._stood.tick(senses.now)
        is_in = senses.battery.is_docked and self._undocking is None
        if is_in and self._stood.elapsed < stand_first:
            return PhaseStep()
        sensed = _dock_senses(senses)
        if self._undocking is None:
            self._undocking = Undocking(self._config, station, sensed)
        step = self._undocking.tick(sensed)
        if step.state is UndockState.OUT:
            return PhaseStep(step.twist, Event.OUT)
        if step.state is UndockState.FAILED:
            return PhaseStep(step.twist, failure=Failure(CleanOutcome.STUCK, step.reason))
        return PhaseStep(step.twist)

    def dock(self, senses: Senses, station: Pose) -> PhaseStep:
        """Drive into the station."""
        sensed = _dock_senses(senses)
        if self._docking is None:
            robot = self._robot
            self._docking = Docking(self._config, robot.body, robot.station, station, sensed)
        step = self._docking.tick(sensed)
        if step.state is DockState.DOCKED:
            return PhaseStep(step.twist, Event.CONTACT)
        if step.state is DockState.FAILED:
            return PhaseStep(step.twist, failure=Failure(CleanOutcome.NOT_DOCKED, step.reason))
        return PhaseStep(step.twist)

    @property
    def needed(self) -> float | None:
        """The energy, Wh, that the rest of the job takes, while it charges for that."""
        return self._needed

    def charge(self, senses: Senses, job: Job, tool_width: float) -> PhaseStep:
        """Stand until there is enough for the rest of the job, and room in the dust bin."""
        if not senses.battery.is_docked:
            return PhaseStep(event=Event.CONTACT_LOST)
        if job.bin.is_full:
            return PhaseStep(event=Event.BIN_FULL)
        if self._needed is None:
            self._needed = job.needed_energy(tool_width)
        is_charged = job.ledger.is_charged(senses, self._needed)
        return PhaseStep(event=Event.CHARGED if is_charged else None)


def _dock_senses(senses: Senses) -> DockSenses:
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
