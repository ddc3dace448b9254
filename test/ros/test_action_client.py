"""The client of actions, over a stock one that is answered while it sends."""

import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import actionlib
import pytest
from actionlib import CommState, SimpleGoalState

from roomba_ros.runtime.action_client import ActionClient


class Eager:
    """In place of the stock client's lower half: the answer is there before the goal is sent."""

    def __init__(self, *_: Any) -> None:
        self.ns = "walk"
        self.answers: list[threading.Thread] = []

    def send_goal(
        self, _: str, on_transition: Callable[[Any], None], on_feedback: Callable[[Any, Any], None]
    ) -> Any:
        handle = SimpleNamespace(get_comm_state=lambda: CommState.DONE)

        def answer() -> None:
            on_feedback(handle, "half way")
            on_transition(handle)

        self.answers.append(threading.Thread(target=answer))
        self.answers[-1].start()
        # Long enough for an answer that nothing holds up.
        self.answers[-1].join(0.2)
        return handle


@pytest.mark.filterwarnings("ignore:notifyAll:DeprecationWarning")
def test_what_is_answered_while_it_sends_is_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(actionlib.simple_action_client, "ActionClient", Eager)
    client = ActionClient("walk", object)
    feedback: list[str] = []
    client.send_goal("there", feedback_cb=feedback.append)
    client.action_client.answers[0].join(20.0)
    assert client.simple_state == SimpleGoalState.DONE
    assert feedback == ["half way"]
