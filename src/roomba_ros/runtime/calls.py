"""Calling services within deadlines; their refusals and their absence become named errors."""

from __future__ import annotations

import queue
import re
import threading
import time
from typing import Any

import rosgraph
import rospy

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.errors import RoombaError
from roomba_ros.runtime.graph.master import master
from roomba_ros.runtime.node import told_to_end

SERVER_DEADLINE = 4.0
"""s of wall time that an action server or a service may take to be there: an error comes in 5."""
_LOOK = 0.5
"""s of wall time between two looks whether this process is told to end."""
CALL_DEADLINE = 10.0
"""s of wall time that a service may work on an answer."""

_REFUSAL = re.compile(r"responded with an error: b?['\"](?:error processing request: )?(.*)['\"]$")
"""How rospy frames the sentence that a service refused with."""


def call_service(service: rospy.ServiceProxy, *arguments: object) -> Any:
    """Return the answer of a service.

    Raises RobotUnavailableError when it is not there or does not answer in time, and
    RequestRefusedError with its reason when it refuses.
    """
    name = service.resolved_name
    _wait_for(name)
    answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
    # In a thread of its own: rospy waits for an answer without end.
    threading.Thread(target=lambda: answers.put(_answer(service, arguments)), daemon=True).start()
    answer = _next(answers)
    if answer is None:
        raise RobotUnavailableError(f"{name} gave no answer within {CALL_DEADLINE:g} s")
    if isinstance(answer, RoombaError):
        raise answer
    return answer


def _wait_for(name: str) -> None:
    """Wait until a service is there; raises RobotUnavailableError.

    A process that is told to end stops waiting: the node of the service may have ended just before.
    """
    deadline = time.monotonic() + SERVER_DEADLINE
    while True:
        try:
            rospy.wait_for_service(name, timeout=max(0.01, min(_LOOK, deadline - time.monotonic())))
            return
        except rospy.ROSException as error:
            if told_to_end() or time.monotonic() > deadline:
                raise RobotUnavailableError(
                    f"no service {name} answers within {SERVER_DEADLINE:g} s; is the robot running "
                    "(`./roomba run`)?"
                ) from error


def is_offered(name: str) -> bool:
    """Whether a node offers a service, as the master knows; False when it does not answer."""
    try:
        master(rospy.get_name()).lookupService(rospy.resolve_name(name))
    except (OSError, rosgraph.MasterException):
        return False
    return True


def _next(answers: queue.SimpleQueue[Any]) -> Any:
    deadline = time.monotonic() + CALL_DEADLINE
    while time.monotonic() < deadline and not told_to_end():
        try:
            return answers.get(timeout=0.1)
        except queue.Empty:
            continue
    return None


def _answer(service: rospy.ServiceProxy, arguments: tuple[object, ...]) -> Any:
    try:
        return service(*arguments)
    except (rospy.ServiceException, rospy.ROSException) as error:
        refusal = _REFUSAL.search(str(error))
        if refusal is None:
            return RobotUnavailableError(f"{service.resolved_name} broke off: {error}")
        return RequestRefusedError(refusal.group(1))
