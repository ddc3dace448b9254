"""A client of an action that loses no answer."""

from __future__ import annotations

import threading
from typing import Any

import actionlib


class ActionClient(actionlib.SimpleActionClient):
    """The stock client with one lock around sending and its callbacks.

    Without it an answer that comes while a goal is being sent is taken for one to an older goal
    and dropped, and the goal never ends (actionlib issue 206).
    """

    def __init__(self, *arguments: Any) -> None:
        """Take what the stock client takes: the name of the action, and its type."""
        self._sending = threading.RLock()
        super().__init__(*arguments)

    def send_goal(self, *arguments: Any, **callbacks: Any) -> None:
        """Send a goal in place of the one before."""
        with self._sending:
            super().send_goal(*arguments, **callbacks)

    def _handle_transition(self, handle: Any) -> None:
        with self._sending:
            # News of a goal before, or of one that has ended, is late and no error.
            if handle == self.gh and self.simple_state != actionlib.SimpleGoalState.DONE:
                super()._handle_transition(handle)

    def _handle_feedback(self, handle: Any, feedback: Any) -> None:
        with self._sending:
            super()._handle_feedback(handle, feedback)
