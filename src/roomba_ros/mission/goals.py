"""The goals of clean, dock, undock and explore.

How each begins, what it tells on the way, and how it ends.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

from roomba_robot.msg import (
    CleanAction,
    DockAction,
    DockFeedback,
    DockResult,
    ExploreAction,
    ExploreFeedback,
    UndockAction,
    UndockFeedback,
    UndockResult,
    VacuumState,
)
from roomba_robot.msg import CleanResult as CleanResultMessage
from roomba_robot.msg import ExploreResult as ExploreResultMessage

from roomba.clean_request import CleanRequest
from roomba.grid import OccupancyMap
from roomba.mission.cleaning.result import CleanOutcome, CleanResult
from roomba.mission.commands import CommandRefusedError
from roomba.mission.exploring.exploration import ExploreResult
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Errand, Event
from roomba_ros.convert.clean_action import (
    explored_message,
    feedback_message,
    request_of,
    result_message,
)
from roomba_ros.runtime.action_goal import ActionGoal

_MAP_IS_WHOLE = (
    "there is nothing to explore: expected a map that is being made, got a whole one; "
    "to make one anew start the robot with map:=none"
)


@dataclass(frozen=True, slots=True)
class Ended:
    """The result of a clean or an exploration that has just ended, if one has."""

    clean: CleanResult | None = None
    exploration: ExploreResult | None = None

    @classmethod
    def taken_from(cls, mission: Mission) -> Ended:
        """Take the results of a mission, which tells each of them once."""
        return cls(mission.take_result(), mission.take_exploration())


class MissionGoal(ActionGoal):
    """One thing that the mission is to do."""

    def check(self) -> None:
        """Check the goal's message; most goals hold nothing to check."""

    @abstractmethod
    def begin(self, mission: Mission, senses: Senses) -> None:
        """Let the mission do it; raises RoombaError with the reason why not."""

    @abstractmethod
    def follow(self, mission: Mission, senses: Senses, ended: Ended) -> bool:
        """Tell its end if it has ended, and return that."""

    @abstractmethod
    def tell(self, state: VacuumState) -> None:
        """Tell how far it is."""

    @abstractmethod
    def _result(self, message: str) -> Any:
        """Return the action's result for an errand that was not done; ``message`` says why."""

    def accept(self) -> None:
        """Tell that it has begun."""
        self._handle.set_accepted()

    def reject(self, reason: str) -> None:
        """Tell why it is not begun."""
        self._handle.set_rejected(self._result(reason), reason)

    def _tell_end(self, outcome: CleanOutcome, message: Any, text: str) -> None:
        """Tell how it ended."""
        if outcome is CleanOutcome.COMPLETED:
            self._handle.set_succeeded(message, text)
        elif outcome is CleanOutcome.STOPPED:
            self._handle.set_canceled(message, text)
        else:
            self._handle.set_aborted(message, text)

    def stopped(self, ended: Ended, reason: str) -> None:
        """Tell that a command ended it."""
        self._handle.set_canceled(self._result(reason), reason)

    def given_up(self, reason: str) -> None:
        """Tell why it failed."""
        self._handle.set_aborted(self._result(reason), reason)


class CleaningGoal(MissionGoal):
    """Clean floor."""

    name, action = "clean", CleanAction

    _request: CleanRequest

    def check(self) -> None:
        """Take the request; raise MessageError if it makes no sense."""
        self._request = request_of(self._handle.get_goal())

    def begin(self, mission: Mission, senses: Senses) -> None:
        """Let the mission clean."""
        mission.clean(self._request, senses)

    def follow(self, mission: Mission, senses: Senses, ended: Ended) -> bool:
        """Tell its end if there is a result."""
        result = ended.clean
        if result is None:
            return False
        message = result_message(result)
        text = result.message or result.outcome.value
        self._tell_end(result.outcome, message, text)
        return True

    def stopped(self, ended: Ended, reason: str) -> None:
        """Tell that a command ended it, and what it achieved."""
        result = ended.clean
        message = self._result(reason) if result is None else result_message(result)
        self._handle.set_canceled(message, reason)

    def tell(self, state: VacuumState) -> None:
        """Tell how much is clean."""
        self._handle.publish_feedback(feedback_message(state))

    def _result(self, message: str) -> CleanResultMessage:
        return CleanResultMessage(outcome=CleanResultMessage.STOPPED, message=message)


