"""The master's and the nodes' answers about the graph; each call may take a while."""

from __future__ import annotations

import io
import socket
from typing import Any, Final

import rosgraph
import rosgraph.network
import rospy
import rospy.core

from roomba.client.protocol import RobotUnavailableError
from roomba_ros.runtime.graph.master import master as answering_master

_PATIENCE: Final = 5.0
"""s of wall time for a node to say what a service is."""
_LONGEST_HEADER: Final = 4096


def master() -> Any:
    """Return a proxy of the master; its calls raise OSError if no answer comes in time."""
    return answering_master(rospy.get_name())


def topic_types() -> dict[str, str]:
    """Return the type of each topic that is published or heard; ``*`` where it is not known."""
    return dict(master().getTopicTypes())


def type_of_topic(name: str) -> str:
    """Return the type of a topic; empty if it is not known."""
    found = topic_types().get(name, "")
    return "" if found == "*" else found


def system_state() -> tuple[dict[str, list[str]], ...]:
    """Return nodes by topic published, by topic heard, and by service."""
    return tuple(dict(part) for part in master().getSystemState())


def subscribers_of(name: str) -> int:
    """Return how many nodes hear a topic."""
    return len(system_state()[1].get(name, ()))


def type_of_service(name: str) -> str:
    """Return the type of a service, asked of its node; empty if there is none.

    Raises RobotUnavailableError when the node does not answer.
    """
    try:
        host, port = rospy.core.parse_rosrpc_uri(master().lookupService(name))
    except rosgraph.MasterError:
        return ""
    header = {"probe": "1", "md5sum": "*", "callerid": rospy.get_name(), "service": name}
    try:
        with socket.create_connection((host, port), timeout=_PATIENCE) as connection:
            rosgraph.network.write_ros_handshake_header(connection, header)
            told = rosgraph.network.read_ros_handshake_header(
                connection, io.BytesIO(), _LONGEST_HEADER
            )
    except (OSError, rosgraph.network.ROSHandshakeException) as error:
        raise RobotUnavailableError(f"the node of {name} does not answer: {error}") from error
    return str(told.get("type", ""))
