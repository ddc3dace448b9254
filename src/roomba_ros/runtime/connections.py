"""Guards a node's connections: a silent or senseless one holds up no other.

rospy shakes hands on the thread that accepts connections, without a deadline, and believes any
length that it is told. It has no hook for that, so three of its functions are replaced.
"""

from __future__ import annotations

import contextlib
import functools
import itertools
import socket
import struct
import threading
import time
import weakref
from collections.abc import Callable
from typing import Any, Final

import rosgraph.xmlrpc
import rospy
import rospy.impl.registration
import rospy.impl.tcpros_base as tcpros
import rospy.msg
from rosgraph.network import (
    ROSHandshakeException,
    decode_ros_handshake_header,
    write_ros_handshake_header,
)

from roomba_ros.convert.errors import MessageError
from roomba_ros.runtime.subscriptions import refuse

HANDSHAKE: Final = 5.0
"""s of wall time until a connection must have said what it wants."""
LONGEST_HEADER: Final = 1 << 20
"""Bytes of the header of a connection, which includes the definition of its messages."""
LARGEST_MESSAGE: Final = 16 << 20
"""Bytes of a message or request; a map of 16 million cells has that many."""
_MOST_HANDSHAKES: Final = 256
"""Handshakes under way at the same time; further connections are closed at once."""
_BACKLOG: Final = 128
"""Connections that may wait to be accepted."""

_LENGTH: Final = struct.Struct("<I")
_unguarded_socket: Final = tcpros.TCPServer._create_server_sock
_unguarded: Final = rospy.msg.deserialize_messages
_slots = threading.BoundedSemaphore(_MOST_HANDSHAKES)
_numbers: Final = itertools.count()
_taken: Final[weakref.WeakKeyDictionary[socket.socket, int]] = weakref.WeakKeyDictionary()
"""Connections to topics, by socket, with the order in which they were accepted, from 0."""
_handing_over: Final = threading.Lock()
"""Held while a connection is handed over to its topic."""


class NothingSaidError(ConnectionError):
    """A connection that its opener closed without having sent anything.

    rospy does so when it has opened two connections to one topic, as happens when all nodes start
    at once: no user can mend that.
    """


class SupersededError(ConnectionError):
    """A connection to a topic whose subscriber has opened a newer one."""


def guard_connections() -> None:
    """Guard all connections to this process; call before ``rospy.init_node``."""
    tcpros.TCPROSServer._tcp_server_callback = _take
    tcpros.TCPServer._create_server_sock = _listen
    tcpros.deserialize_messages = rospy.msg.deserialize_messages = _deserialize
    # A request to the node itself that does not come ends its thread.
    rosgraph.xmlrpc.SilenceableXMLRPCRequestHandler.timeout = HANDSHAKE


def _listen(server: Any) -> socket.socket:
    """Return the socket that a node listens on, with a longer backlog.

    With rospy's backlog of five, a further connection waits a second.
    """
    listening: socket.socket = _unguarded_socket(server)
    listening.listen(_BACKLOG)
    return listening


def _take(server: Any, connection: socket.socket, address: tuple[str, int]) -> None:
    """Shake hands in a thread of its own."""
    if not _slots.acquire(blocking=False):
        connection.close()
        _refuse(f"more than {_MOST_HANDSHAKES} of them say nothing")
        return
    arguments = (server, connection, address, next(_numbers))
    threading.Thread(target=_shake_hands, args=arguments, daemon=True).start()


def _shake_hands(
    server: Any, connection: socket.socket, address: tuple[str, int], number: int
) -> None:
    """Hand a connection to the topic or service that it wants, or close it.

    ``number`` grows from one connection that was taken to the next.
    """
    try:
        fault = _answer(server, connection, address, number)
    except (NothingSaidError, SupersededError):
        connection.close()
        fault = ""
    except (OSError, ValueError, ROSHandshakeException, rospy.ROSException) as error:
        fault = str(error) or type(error).__name__
    finally:
        _slots.release()
    if fault:
        connection.close()
        if not rospy.core.is_shutdown_requested():
            _refuse(fault)


