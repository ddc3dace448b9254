"""From where a page is reached: this machine alone, or the network that it is opened to."""

from __future__ import annotations

import ipaddress
import socket
from typing import Final

from roomba.client.address import outside_address
from roomba.ui.web.guard import LOOPBACK, Guard

ALL: Final = "0.0.0.0"
"""The host that stands for all addresses of this machine."""


def is_host(text: str) -> bool:
    """Whether a text is an address of IPv4, at which a page can be served."""
    try:
        ipaddress.IPv4Address(text)
    except ValueError:
        return False
    return True


def guard_for(token: str, host: str) -> Guard:
    """Return the guard of a page that is served at a host.

    A page that is opened to a network is also called by its numbers, and by this machine's name.
    """
    if ipaddress.IPv4Address(host).is_loopback:
        return Guard(token, (*LOOPBACK, host))
    name = socket.gethostname().lower()
    return Guard(token, (*LOOPBACK, name, f"{name}.local"), takes_numbers=True)


def hosts_of(host: str, outside: str = "") -> list[str]:
    """Return the hosts by which a page that is served at ``host`` is reached, its own first.

    ``outside`` is this machine's address in its network, for a process that cannot find it out.
    """
    if host != ALL:
        return [host]
    return [LOOPBACK[0], outside or outside_address() or socket.gethostname()]


def addresses_of(bound: socket.socket, token: str = "", outside: str = "") -> list[str]:
    """Return the addresses of a page that is served at a socket, with its token if it is given."""
    host, port = bound.getsockname()[:2]
    end = f"#token={token}" if token else ""
    return [f"http://{each}:{port}/{end}" for each in hosts_of(host, outside)]
