"""The addresses of pages as they are printed, and the token that a page may be told."""

from __future__ import annotations

import os
import socket
from dataclasses import dataclass
from pathlib import Path
from typing import Final
from urllib.parse import parse_qs, urlsplit

from roomba.client.ports import LAST_PORT
from roomba.client.token import read_token
from roomba.errors import RoombaError

HERE: Final = "127.0.0.1"
"""The host that is this machine, to itself alone."""
_LOOPBACK: Final = (HERE, "localhost")
_FAR: Final = ("192.0.2.1", 9)
"""An address for use in documents (RFC 5737): the system says from which address of this machine it
would be reached, and nothing is sent."""
_SOCKETS: Final = Path("/proc/net/tcp")
"""The TCP sockets of IPv4, a line each, in the format of proc(5)."""
_LISTENS: Final = "0A"
"""The state of a socket that waits for connections."""


@dataclass(frozen=True, slots=True)
class PageAddress:
    """Where a page may be; ``port`` None: the first that answers; ``token``: empty without one."""

    host: str = HERE
    port: int | None = None
    token: str = ""


def page_address(text: str) -> PageAddress:
    """Return the address of a text: as a page's server prints it, a port alone, or nothing.

    Raises RoombaError.
    """
    if not text:
        return PageAddress()
    try:
        parts = urlsplit(f"//{HERE}:{text}" if text.isdecimal() else text)
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if not host or not port:
        raise RoombaError(
            f"expected a port up to {LAST_PORT}, or the address that ./roomba run or play "
            f"printed, got {text!r}"
        )
    return PageAddress(host, port, parse_qs(parts.fragment).get("token", [""])[0])


def token_for(address: PageAddress, port: int) -> str:
    """Return the token for the page at a port of an address; empty where there is none.

    It is the token of the address, or the one that this user keeps. The kept one is told only to a
    server of this user, or of root, on this machine: any program may listen at a port and ask for
    it.
    """
    if address.token:
        return address.token
    listeners = listeners_of(port)
    is_own = bool(listeners) and listeners <= {os.geteuid(), 0}
    return (read_token() or "") if is_own and address.host in _LOOPBACK else ""


def listeners_of(port: int, sockets: Path = _SOCKETS) -> set[int]:
    """Return the users whose programs listen at a port of this machine, at any of its addresses.

    Empty where the system does not tell them.
    """
    users: set[int] = set()
    try:
        for line in sockets.read_text("ascii").splitlines()[1:]:
            _, local, _, state, _, _, _, user, *_ = line.split()
            if state == _LISTENS and int(local.rpartition(":")[2], 16) == port:
                users.add(int(user))
    except (OSError, ValueError):
        return set()
    return users


def outside_address() -> str:
    """Return the address of this machine in the network that leads out; empty without one."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asking:
        try:
            asking.connect(_FAR)
        except OSError:
            return ""
        address: str = asking.getsockname()[0]
        return address
