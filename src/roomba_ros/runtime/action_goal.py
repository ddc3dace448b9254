"""One goal of an action, as its server keeps it: what all kinds of goals have in common."""

from __future__ import annotations

from abc import ABC

import actionlib
from actionlib_msgs.msg import GoalStatus


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