class StationGoal(MissionGoal):
    """A way into the station, or out of it."""

    _errand: ClassVar[Errand]
    _command: ClassVar[Event]

    def begin(self, mission: Mission, senses: Senses) -> None:
        """Let the mission drive there."""
        mission.command(self._command, senses)

    def follow(self, mission: Mission, senses: Senses, ended: Ended) -> bool:
        """Tell its end if the robot is there, or does not get there."""
        outcome = mission.way_ended(self._errand)
        if outcome is None:
            return False
        if outcome is CleanOutcome.FAULT:
            self.given_up(mission.message)
        elif outcome is CleanOutcome.STOPPED:
            self.stopped(ended, "it was stopped")
        else:
            self._arrived()
        return True

    @abstractmethod
    def _arrived(self) -> None:
        """Tell that it is there."""


class DockingGoal(StationGoal):
    """Go to the station."""

    name, action = "dock", DockAction
    _errand, _command = Errand.DOCK, Event.DOCK

    def _arrived(self) -> None:
        self._handle.set_succeeded(DockResult(True, ""), "docked")

    def tell(self, state: VacuumState) -> None:
        """Tell whether it drives there or is about to touch it."""
        self._handle.publish_feedback(DockFeedback(state.phase))

    def _result(self, message: str) -> DockResult:
        return DockResult(False, message)


class UndockingGoal(StationGoal):
    """Back out of the station."""

    name, action = "undock", UndockAction
    _errand, _command = Errand.UNDOCK, Event.UNDOCK

    def _arrived(self) -> None:
        self._handle.set_succeeded(UndockResult(True, ""), "out of the station")

    def tell(self, state: VacuumState) -> None:
        """Tell what it does."""
        self._handle.publish_feedback(UndockFeedback(state.phase))

    def _result(self, message: str) -> UndockResult:
        return UndockResult(False, message)


class ExploringGoal(MissionGoal):
    """Look at what the map does not show yet."""

    name, action = "explore", ExploreAction

    def __init__(self, handle: Any) -> None:
        """Take the goal's handle."""
        super().__init__(handle)
        self._known = 0.0
        self._looked_at: OccupancyMap | None = None

    def begin(self, mission: Mission, senses: Senses) -> None:
        """Let the mission explore."""
        if not mission.context.is_growing:
            raise CommandRefusedError(_MAP_IS_WHOLE)
        mission.explore(senses)
        self._look_at(mission)

    def follow(self, mission: Mission, senses: Senses, ended: Ended) -> bool:
        """Tell its end if there is a result."""
        self._look_at(mission)
        explored = ended.exploration
        if explored is None:
            return False
        message = explored_message(explored)
        text = explored.message or explored.outcome.value
        self._tell_end(explored.outcome, message, text)
        return True

    def stopped(self, ended: Ended, reason: str) -> None:
        """Tell that a command ended it, and what it achieved."""
        explored = ended.exploration
        message = self._result(reason) if explored is None else explored_message(explored)
        self._handle.set_canceled(message, reason)

    def tell(self, state: VacuumState) -> None:
        """Tell how much of the home is known."""
        self._handle.publish_feedback(ExploreFeedback(state.state, self._known, state.battery))

    def _look_at(self, mission: Mission) -> None:
        occupancy = mission.context.occupancy
        if mission.exploration is not None and occupancy is not self._looked_at:
            self._looked_at, self._known = occupancy, occupancy.free_area

    def _result(self, message: str) -> ExploreResultMessage:
        return ExploreResultMessage(
            outcome=ExploreResultMessage.STOPPED, message=message, known=self._known
        )


GOALS: tuple[type[MissionGoal], ...] = (CleaningGoal, DockingGoal, UndockingGoal, ExploringGoal)
"""All kinds of them."""
