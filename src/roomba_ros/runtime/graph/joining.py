"""Joining the ROS graph: a node's name, and the address at which other nodes reach it."""

from __future__ import annotations

import os
import socket
from ipaddress import ip_address
from typing import Final
from urllib.parse import urlsplit

import rosgraph
import rosgraph.network
import rospy

from roomba.errors import RoombaError

_CHOOSING: Final = (rosgraph.ROS_HOSTNAME, rosgraph.ROS_IP)
"""The environment variables that choose a node's address; the first takes precedence."""
REACHED_WITHIN: Final = 3.0
"""s of wall time in which this machine reaches an address of its own."""


def join_graph(name: str, *, is_anonymous: bool = False) -> None:
    """Become the ROS node ``name``; signals are left to the program."""
    listen_where_the_master_does()
    rospy.init_node(name, anonymous=is_anonymous, disable_signals=True)


def listen_where_the_master_does() -> None:
    """Listen on loopback alone, if the master is on loopback and the user chose no address.

    Otherwise rospy would listen on all interfaces, and any machine of the network could end the
    node. Users choose an address by ROS_IP, ROS_HOSTNAME, or on the command line.
    """
    if _goes_by_loopback():
        os.environ[rosgraph.ROS_IP] = "127.0.0.1"


def require_own_address() -> None:
    """Raise RoombaError when nodes of this machine cannot reach one another.

    Nodes tell each other the chosen address, or else the machine's name. A shell's start-up file
    often still sets another machine's address: then each node waits for the others.
    """
    if _goes_by_loopback():
        return
    host = str(rosgraph.network.get_host_name())
    family = socket.AF_INET6 if rosgraph.network.use_ipv6() else socket.AF_INET
    place = (rosgraph.network.get_bind_address(), 0)
    try:
        with socket.create_server(place, family=family) as node:
            socket.create_connection((host, node.getsockname()[1]), REACHED_WITHIN).close()
    except (OSError, UnicodeError) as error:  # UnicodeError: of a text that cannot be a host's name
        chosen = next((name for name in _CHOOSING if name in os.environ), None)
        raise RoombaError(
            f"expected {chosen or 'the name of this machine'} to lead to this machine, got "
            f"{host!r}: {error}; set {chosen or rosgraph.ROS_IP} to an address of this machine, "
            "such as 127.0.0.1 when no other is to reach the robot"
        ) from error


def _goes_by_loopback() -> bool:
    """Whether the user chose no address, and the master's address is on loopback."""
    is_chosen = rosgraph.network.get_address_override() is not None
    return not is_chosen and is_loopback(rosgraph.get_master_uri())


def is_loopback(uri: str) -> bool:
    """Whether a URI's host can be reached from this machine alone."""
    host = urlsplit(uri).hostname or ""
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
