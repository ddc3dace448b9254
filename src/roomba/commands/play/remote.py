"""A robot that people own and that no program can drive: watched, and told to clean."""

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
    """Return the wanted robot, if it can only be told to clean; raises RoombaError.

    ``tell`` is called with what such a robot lacks.
    """
    kind = kind_of(wanted)
    config = kind.config()
    remote = kind.remote_on(wanted.line, config)
    if remote is None:
        return None
    remote.look()  # first, so that another program on the line is reported before there is a page
    tell(NOT_DRIVEN)
    return RemoteClient(kind.name, remote, config)
