"""A robot that people own and that cannot be driven: watched, and told to clean by itself."""

from __future__ import annotations

import argparse
from typing import Final

from roomba.commands.play.owned import Tell, kind_of
from roomba.headless.live.remote.client import RemoteClient

NOT_DRIVEN: Final = (
    "this bridge hands on no commands of a robot (/api/serial), so it cleans by its own brain: the "
    "page shows state, charge and scan, and tells it to clean, pause, stop and go home; without "
    "map, rooms, zones and driving by hand"
)


def remote_client(wanted: argparse.Namespace, tell: Tell) -> RemoteClient | None:
    """Return the robot that was asked for, if it can only be told; raises RoombaError.

    ``tell`` is told what is not there then.
    """
    kind = kind_of(wanted)
    config = kind.config()
    remote = kind.remote_on(wanted.line, config)
    if remote is None:
        return None
    remote.look()  # another program that is there is told before there is a page
    tell(NOT_DRIVEN)
    return RemoteClient(kind.name, remote, config)
