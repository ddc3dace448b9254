"""Network namespaces: moving into a new one, and into that of another process."""

from __future__ import annotations

import ctypes
import fcntl
import os
import socket
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Final

from roomba.errors import RoombaError

_NEW_USER: Final = 0x10000000
_NEW_NET: Final = 0x40000000
"""CLONE_NEWUSER and CLONE_NEWNET of unshare(2)."""
_GET_FLAGS: Final = 0x8913
_SET_FLAGS: Final = 0x8914
_UP: Final = 1
"""SIOCGIFFLAGS, SIOCSIFFLAGS, IFF_UP of netdevice(7)."""


class IsolationError(RoombaError):
    """There is no network of the robot's own; the message says why, and what to do."""


def unshare(flags: int) -> None:
    """Leave namespaces that are shared with others, as unshare(2); raises OSError."""
    if ctypes.CDLL(None, use_errno=True).unshare(flags) != 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))


def isolate(leave: Callable[[int], None] = unshare) -> None:
    """Leave the network for one with a loopback interface alone; raises IsolationError.

    Call it from a process of one thread. Users other than root need user namespaces for it; they
    keep their user id.
    """
    user, group = os.geteuid(), os.getegid()
    try:
        try:
            leave(_NEW_NET)
        except PermissionError:
            leave(_NEW_USER | _NEW_NET)
            Path("/proc/self/setgroups").write_text("deny", "ascii")
            Path("/proc/self/uid_map").write_text(f"{user} {user} 1", "ascii")
            Path("/proc/self/gid_map").write_text(f"{group} {group} 1", "ascii")
        _bring_up_loopback()
    except OSError as error:
        raise IsolationError(
            f"expected to be let into a network namespace: {error}; that needs root, or a kernel "
            "that gives namespaces to users (see user.max_user_namespaces, kernel.unprivileged_"
            "userns_clone and kernel.apparmor_restrict_unprivileged_userns of sysctl)"
        ) from error


def _bring_up_loopback() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        asked = struct.pack("16sH14x", b"lo", 0)
        (flags,) = struct.unpack("16xH14x", fcntl.ioctl(any_socket, _GET_FLAGS, asked))
        fcntl.ioctl(any_socket, _SET_FLAGS, struct.pack("16sH14x", b"lo", flags | _UP))


def has_own_network() -> bool:
    """Whether this network has a loopback interface alone, as systemd's PrivateNetwork makes."""
    return [name for _, name in socket.if_nameindex()] == ["lo"]


def enter(process: int) -> None:
    """Go into the network of a process; raises IsolationError."""
    try:
        try:
            _go_into(process, "net")
        except PermissionError:
            # The network of a user belongs to a user namespace; only in that may the user enter it.
            _go_into(process, "user")
            _go_into(process, "net")
    except OSError as error:
        raise IsolationError(
            f"expected to be let into the network of process {process}: {error}; do this as the "
            "user who started the robot, or as root"
        ) from error


def _go_into(process: int, kind: str) -> None:
    """Go into one namespace of a process; raises OSError."""
    namespace = os.open(f"/proc/{process}/ns/{kind}", os.O_RDONLY | os.O_CLOEXEC)
    try:
        if ctypes.CDLL(None, use_errno=True).setns(namespace, 0) != 0:
            number = ctypes.get_errno()
            raise OSError(number, os.strerror(number))
    finally:
        os.close(namespace)
