"""Connections that say nothing, or nonsense, hold up no other and are closed."""

import contextlib
import os
import random
import socket
import struct
import time
import xmlrpc.client
from collections.abc import Iterator
from urllib.parse import urlparse

import pytest
import rosgraph
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import promised, wait_until
from roomba_robot.srv import EmergencyStop
from rosgraph.network import encode_ros_handshake_header
from std_msgs.msg import Float32, String

from roomba_ros.runtime.connections import HANDSHAKE, LARGEST_MESSAGE

ANSWERED = 1.0
"""s of wall time; by then a call is answered, also while other connections are silent."""


@pytest.fixture(scope="module")
def node(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The speed node."""
    with RosGraph(tmp_path_factory.mktemp("speed")) as graph:
        graph.start_master()
        graph.set_param("/robot_max_speed", 0.5)
        graph.rosrun("speed_pub_node.py")
        wait_until(lambda: "/emergency_stop" in graph.system_state()[2], 40.0, "the node")
        yield graph


def places(graph: RosGraph) -> list[tuple[str, int]]:
    """Return where the node takes connections: those of topics and services, and requests."""
    master = rosgraph.Master("/test", graph.uri)
    own = [master.lookupService("/emergency_stop"), master.lookupNode("/speed_pub_node")]
    return [(str(urlparse(uri).hostname), int(urlparse(uri).port or 0)) for uri in own]


def answers(graph: RosGraph) -> None:
    """The emergency stop answers a new client in time, and a new subscriber is served."""
    os.environ.update(graph.environment)
    call = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    began = time.monotonic()
    assert call(True, "a test").success
    assert call(False, "").success
    assert time.monotonic() - began < 2 * ANSWERED


def is_closed(connection: socket.socket) -> bool:
    connection.setblocking(False)
    try:
        return connection.recv(1 << 16) == b""
    except BlockingIOError:
        return False
    except OSError:
        return True


def test_silent_connections_hold_up_no_other_and_are_closed(node: RosGraph) -> None:
    probe = Probe(node)
    silent = [socket.create_connection(place) for place in places(node) for _ in range(8)]
    answers(node)
    assert probe.next("/emergency_stop", String, ANSWERED).data == ""
    assert not any(map(is_closed, silent))
    promised(lambda: all(map(is_closed, silent)), HANDSHAKE + 1.0, "they are closed")


def test_an_endless_header_is_dropped_at_once_and_a_slow_one_in_time(node: RosGraph) -> None:
    Probe(node)
    place, _ = places(node)
    endless = socket.create_connection(place)
    with contextlib.suppress(OSError):
        for _ in range(100):
            endless.sendall(b"\xff" * 4096)
    promised(lambda: is_closed(endless), 2.0, "it is dropped")
    slow = socket.create_connection(place)
    slow.sendall(struct.pack("<I", 1000))

    def is_dropped() -> bool:
        with contextlib.suppress(OSError):
            slow.setblocking(True)
            slow.sendall(b"x")
        return is_closed(slow)

    promised(is_dropped, HANDSHAKE + 1.0, "it is dropped")
    answers(node)


def test_of_two_connections_of_a_subscriber_the_one_that_was_opened_last_stays(
    node: RosGraph,
) -> None:
    Probe(node)
    place, _ = places(node)
    asked = {
        "topic": "/emergency_stop",
        "type": "std_msgs/String",
        "md5sum": String._md5sum,
        "callerid": "/twice",
    }
    header = encode_ros_handshake_header(asked)
    first, last = socket.create_connection(place), socket.create_connection(place)
    first.sendall(header[:-1])
    last.sendall(header)
    assert last.recv(4)
    # The first one's handshake ends after that of the other one, though it was opened before it.
    first.sendall(header[-1:])
    promised(lambda: is_closed(first), 2.0, "the first one is closed")
    last.setblocking(True)
    last.settimeout(5.0)
    while last.recv(1 << 16)[-4:] != struct.pack("<I", 0):
        """The rest of its header, and the message that the topic keeps: an empty text."""
    os.environ.update(node.environment)
    call = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    assert call(True, "a test").success
    assert last.recv(1 << 16).endswith(b"a test")
    assert call(False, "").success
    last.close()


def test_nonsense_is_refused_in_few_lines(node: RosGraph) -> None:
    Probe(node)
    place, _ = places(node)
    rng = random.Random(1)
    before = node.programs[-1].output.count("\n")
    began = time.monotonic()
    headers = [
        encode_ros_handshake_header({"topic": "/no_such", "md5sum": "*", "callerid": "/x"}),
        encode_ros_handshake_header({"service": "/no_such", "md5sum": "*", "callerid": "/x"}),
        encode_ros_handshake_header({"topic": "/speed"}),
        encode_ros_handshake_header({"a": "b"}),
        struct.pack("<I", 0),
        struct.pack("<II", 8, 99999) + b"abcd",
    ]
    for number in range(300):
        with contextlib.suppress(OSError), socket.create_connection(place) as connection:
            text = rng.randbytes(rng.randrange(64))
            connection.sendall(headers[number % 12] if number % 12 < len(headers) else text)
    answers(node)
    node.programs[-1].says("a connection refused", 10.0)
    lines = node.programs[-1].output.count("\n") - before
    # Two lines a second: one of what was refused, one of the emergency stop for each call of it.
    assert lines < 2 * (time.monotonic() - began) + 8, node.programs[-1].output


def test_a_message_that_is_too_long_ends_its_connection(node: RosGraph) -> None:
    probe = Probe(node)
    hears = probe.publisher("/change_speed", Float32)
    wait_until(lambda: hears.get_num_connections() > 0, 20.0, "it hears")
    place, _ = places(node)
    with socket.create_connection(place) as connection:
        header = {
            "service": "/emergency_stop",
            "md5sum": EmergencyStop._md5sum,
            "callerid": "/x",
            "persistent": "1",
        }
        connection.sendall(encode_ros_handshake_header(header))
        assert connection.recv(4)
        with contextlib.suppress(OSError):
            connection.sendall(struct.pack("<I", LARGEST_MESSAGE + 1) + bytes(100))
        promised(lambda: is_closed(connection), 2.0, "it is closed")
    node.programs[-1].says("expected messages of at most 16777216 bytes", 5.0)
    answers(node)


def test_a_node_is_asked_as_before(node: RosGraph) -> None:
    _, (host, port) = places(node)
    with xmlrpc.client.ServerProxy(f"http://{host}:{port}") as proxy:
        for _ in range(3):
            code, _, pid = proxy.getPid("/test")  # type: ignore[misc, str-unpack]
            assert (code, type(pid)) == (1, int)