def _answer(server: Any, connection: socket.socket, address: tuple[str, int], number: int) -> str:
    """Return what is wrong with a connection; empty when it was handed over.

    Raises what :func:`header_of` raises, and SupersededError.
    """
    header = header_of(connection)
    handlers: dict[str, Callable[..., str | None]] = {
        "topic": functools.partial(_serve_topic, server, number),
        "service": server.service_connection_handler,
    }
    wanted = next((name for name in handlers if name in header), "")
    if not wanted:
        fault: str | None = "expected the name of a topic or service, got none"
    else:
        fault = handlers[wanted](connection, address, header)
    if fault:
        with contextlib.suppress(OSError):
            write_ros_handshake_header(connection, {"error": fault})
    return fault or ""


def _serve_topic(
    server: Any,
    number: int,
    connection: socket.socket,
    address: tuple[str, int],
    header: dict[str, str],
) -> str | None:
    """Hand a connection over to its topic; return what is wrong with it.

    rospy keeps one connection for each subscriber and closes the earlier one, and a subscriber
    closes the earlier of two that it opened. Both must keep the same one, or none is left.
    Handshakes end in any order here, so the connection that was accepted last is kept.

    Raises SupersededError.
    """
    with _handing_over:
        if _has_later(header, number):
            raise SupersededError("its node has opened another one since")
        _taken[connection] = number
        fault: str | None = server.topic_connection_handler(connection, address, header)
    return fault


def _has_later(header: dict[str, str], number: int) -> bool:
    """Whether the topic has a connection of the same subscriber that was accepted later."""
    topic = rospy.impl.registration.get_topic_manager().get_publisher_impl(header["topic"])
    served = [] if topic is None else topic.connections
    sockets = [one.socket for one in served if one.endpoint_id == header.get("callerid")]
    # A connection that is closed meanwhile has no socket.
    return any(_taken.get(one, -1) > number for one in sockets if one is not None)


def header_of(connection: socket.socket) -> dict[str, str]:
    """Return what a connection says of itself.

    Raises NothingSaidError, another OSError, or ROSHandshakeException.
    """
    deadline = time.monotonic() + HANDSHAKE
    first = _up_to(connection, 1, deadline)
    if not first:
        raise NothingSaidError("it was closed and said nothing")
    length = first + _exactly(connection, _LENGTH.size - 1, deadline)
    (size,) = _LENGTH.unpack(length)
    if size > LONGEST_HEADER:
        raise ROSHandshakeException(
            f"expected a header of at most {LONGEST_HEADER} bytes, got one of {size}"
        )
    told = length + _exactly(connection, size, deadline)
    try:
        header: dict[str, str] = decode_ros_handshake_header(told)
    except struct.error as error:
        raise ROSHandshakeException(f"expected whole fields in a header: {error}") from error
    connection.settimeout(None)
    return header


def _exactly(connection: socket.socket, size: int, deadline: float) -> bytes:
    """Read so many bytes until a deadline, s of wall time; raises OSError."""
    read = _up_to(connection, size, deadline)
    if len(read) < size:
        raise ConnectionError("it was closed before it said what it wants")
    return read


def _up_to(connection: socket.socket, size: int, deadline: float) -> bytes:
    """Read up to so many bytes: fewer only if the connection is closed; raises OSError."""
    read = bytearray()
    while len(read) < size:
        left = deadline - time.monotonic()
        if left <= 0.0:
            raise TimeoutError(f"expected a header within {HANDSHAKE:g} s")
        connection.settimeout(left)
        part = connection.recv(size - len(read))
        if not part:
            break
        read += part
    return bytes(read)


def _deserialize(
    buffer: Any, messages: list[Any], kind: type, *limits: int | None, start: int = 0, **more: Any
) -> None:
    """Deserialize received messages as rospy does, but refuse one that is too long.

    A message begins with its length; an answer of a service has one byte before that.
    """
    if buffer.tell() >= start + _LENGTH.size:
        (length,) = _LENGTH.unpack(buffer.getbuffer()[start : start + _LENGTH.size])
        if length > LARGEST_MESSAGE:
            fault = f"expected messages of at most {LARGEST_MESSAGE} bytes, got one of {length}"
            _refuse(fault)
            raise rospy.exceptions.TransportTerminated(fault)
    _unguarded(buffer, messages, kind, *limits, start=start, **more)


def _refuse(fault: str) -> None:
    refuse("a connection", MessageError(fault))
