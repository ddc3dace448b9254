"""Joining the graph: under which name, and at which of this machine's addresses."""

from __future__ import annotations

import os
from ipaddress import ip_address
from urllib.parse import urlsplit

import rosgraph
import rosgraph.network
import rospy


def join_graph(name: str, *, is_anonymous: bool = False) -> None:
    """Become the ROS node ``name``; signals are left to the program."""
    listen_where_the_master_does()
    rospy.init_node(name, anonymous=is_anonymous, disable_signals=True)


def listen_where_the_master_does() -> None:
    """Listen on loopback alone, if the master is reached there and no address was chosen.

    Without an address rospy listens on all interfaces, and any machine of the network can end the
    node. Addresses are chosen by ROS_IP, ROS_HOSTNAME, or on the command line.
    """
    if rosgraph.network.get_address_override() is None and is_loopback(rosgraph.get_master_uri()):
        os.environ[rosgraph.ROS_IP] = "127.0.0.1"


def is_loopback(uri: str) -> bool:
    """Whether a URI's host can be reached from this machine alone."""
    host = urlsplit(uri).hostname or ""
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
