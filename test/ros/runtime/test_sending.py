"""Messages leave at once; a receiver that is behind holds up no publisher and misses old ones."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator

import pytest
from fixtures.waiting import wait_until
from rospy.exceptions import TransportTerminated

from roomba_ros.runtime.sending import OutgoingConnection

LONG = 1_000_000
"""Bytes; a few such messages are more than there is room for on the way."""
MANY = 40


class Transport:
    """What a connection of rospy offers, over one end of a pair of sockets."""

    def __init__(self, own: socket.socket) -> None:
        self.socket, self.done = own, False
        self.stat_bytes = self.stat_num_msg = 0
        self.endpoint_id = "/listener"

    def write_data(self, data: bytes) -> None:
        if self.done:
            raise TransportTerminated("connection closed")
        self.socket.sendall(data)
        self.stat_bytes += len(data)
        self.stat_num_msg += 1


class Rig:
    """A connection, and the receiver at its other end."""

    def __init__(self, queue_size: int) -> None:
        own, self.receiver = socket.socketpair()
        self.receiver.settimeout(10.0)
        self.transport = Transport(own)
        self.connection = OutgoingConnection(self.transport, queue_size)
        self.threads = threading.active_count()

    def close(self) -> None:
        self.transport.socket.close()
        self.receiver.close()

    def read(self, length: int) -> bytes:
        parts = bytearray()
        while len(parts) < length:
            parts += self.receiver.recv(length - len(parts))
        return bytes(parts)

    def read_numbers(self, newest: int) -> list[int]:
        """Read long messages until the newest has come; return all, each of which must be whole."""
        numbers: list[int] = []
        while numbers[-1:] != [newest]:
            message = self.read(LONG)
            assert message == message[:1] * LONG
            numbers.append(message[0])
        return numbers


@pytest.fixture(params=[1, 3, 0])
def rig(request: pytest.FixtureRequest) -> Iterator[Rig]:
    made = Rig(request.param)
    yield made
    made.close()


def test_a_message_is_on_its_way_when_it_was_published(rig: Rig) -> None:
    for _ in range(3):
        assert rig.connection.write_data(b"hello")
    assert rig.receiver.recv(100) == b"hellohellohello"
    assert threading.active_count() == rig.threads
    assert (rig.transport.stat_bytes, rig.transport.stat_num_msg) == (15, 3)
    assert rig.connection.endpoint_id == "/listener"


def test_a_receiver_that_is_behind_holds_up_no_publisher_and_gets_whole_messages_in_order() -> None:
    rig = Rig(queue_size=2)
    for number in range(MANY):
        assert rig.connection.write_data(bytes([number]) * LONG)
    numbers = rig.read_numbers(MANY - 1)
    assert numbers == sorted(numbers)
    assert numbers[0] == 0
    assert numbers[-2:] == [MANY - 2, MANY - 1]
    assert len(numbers) < MANY
    rig.close()


def test_without_a_limit_nothing_is_lost() -> None:
    rig = Rig(queue_size=0)
    for number in range(MANY):
        rig.connection.write_data(bytes([number]) * LONG)
    assert rig.read_numbers(MANY - 1) == list(range(MANY))
    wait_until(lambda: rig.transport.stat_num_msg == MANY, 10.0, "all are counted")
    assert rig.transport.stat_bytes == MANY * LONG
    rig.close()


def test_a_receiver_that_has_caught_up_needs_no_thread_any_more() -> None:
    rig = Rig(queue_size=2)
    for number in range(MANY):
        rig.connection.write_data(bytes([number]) * LONG)
    rig.read_numbers(MANY - 1)
    wait_until(lambda: threading.active_count() == rig.threads, 10.0, "the thread ends")
    rig.connection.write_data(b"hello")
    assert rig.receiver.recv(100) == b"hello"
    assert threading.active_count() == rig.threads
    rig.close()


def test_what_goes_wrong_is_raised_as_rospy_expects(rig: Rig) -> None:
    rig.transport.done = True
    with pytest.raises(TransportTerminated):
        rig.connection.write_data(b"hello")


def test_what_goes_wrong_later_is_raised_at_the_next_message() -> None:
    rig = Rig(queue_size=2)
    for number in range(MANY):
        rig.connection.write_data(bytes([number]) * LONG)
    rig.receiver.close()
    wait_until(lambda: threading.active_count() == rig.threads, 10.0, "the thread ends")
    with pytest.raises(OSError, match=r"Broken pipe|reset"):
        rig.connection.write_data(b"hello")
    rig.transport.socket.close()
