"""The phases at the station: undocking, docking, charging, and emptying the bin."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from roomba.clock import RobotTime
from roomba.configuration.docking import DockingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.docking.beams import NO_BEAMS
from roomba.mission.docking.docking import Docking, DockSenses, DockState, DockStep
from roomba.mission.docking.undocking import Undocking, UndockState, stands_in
from roomba.mission.inputs.senses import EmptyingTold, Senses
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import Failure, PhaseStep
from roomba.vocabulary import NO_REASON, Hindrance, Reason

_NO_ANSWER: Final = "its station does not empty the bin: see whether its way in is free"
_CHARGES_FIRST: Final = "the battery is empty: it stays on its station to charge"
_AWAITS_BEAMS: Final = "; left standing, it docks by itself as soon as it sees the beams"
_NO_CURRENT: Final = "its station gives no current: see that it is plugged in; it waits for that"


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
        self._without_current: RobotTime | None = None
        self._without_beams: RobotTime | None = None
        self._gave_up_at = Pose()
        self._needed: float | None = None
        self._is_emptied = False

    def undock(
        self, senses: Senses, station: Pose, stand_first: float = 0.0, *, is_empty: bool = False
    ) -> PhaseStep:
        """Drive out of the station; if docked, after it stood there for ``stand_first`` s.

        With a battery that ``is_empty`` it stays there to charge.
        """
        self._stood = self._stood or RobotTime(senses.now)
        self._stood.tick(senses.now)
        is_in = senses.battery.is_docked and self._undocking is None
        if is_in and is_empty:
            return PhaseStep(event=Event.CONTACT, reason=Reason(_CHARGES_FIRST))
        if is_in and self._stood.elapsed < stand_first:
            return PhaseStep()
        sensed = self._sensed(senses)
        if self._undocking is None:
            self._undocking = Undocking(self._config, station, sensed)
        step = self._undocking.tick(sensed)
        twist = self._as_wanted(step.twist)
        if step.state is UndockState.OUT:
            return PhaseStep(twist, Event.OUT)
        if step.state is UndockState.FAILED:
            return PhaseStep(twist, failure=Failure(CleanOutcome.STUCK, step.reason))
        return PhaseStep(twist)

    def dock(self, senses: Senses, station: Pose, staging: Pose) -> PhaseStep:
        """Drive into the station from the place before it, ``staging``; both map frame."""
        sensed = self._sensed(senses)
        if self._is_turned:
            # The bumper is at its other side: what it meets is not the station.
            sensed = replace(sensed, bumper_left=False, bumper_right=False)
        if self._docking is None:
            robot, far = self._robot, station.distance_to(staging.x, staging.y)
            config = self._config.model_copy(update={"staging_distance": far})
            self._docking = Docking(config, robot.body, robot.station, station, sensed)
        step = self._docking.tick(sensed)
        twist = self._as_wanted(step.twist)
        if step.state is DockState.DOCKED:
            return PhaseStep(twist, Event.CONTACT)
        if step.state is DockState.FAILED:
            return PhaseStep(twist, failure=_not_docked(step))
        return PhaseStep(twist)

    def await_beams(self, senses: Senses) -> None:
        """Look for the station's beams from now on: for want of them it did not dock."""
        self._without_beams, self._gave_up_at = RobotTime(senses.now), senses.pose

    def look_for_beams(self, senses: Senses) -> PhaseStep:
        """Stand until the beams that it awaits are seen for a while.

        A robot that was moved meanwhile, by hand or by a walk, waits for them no longer.
        """
        if self._gave_up_at.distance_to(senses.pose.x, senses.pose.y) > self._config.left_standing:
            self._without_beams = None
        if self._without_beams is None:
            return PhaseStep()
        if senses.beams == NO_BEAMS or senses.wheel_hangs:
            self._without_beams = RobotTime(senses.now)
        self._without_beams.tick(senses.now)
        are_seen = self._without_beams.elapsed > self._config.contact_wait
        return PhaseStep(event=Event.BEAMS_SEEN if are_seen else None)

    @property
    def _is_turned(self) -> bool:
        """Whether the robot docks backwards.

        Docking and undocking assume that its nose faces the station: they are told the pose turned
        about.
        """
        return self._robot.body.docks_backwards

    def _sensed(self, senses: Senses) -> DockSenses:
        sensed = _dock_senses(senses)
        return replace(sensed, pose=self._robot.body.docked_at(sensed.pose))

    def _as_wanted(self, twist: Twist) -> Twist:
        """Return what is to be driven when docking wants a twist."""
        return Twist(-twist.linear, twist.angular) if self._is_turned else twist

    @property
    def needed(self) -> float | None:
        """The energy, Wh, that the rest of the job takes, while it charges for that."""
        return self._needed if self._without_current is None else None

    def charge(self, senses: Senses, job: Job, tool_width: float, station: Pose) -> PhaseStep:
        """Stand until there is enough for the rest of the job, and room in the dust bin."""
        if (waits := self._wait_for_current(senses, station)) is not None:
            return waits
        if job.bin.is_full:
            return PhaseStep(event=Event.BIN_FULL)
        if self._needed is None:
            self._needed = job.needed_energy(tool_width)
        is_charged = job.ledger.is_charged(senses, self._needed)
        return PhaseStep(event=Event.CHARGED if is_charged else None)

    def empty(self, senses: Senses, job: Job, station: Pose) -> PhaseStep:
        """Stand until the station has taken the dirt out of the bin."""
        if (waits := self._wait_for_current(senses, station)) is not None:
            return waits
        self._stood = self._stood or RobotTime(senses.now)
        self._stood.tick(senses.now)
        told = senses.emptying
        if told is not None and told.is_at_work:
            self._is_emptied = True
        elif self._is_emptied:
            job.bin.emptied()
            return PhaseStep(event=Event.EMPTIED)
        elif reason := why_not_emptied(told):
            return _not_emptied(reason)
        elif self._stood.elapsed > self._config.emptying_timeout:
            return _not_emptied(_NO_ANSWER)
        return PhaseStep(empties=True)

    def _wait_for_current(self, senses: Senses, station: Pose) -> PhaseStep | None:
        """Stand in a station without power until current comes; None where it comes.

        A robot that was moved has lost contact and docks anew. So has one that sees the beams of
        its station for a while, but gets no current from it.
        """
        if senses.battery.is_docked:
            was_without, self._without_current = self._without_current, None
            return None if was_without is None else PhaseStep(reason=NO_REASON)
        sensed = self._sensed(senses)
        if self._without_current is None or sensed.beams == NO_BEAMS:
            self._without_current = RobotTime(senses.now)
        self._without_current.tick(senses.now)
        has_power = self._without_current.elapsed > self._config.contact_wait
        if has_power or not stands_in(station, sensed, self._config):
            return PhaseStep(event=Event.CONTACT_LOST)
        return PhaseStep(reason=Reason(_NO_CURRENT))


def _not_docked(step: DockStep) -> Failure:
    outcome = CleanOutcome.NOT_DOCKED
    if step.trouble is None or not step.trouble.may_end_with_beams:
        return Failure(outcome, step.reason)
    return Failure(outcome, f"{step.reason}{_AWAITS_BEAMS}", awaits_beams=True)


def _not_emptied(why: str) -> PhaseStep:
    return PhaseStep(event=Event.FAILED, reason=Reason(why, Hindrance.NOT_EMPTIED))


def why_not_emptied(told: EmptyingTold | None) -> str:
    """Return why the station empties no bin; empty if it does."""
    if told is None:
        return "its station empties no bin: empty it by hand"
    return "the bag of its station is full: put an empty one in" if told.bag >= 1.0 else ""


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
