"""The ROS master, and nodes, asked with a deadline: rosgraph waits for one that hangs for ever."""

from __future__ import annotations

from http.client import HTTPException
from typing import Final
from xmlrpc.client import Error as XmlRpcError
from xmlrpc.client import ServerProxy

import rosgraph

from roomba.client.protocol import RobotUnavailableError
from roomba.client.xml_rpc import ImpatientTransport

ANSWER_WITHIN: Final = 5.0
"""s of wall time without an answer, after which one hangs; a busy one takes over a second."""
_CALLER: Final = "/roomba_robot_start"


def node_at(uri: str) -> ServerProxy:
    """Return a node, or the master, to be asked; raises OSError when it does not answer in time."""
    return ServerProxy(uri, transport=ImpatientTransport(ANSWER_WITHIN))


def master(caller: str = _CALLER) -> rosgraph.Master:
    """Return the master to be asked; raises OSError when it does not answer in time."""
    asked = rosgraph.Master(caller)
    asked.handle = node_at(asked.master_uri)
    return asked


def is_master_online() -> bool:
    """Return whether a ROS master answers; raises RobotUnavailableError when one hangs."""
    try:
        master().getPid()
    except TimeoutError as error:
        raise RobotUnavailableError(
            f"expected the ROS master at {rosgraph.get_master_uri()} to answer within "
            f"{ANSWER_WITHIN:g} s: it hangs, or its machine is off; let it go on (`fg`, if Ctrl-Z "
            "stopped it), or end it, or set ROS_MASTER_URI for another one"
        ) from error
    except (OSError, HTTPException, XmlRpcError, rosgraph.MasterException):
        # Nothing listens there, or another program.
        return False
    return True


def find_master() -> None:
    """Raise RobotUnavailableError, with what to do, when no ROS master answers."""
    if not is_master_online():
        raise RobotUnavailableError(
            f"no ROS master answers at {rosgraph.get_master_uri()}; start the robot with "
            "`./roomba run` (or a `roscore`), or set ROS_MASTER_URI to where it runs"
        )
