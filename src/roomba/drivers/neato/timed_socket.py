"""A connection whose waits all end at one deadline, however slowly bytes come."""

from __future__ import annotations

import socket
import time
from typing import Any


class TimedSocket(socket.socket):
    """A socket that sends and receives until a ``deadline`` of the monotonic clock, s."""

    deadline: float = 0.0

    def sendall(self, data: Any, flags: int = 0, /) -> None:
        """Send all; raises TimeoutError at the deadline."""
        self._wait_no_longer()
        super().sendall(data, flags)

    def recv_into(self, buffer: Any, nbytes: int = 0, flags: int = 0) -> int:
        """Receive what comes next; raises TimeoutError at the deadline."""
        self._wait_no_longer()
        return super().recv_into(buffer, nbytes, flags)

    def _wait_no_longer(self) -> None:
        self.settimeout(_left(self.deadline))


def connected(host: str, port: int, deadline: float) -> TimedSocket:
    """Return a connection that works until ``deadline``.

    When a name has several addresses, each gets its share of the time. Raises OSError. The deadline
    does not bound the look-up of the name, which is up to the system.
    """
    found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
    failure = OSError(f"no address of {host}")
    for index, (family, kind, protocol, _, place) in enumerate(found):
        made = TimedSocket(family, kind, protocol)
        made.deadline = deadline
        try:
            made.settimeout(_left(deadline) / (len(found) - index))
            made.connect(place)
        except OSError as error:
            made.close()
            failure = error
        else:
            return made
    raise failure


def _left(deadline: float) -> float:
    """Return the time left until ``deadline``, s; raises TimeoutError when none is left."""
    left = deadline - time.monotonic()
    if left <= 0.0:
        raise TimeoutError("timed out")
    return left
