"""Orders for the mission: how each is obeyed or refused, and the goal under way."""

from __future__ import annotations

import queue
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar, Final

import rospy

from roomba.errors import RoombaError
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Event
from roomba.vocabulary import OVERTAKEN, RoomWay, listed
from roomba_ros.mission.goals import Ended, MissionGoal
from roomba_ros.runtime.action_goal import GoalIdentity

_DONE: Final = {
    Event.PAUSE: "paused",
    Event.RESUME: "going on",
    Event.STOP: "stopped",
    Event.EMPTIED: "the bin counts as empty now",
    Event.EMPTY: "its station empties the bin",
}
_STANDS: Final = (Event.STOP, Event.PAUSE)
"""Commands after which the robot stands."""


class GoalUnderWay:
    """One goal at a time: a newer one of any action takes over.

    ``goal`` is that of the errand under way, None if no client gave it. ``waiting`` are orders that
    may not begin yet.
    """

    def __init__(self, takes_drive: Callable[[], None]) -> None:
        """Begin without one; ``takes_drive`` is called when the mission is about to drive."""
        self._takes_drive = takes_drive
        self.goal: MissionGoal | None = None
        self.waiting: list[Order] = []
        self._answers: list[Callable[[], object]] = []

    def take_over(self, goal: MissionGoal, mission: Mission) -> None:
        """Be at a goal that the mission has just begun."""
        old, self.goal = self.goal, goal
        # Results of the errand before; none is awaited of one that was resumed after an error.
        ended = Ended.taken_from(mission)
        if old is not None:
            self.later(partial(old.stopped, ended, OVERTAKEN))
        goal.accept()
        self._takes_drive()

    def command(self, event: Event, mission: Mission, senses: Senses) -> tuple[bool, str]:
        """Let the mission obey a command; return whether it does, and what came of it."""
        try:
            mission.command(event, senses)
        except RoombaError as error:
            return False, str(error)
        if event is Event.STOP:
            self._end_stopped(mission)
        elif event is Event.RESUME:
            self._takes_drive()
        return True, _DONE.get(event, event.value)

    def recall(self, reason: str) -> bool:
        """Cancel the orders that wait; return whether any waited."""
        recalled = tuple(self.waiting)
        self.waiting.clear()
        for order in recalled:
            order.recall(reason)
        return bool(recalled)

    def later(self, answer: Callable[[], object]) -> None:
        """Keep an answer until :meth:`answer` sends it."""
        self._answers.append(answer)

    def answer(self) -> None:
        """Send the answers to the orders that were obeyed."""
        answers, self._answers = self._answers, []
        for tell in answers:
            tell()

    def follow(self, mission: Mission, senses: Senses) -> Ended:
        """Report the goal's end, if it has ended; return the results, also those without a goal."""
        ended = Ended.taken_from(mission)
        if self.goal is not None and self.goal.follow(mission, senses, ended):
            self.goal = None
        return ended

    def give_up(self, reason: str) -> None:
        """End the goal, which is not reached."""
        goal, self.goal = self.goal, None
        if goal is not None:
            goal.given_up(reason)

    def _end_stopped(self, mission: Mission) -> None:
        goal, self.goal = self.goal, None
        ended = Ended.taken_from(mission)
        if goal is not None:
            self.later(partial(goal.stopped, ended, "it was told to stop"))


class Order(ABC):
    """Something that was asked of the mission."""

    waits: ClassVar[bool] = False
    """Whether the order waits while no new errand may begin."""

    @abstractmethod
    def obey(self, under_way: GoalUnderWay, mission: Mission, senses: Senses) -> None:
        """Let the mission obey; ``under_way`` sends the answer later."""

    @abstractmethod
    def refuse(self, reason: str) -> None:
        """Tell the client why the order is refused."""

    def recall(self, reason: str) -> None:
        """Tell the client why the order does not begin, though nothing was wrong with it."""
        self.refuse(reason)


@dataclass(frozen=True)
class GoalOrder(Order):
    """A goal of an action."""

    goal: MissionGoal
    waits: ClassVar[bool] = True

    def obey(self, under_way: GoalUnderWay, mission: Mission, senses: Senses) -> None:
        """Begin it, unless it was cancelled before."""
        if self.goal.is_recalled:
            self.recall("cancelled before it began")
            return
        try:
            self.goal.begin(mission, senses)
        except RoombaError as error:
            self.refuse(str(error))
            return
        under_way.take_over(self.goal, mission)

    def refuse(self, reason: str) -> None:
        """Reject it, and log that."""
        rospy.logwarn("goal of %s rejected: %s", self.goal.name, reason)
        self.goal.reject(reason)

    def recall(self, reason: str) -> None:
        """Cancel it."""
        self.goal.stopped(Ended(), reason)


@dataclass(frozen=True)
class Cancel(Order):
    """A goal's client wants it to end."""

    identity: GoalIdentity

    def obey(self, under_way: GoalUnderWay, mission: Mission, senses: Senses) -> None:
        """End the goal if it is the one under way."""
        if under_way.goal is not None and under_way.goal.identity == self.identity:
            under_way.command(Event.STOP, mission, senses)

    def refuse(self, reason: str) -> None:
        """Do nothing: its goal was refused, too."""


class _Answered(Order):
    """An order by service; the caller waits for the answer."""

    answer: queue.SimpleQueue[tuple[bool, str]]

    def obey(self, under_way: GoalUnderWay, mission: Mission, senses: Senses) -> None:
        """Do it, and answer later."""
        under_way.later(partial(self.answer.put, self._done(under_way, mission, senses)))

    def refuse(self, reason: str) -> None:
        """Answer at once."""
        self.answer.put((False, reason))

    @abstractmethod
    def _done(self, under_way: GoalUnderWay, mission: Mission, senses: Senses) -> tuple[bool, str]:
        """Obey; return whether it was done, and what came of it."""


@dataclass(frozen=True)
class CommandOrder(_Answered):
    """A command by service."""

    event: Event
    answer: queue.SimpleQueue[tuple[bool, str]] = field(default_factory=queue.SimpleQueue)

    def _done(self, under_way: GoalUnderWay, mission: Mission, senses: Senses) -> tuple[bool, str]:
        is_recalled = self.event in _STANDS and under_way.recall(
            f"it was told to {self.event.value} before it began"
        )
        answer = under_way.command(self.event, mission, senses)
        return (True, _DONE[self.event]) if is_recalled else answer


@dataclass(frozen=True)
class RoomsOrder(_Answered):
    """The rooms that the clean under way is to go on with."""

    rooms: tuple[str, ...]
    each: tuple[RoomWay, ...]
    answer: queue.SimpleQueue[tuple[bool, str]] = field(default_factory=queue.SimpleQueue)

    def _done(self, under_way: GoalUnderWay, mission: Mission, senses: Senses) -> tuple[bool, str]:
        try:
            mission.change_rooms(self.rooms, self.each)
        except RoombaError as error:
            return False, str(error)
        return True, f"it goes on with {listed(self.rooms)}"
