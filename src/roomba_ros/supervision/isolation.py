"""A network of the robot's own; only the page is reachable from outside.

The page's socket is bound before the process leaves the network that it was started in. The socket
stays in that network, so nothing has to be forwarded. All other sockets of the robot are in its
own.
"""

from __future__ import annotations

import errno
import fcntl
import json
import os
import socket
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import rospkg

from roomba.client.address import HERE, outside_address
from roomba.client.ports import DEFAULT_PORT, OUTSIDE_ADDRESS, PAGE_SOCKET, PORTS
from roomba.files.lock import try_to_lock
from roomba_ros.supervision.namespace import IsolationError, has_own_network, isolate

FLAG: Final = "--isolated"
"""The argument of ``./roomba run`` and other commands that asks for such a network."""
_FROM_SYSTEMD: Final = 3
"""The first descriptor that systemd gives a service, as sd_listen_fds(3) has it."""


def page_socket(arguments: Sequence[str], environment: Mapping[str, str]) -> socket.socket | None:
    """Return the socket at which the page is reached from outside; None if there is no page.

    The socket comes from systemd, or listens on the port in the launch arguments. Raises
    IsolationError.
    """
    given = dict(argument.split(":=", 1) for argument in arguments if ":=" in argument)
    if given.get("page", "true").lower() in ("false", "0"):
        return None
    if environment.get("LISTEN_PID") == str(os.getpid()):
        return socket.socket(fileno=_FROM_SYSTEMD)
    wanted, host = given.get("page_port", "-1"), given.get("page_host", HERE)
    ports = PORTS if wanted == "-1" else (wanted,)
    for port in ports:
        bound = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            bound.bind((host, int(port)))
            bound.listen()
        except (OSError, ValueError, OverflowError) as error:
            bound.close()
            reason: Exception = error
        else:
            return bound
    raise IsolationError(
        f"expected port {wanted if wanted != '-1' else f'{DEFAULT_PORT} and up'} for the page, "
        f"got: {reason}; choose another by page_port:=N, page_host:=ADDRESS"
    )


def enter_isolation(arguments: list[str]) -> None:
    """Move into a new network, with the page's socket bound before; raises IsolationError.

    The socket and the lock of the record stay open over ``os.execv``.
    """
    if any(argument.startswith("smart_home:=") and argument[12:] for argument in arguments):
        raise IsolationError(f"{FLAG}: expected no smart_home:=FILE, as no broker is reached there")
    lock = _take_record()
    page = page_socket(arguments, os.environ)
    if page is not None:
        os.environ[OUTSIDE_ADDRESS] = outside_address()
        os.set_inheritable(page.fileno(), True)
        os.environ[PAGE_SOCKET] = str(page.detach())
    if not has_own_network():
        isolate()
    os.truncate(lock, 0)
    os.pwrite(lock, json.dumps({"process": os.getpid()}).encode(), 0)


def record() -> Path:
    """Return the file with the process id of the isolated robot, which keeps it locked."""
    return Path(rospkg.get_ros_home()) / "roomba_robot" / "isolated.json"


def _take_record() -> int:
    """Return the descriptor of the locked record; raises IsolationError if a robot has it."""
    file = record()
    file.parent.mkdir(parents=True, exist_ok=True)
    lock = os.open(file, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
    if not try_to_lock(lock):
        os.close(lock)
        raise IsolationError(
            f"expected no isolated robot with {file}, got one that runs; end it first, or set "
            "ROS_HOME for another robot"
        )
    os.set_inheritable(lock, True)
    return lock


def isolated_process() -> int:
    """Return the process id of the isolated robot that runs; raises IsolationError."""
    file = record()
    try:
        with file.open(encoding="utf-8") as opened:
            try:
                fcntl.flock(opened, fcntl.LOCK_SH | fcntl.LOCK_NB)
            except OSError as error:
                if error.errno != errno.EWOULDBLOCK:
                    raise
                return int(json.load(opened)["process"])
    except FileNotFoundError:
        pass
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise IsolationError(f"{file}: expected a robot's process: {error}") from error
    raise IsolationError(
        f"expected an isolated robot, and none runs (by {file}); start one with "
        f"`./roomba run {FLAG}`, or leave {FLAG} out"
    )
