"""One goal of an action, as its server keeps it: what all kinds of goals have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TypeVar

import actionlib
from actionlib_msgs.msg import GoalStatus

from roomba_ros.convert.errors import MessageError
from roomba_ros.runtime.subscriptions import refuse


class ActionGoal(ABC):
    """One goal, from its coming to its end."""

    name: str
    """Of its action."""
    action: type
    """Its type."""

    def __init__(self, handle: actionlib.ServerGoalHandle) -> None:
        """Take the action library's handle of it."""
        self._handle = handle

    @property
    def identity(self) -> tuple[str, str]:
        """What tells it from all other goals."""
        return self.name, str(self._handle.get_goal_id().id)

    @property
    def is_recalled(self) -> bool:
        """Whether it was cancelled before it began."""
        return bool(self._handle.get_goal_status().status == GoalStatus.RECALLING)

    @abstractmethod
    def check(self) -> None:
        """Raise MessageError if it is not clear what the goal asks for."""

    @abstractmethod
    def reject(self, reason: str) -> None:
        """Tell why it is not begun."""


Goal = TypeVar("Goal", bound=ActionGoal)


def server_of(
    kind: type[Goal],
    take: Callable[[Goal], object],
    cancel: Callable[[tuple[str, str]], object],
) -> actionlib.ActionServer:
    """Return a server of an action, not started: ``take`` gets goals, ``cancel`` their identities.

    A goal that cannot be used is rejected, and counts as a message that was refused.
    """

    def hear(handle: actionlib.ServerGoalHandle) -> None:
        goal = kind(handle)
        try:
            goal.check()
        except MessageError as error:
            refuse(f"{kind.name}/goal", error)
            goal.reject(str(error))
            return
        take(goal)

    return actionlib.ActionServer(
        kind.name,
        kind.action,
        hear,
        lambda handle: cancel(kind(handle).identity),
        auto_start=False,
    )
