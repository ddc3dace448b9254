"""Asking the ROS master and nodes with a deadline: rosgraph waits for ever for one that hangs."""

from __future__ import annotations

from enum import Enum
from http.client import HTTPException
from typing import Final
from urllib.parse import urlsplit
from xmlrpc.client import Error as XmlRpcError
from xmlrpc.client import ServerProxy

import rosgraph

from roomba.client.protocol import RobotUnavailableError
from roomba.client.xml_rpc import ImpatientTransport

ANSWER_WITHIN: Final = 5.0
"""s of wall time after which a silent process counts as hanging; a busy one takes over a second."""
_CALLER: Final = "/roomba_robot_start"
_USUAL_PORT: Final = 11311
"""The port of a master whose URI has none."""


UNANSWERED: Final = (OSError, HTTPException, XmlRpcError, rosgraph.MasterException)
"""Errors of a call of the master that it does not answer, or that another program does."""


class MasterState(Enum):
    """The result of asking the ROS master."""

    ANSWERS = "it answers"
    HANGS = "it takes connections, or its machine is off, and nothing comes"
    ABSENT = "nothing listens there, or another program"


def node_at(uri: str) -> ServerProxy:
    """Return a proxy of a node or the master; its calls raise OSError after the deadline."""
    return ServerProxy(uri, transport=ImpatientTransport(ANSWER_WITHIN))


def port_of(uri: str) -> int:
    """Return the port of a master."""
    return urlsplit(uri).port or _USUAL_PORT


def master(caller: str = _CALLER) -> rosgraph.Master:
    """Return the master to be asked; raises OSError when it does not answer in time."""
    asked = rosgraph.Master(caller)
    asked.handle = node_at(asked.master_uri)
    return asked


def master_state() -> MasterState:
    """Ask the ROS master for a sign of life."""
    try:
        master().getPid()
    except TimeoutError:
        return MasterState.HANGS
    except UNANSWERED:
        return MasterState.ABSENT
    return MasterState.ANSWERS


def require_answering(state: MasterState) -> None:
    """Raise RobotUnavailableError, with what to do, for a ROS master that does not answer."""
    if state is MasterState.HANGS:
        raise RobotUnavailableError(
            f"expected the ROS master at {rosgraph.get_master_uri()} to answer within "
            f"{ANSWER_WITHIN:g} s: it hangs, or its machine is off; let it go on (`fg`, if Ctrl-Z "
            "stopped it), or end it, or set ROS_MASTER_URI for another one"
        )
    if state is MasterState.ABSENT:
        raise RobotUnavailableError(
            f"no ROS master answers at {rosgraph.get_master_uri()}; start the robot with "
            "`./roomba run` (or a `roscore`), or set ROS_MASTER_URI to where it runs"
        )
