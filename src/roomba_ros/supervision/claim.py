"""Claims a robot for one run: two runs that begin at one moment do not see each other's nodes."""

from __future__ import annotations

import errno
import hashlib
import socket
from urllib.parse import urlsplit

from rosgraph.network import is_local_address

from roomba.errors import RoombaError
from roomba_ros.runtime.graph.master import port_of


def claim_robot(master: str, namespace: str) -> socket.socket:
    """Claim the robot of a namespace on a master until the returned socket is closed.

    Raises RoombaError when another run on this machine has the robot, OSError when the master's
    host has no address. The claim is a socket's name and no file: it vanishes with the run. An
    isolated robot's network has its own names, as it has its own master.
    """
    key = hashlib.sha256(f"{_place_of(master)} {namespace}".encode()).hexdigest()
    claim = socket.socket(socket.AF_UNIX)
    try:
        claim.bind(f"\0roomba_robot_{key}")
    except OSError as error:
        claim.close()
        if error.errno != errno.EADDRINUSE:
            raise
        raise RoombaError(
            f"expected no such robot on {master}, got another run on this machine; end it "
            "first, set ROS_NAMESPACE for another robot, or ROS_MASTER_URI for another master"
        ) from None
    return claim


def _place_of(master: str) -> tuple[str, int]:
    """Return the master's address and port, as its URI can be spelled in several ways."""
    host, port = urlsplit(master).hostname, port_of(master)
    found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
    # The machine's name has other addresses than localhost has.
    if is_local_address(host):
        return "this machine", port
    return min(str(place[0]) for *_, place in found), port
