"""The state of a mission, and what leads from one state to the next."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.at_station import AtStation
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Errand, Event, MissionState, next_state
from roomba.vocabulary import NO_REASON, Hindrance, Phase, Reason

BIN_FULL: Final = Reason(
    "bin full: empty the dust bin, and tell the robot (empty_bin)", Hindrance.BIN_FULL
)
RELEASED: Final = Reason(
    "the emergency stop was released: it waits to be told to go on, or to stop",
    Hindrance.STOP_RELEASED,
)
"""Why a job that an emergency stop interrupted does not go on."""


class Transitions:
    """Keeps the ``state``, and the ``reason`` why the robot does not do what was asked.

    ``last_command`` is the last one that was obeyed, None before the first. What belongs to a phase
    ends with it.
    """

    def __init__(
        self,
        state: MissionState,
        job: Job,
        drives: Drives,
        obstacles: Obstacles,
        at_station: AtStation,
        retries: RetryPolicy,
    ) -> None:
        """Begin in a state, without a reason."""
        self.state, self.reason = state, NO_REASON
        self.last_command: Event | None = None
        self._job, self._drives, self._obstacles = job, drives, obstacles
        self._at_station, self._retries = at_station, retries

    @property
    def told(self) -> Reason:
        """The reason that is told; empty when all is well."""
        if not self._job.bin.is_full:
            return self.reason
        if self.reason.hindrance is Hindrance.STOP_RELEASED:
            return replace(BIN_FULL, text=f"{BIN_FULL.text}; {self.reason.text}")
        return self.reason or BIN_FULL

    def go(self, event: Event, senses: Senses) -> None:
        """Let an event change the state; what belonged to the old phase ends."""
        after = next_state(self.state, event)
        if after is None:
            return
        if event.is_command:
            self.last_command = event
        if after == self.state:
            return
        before, self.state = self.state, after
        self.drop_driver()
        self._at_station.forget()
        if event is not Event.FAILED:
            self.reason = NO_REASON
        if event in (Event.RESUME, Event.BEAMS_SEEN):
            self._retries.renew()
            self._job.take_up()
        if event is Event.FINISHED:
            self._job.outcome = CleanOutcome.COMPLETED
        if after.phase is Phase.DOCKED:
            self._retries.renew()
            if before.errand in (Errand.HOME, Errand.CLEAN) and before.phase is not Phase.EMPTYING:
                self.end_job_at_station(senses)

    def clean_on(self) -> None:
        """Go on with a clean that was done, on its way home: there is more of it again."""
        after = next_state(self.state, Event.MORE)
        if after is not None:
            self.state, self.reason, self._job.outcome = after, NO_REASON, None
            self.drop_driver()

    def fail(self, outcome: CleanOutcome, reason: str, senses: Senses) -> None:
        """Go no further, for a reason."""
        self.go(Event.FAILED, senses)
        self.reason = Reason(reason)
        self.end_job(outcome, reason, senses)

    def end_job(self, outcome: CleanOutcome, message: str, senses: Senses) -> None:
        """Tell the result of the job under way, if there is one; after an error it can go on."""
        can_go_on = self.state.phase is Phase.ERROR
        context = self._drives.context
        self._job.end(outcome, message, context, self._obstacles, senses, can_go_on=can_go_on)

    def end_job_at_station(self, senses: Senses) -> None:
        """Tell the result of the job that was under way when the robot came to its station."""
        self.end_job(self._job.outcome or CleanOutcome.STOPPED, "", senses)

    def drop_driver(self) -> None:
        """Drop the present path; what was not driven of a round is planned again."""
        drives, cleaning = self._drives, self._job.cleaning
        if drives.driver is not None and cleaning is not None and drives.is_round:
            cleaning.interrupted(drives.driver.rest)
        drives.driver = None
