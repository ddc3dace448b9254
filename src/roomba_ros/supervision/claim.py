"""A robot is of one run at a time: two that begin at one moment do not see each other's nodes."""

from __future__ import annotations

import errno
import hashlib
import socket
from urllib.parse import urlsplit

from roomba.errors import RoombaError
from roomba_ros.runtime.graph.master import port_of


def claim_robot(master: str, namespace: str) -> socket.socket:
    """Claim the robot of a namespace on a master until what is returned is closed.

    Raises RoombaError when another run of this machine has it, OSError when the master's host has
    no address. The claim is a name and no file: it goes with the run, and a network of its own has
    its own names, as it has its own master.
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
    """Return the address and port of a master: its URI can be spelled in several ways."""
    port = port_of(master)
    found = socket.getaddrinfo(urlsplit(master).hostname, port, type=socket.SOCK_STREAM)
    # By its name this machine has other addresses than as localhost.
    if any(_is_own(family, str(place[0])) for family, *_, place in found):
        return "this machine", port
    return min(str(place[0]) for *_, place in found), port


def _is_own(family: socket.AddressFamily, address: str) -> bool:
    """Whether an address is one of this machine: only there a socket can be bound."""
    with socket.socket(family, socket.SOCK_DGRAM) as bound:
        try:
            bound.bind((address, 0))
        except OSError:
            return False
    return True
