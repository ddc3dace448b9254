"""Raw TCP on loopback: the fastest round trip that two Python processes can have."""

from __future__ import annotations

import socket
import subprocess
import sys

from roomba_bench.peers.protocol import Parameters, Work

DISTRIBUTION = ""
_TRIPS = 50
_DEADLINE = 5.0
_ECHO = """
import socket, sys
link = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
while data := link.recv(65536):
    link.sendall(data)
"""


def prepare(parameters: Parameters) -> Work:
    """Start an echo as a process of its own; ``bytes`` is the size of a message."""
    size = int(parameters["bytes"])
    message = bytes(size)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        listener.settimeout(_DEADLINE)
        # The echo ends with this process, which then closes its end of the connection.
        subprocess.Popen([sys.executable, "-c", _ECHO, str(listener.getsockname()[1])])
        link, _ = listener.accept()
    link.settimeout(_DEADLINE)
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def trips() -> float:
        for _ in range(_TRIPS):
            link.sendall(message)
            missing = size
            while missing:
                missing -= len(link.recv(missing))
        return float(_TRIPS)

    return Work(trips)
