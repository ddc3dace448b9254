"""A robot is of one run at a time: two that begin at one moment do not see each other's nodes."""

from __future__ import annotations

import errno
import hashlib
import socket

from roomba.errors import RoombaError


def claim_robot(master: str, namespace: str) -> socket.socket:
    """Claim the robot of a namespace on a master until what is returned is closed.

    Raises RoombaError when another run of this machine has it. The claim is a name and no file: it
    goes with the run, and a network of its own has its own names, as it has its own master.
    """
    key = hashlib.sha256(f"{master} {namespace}".encode()).hexdigest()
    claim = socket.socket(socket.AF_UNIX)
    try:
        claim.bind(f"\0roomba_robot_{key}")
    except OSError as error:
        claim.close()
        if error.errno != errno.EADDRINUSE:
            raise
        raise RoombaError(
            f"expected no such robot on {master}, got another run that has just begun; end it "
            "first, set ROS_NAMESPACE for another robot, or ROS_MASTER_URI for another master"
        ) from None
    return claim
