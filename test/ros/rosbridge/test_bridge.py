"""What the bridge lets programs do, and how it treats slow and senseless ones."""

from __future__ import annotations

import contextlib
import json
import os
import time
import urllib.request
from collections.abc import Iterator
from typing import Any

import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import Point
from roomba_robot.msg import Zone, ZoneArray
from ros.rosbridge.conftest import Served
from sensor_msgs.msg import Image
from std_msgs.msg import Float32, String
from std_srvs.srv import Trigger, TriggerResponse
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

WITHIN = 20.0


class Talk:
    """A program that says what it likes."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket

    def say(self, **operation: Any) -> None:
        self.socket.send(json.dumps(operation))

    def hear(self) -> dict[str, Any]:
        told: dict[str, Any] = json.loads(self.socket.recv(WITHIN))
        return told

    def call(self, service: str, **arguments: Any) -> dict[str, Any]:
        self.say(op="call_service", service=service, args=arguments, id="a call")
        while (told := self.hear()).get("id") != "a call":
            pass
        return told


@contextlib.contextmanager
def talking(address: str) -> Iterator[Talk]:
    with connect(address, max_size=None, compression=None) as socket:
        yield Talk(socket)


@pytest.fixture
def reader(served: Served) -> str:
    """The address without a token."""
    return f"ws://127.0.0.1:{served.port}/rosbridge"


def latched(topic: str, kind: type) -> rospy.Publisher:
    """Return a publisher whose last message those get who come later."""
    return rospy.Publisher(topic, kind, latch=True, queue_size=10)


def heard_by_page(graph: RosGraph, topic: str) -> list[str]:
    """Return what nodes hear a topic."""
    return [node for node in graph.system_state()[1].get(topic, []) if node == "/dashboard_node"]


def test_without_the_token_a_program_only_reads(
    bridge_graph: RosGraph, served: Served, reader: str
) -> None:
    probe = Probe(bridge_graph)
    probe.hear("/wish", String)
    calls: list[object] = []

    def do(request: object) -> TriggerResponse:
        calls.append(request)
        return TriggerResponse(True, "done")

    rospy.Service("/do", Trigger, do)
    latched("/told", String).publish("told")
    latched("/picture", Image).publish(Image(height=1, width=1))
    with talking(reader) as program:
        program.say(op="subscribe", topic="/told")
        assert program.hear()["msg"] == {"data": "told"}
        refused: list[dict[str, Any]] = [
            {"op": "advertise", "topic": "/wish", "type": "std_msgs/String"},
            {"op": "publish", "topic": "/wish", "msg": {"data": "no"}},
            {"op": "subscribe", "topic": "/picture"},
        ]
        for operation in refused:
            program.say(**operation)
            told = program.hear()
            assert (told["op"], told["level"]) == ("status", "error")
            assert "token" in told["msg"]
        for service in ("/do", "/rosapi/set_param", "/rosapi/delete_param", "rosapi/set_param"):
            answer = program.call(service, name="/mark", value="1")
            assert answer["result"] is False
            assert "token" in answer["values"]
        assert program.call("/rosapi/topic_type", topic="/told")["values"]["type"]
        program.say(op="auth", mac="wrong", client="", dest="", rand="", t=0, level="", end=0)
        assert "token" in program.hear()["msg"]
        program.say(op="publish", topic="/wish", msg={"data": "no"})
        assert "token" in program.hear()["msg"]
        program.say(op="auth", mac=served.token)
        assert program.call("/do")["values"] == {"success": True, "message": "done"}
        program.say(op="publish", topic="/wish", msg={"data": "yes"})
        wait_until(lambda: "/wish" in probe.newest, WITHIN)
        program.say(op="subscribe", topic="/picture")
        assert program.hear()["msg"]["width"] == 1
    assert probe.newest["/wish"].data == "yes"
    assert len(calls) == 1
    assert not rospy.has_param("/mark")


def test_foreign_sites_and_wrong_tokens_do_not_come_in(served: Served, reader: str) -> None:
    for headers in ({"Origin": "http://evil.example"}, {"Host": "evil.example"}):
        address = f"{reader}?token={served.token}"
        with pytest.raises(InvalidStatus), connect(address, additional_headers=headers):
            pass
    with pytest.raises(InvalidStatus), connect(f"{reader}?token=wrong"):
        pass


def test_one_subscription_however_many_programs_listen_and_each_gets_what_is_latched(
    bridge_graph: RosGraph, reader: str
) -> None:
    Probe(bridge_graph)
    publisher = latched("/newest", String)
    publisher.publish("first")
    with contextlib.ExitStack() as stack:
        programs = [stack.enter_context(talking(reader)) for _ in range(5)]
        for program in programs:
            program.say(op="subscribe", topic="newest", id="one")
            program.say(op="subscribe", topic="newest", id="two", type="std_msgs/String")
            assert program.hear() == {"op": "publish", "topic": "newest", "msg": {"data": "first"}}
        assert publisher.get_num_connections() == 1
        publisher.publish("second")
        assert [program.hear()["msg"]["data"] for program in programs] == ["second"] * 5
        programs[0].say(op="unsubscribe", topic="newest", id="one")
        publisher.publish("third")
        assert programs[0].hear()["msg"]["data"] == "third"
    wait_until(lambda: not heard_by_page(bridge_graph, "/newest"), WITHIN, "it hears no more")


def test_what_the_page_has_heard_already_is_given_too(
    bridge_graph: RosGraph, served: Served, reader: str
) -> None:
    Probe(bridge_graph)
    corners = [Point(0.0, 0.0, 0.0), Point(1.0, 0.0, 0.0), Point(1.0, 1.0, 0.0)]
    latched("/zones", ZoneArray).publish(ZoneArray(zones=[Zone(name="Cables", points=corners)]))
    home = f"http://127.0.0.1:{served.port}/api/v1/home"

    def is_shown() -> bool:
        with urllib.request.urlopen(home, timeout=WITHIN) as answer:
            return bool(json.load(answer)["zones"])

    wait_until(is_shown, WITHIN, "the page has heard it")
    with talking(reader) as program:
        program.say(op="subscribe", topic="/zones")
        assert program.hear()["msg"]["zones"][0]["name"] == "Cables"


def test_a_throttled_program_gets_the_newest_and_in_the_end_the_last(
    bridge_graph: RosGraph, reader: str
) -> None:
    Probe(bridge_graph)
    publisher = latched("/count", Float32)
    with talking(reader) as program:
        publisher.publish(0.0)
        program.say(op="subscribe", topic="/count", throttle_rate=300)
        heard = [program.hear()["msg"]["data"]]
        began = time.monotonic()
        for count in range(1, 50):
            publisher.publish(float(count))
            time.sleep(0.01)
        while heard[-1] != 49.0:
            heard.append(program.hear()["msg"]["data"])
        took = time.monotonic() - began
    assert len(heard) <= 2 + took / 0.3
    assert heard == sorted(heard)


def test_a_slow_program_misses_messages_and_gets_the_newest(
    bridge_graph: RosGraph, reader: str
) -> None:
    probe = Probe(bridge_graph)
    publisher = probe.publisher("/long", String)
    with talking(reader) as slow, talking(reader) as quick:
        for program in (slow, quick):
            program.say(op="subscribe", topic="/long", type="std_msgs/String")
        wait_until(lambda: publisher.get_num_connections() == 1, WITHIN)
        # The client library reads ahead a little, the system some hundred kB.
        slow.socket.recv_messages.pause()
        for number in range(300):
            publisher.publish(f"{number:05}" + 100_000 * "x")
            assert quick.hear()["msg"]["data"].startswith(f"{number:05}")
        slow.socket.recv_messages.resume()
        heard: list[int] = []
        while not heard or heard[-1] != 299:
            heard.append(int(slow.hear()["msg"]["data"][:5]))
    assert heard == sorted(heard)
    assert len(heard) < 100


def test_what_is_advertised_ends_with_the_program(bridge_graph: RosGraph, served: Served) -> None:
    with talking(served.address) as program:
        program.say(op="advertise", topic="/mine", type="std_msgs/String", latch=True)
        program.say(op="publish", topic="/mine", msg={"data": "x"})
        wait_until(lambda: "/mine" in bridge_graph.system_state()[0], WITHIN)
        program.say(op="advertise", topic="/mine2", type="std_msgs/Nothing")
        assert "installed" in program.hear()["msg"]
        program.say(op="publish", topic="/mine", msg={"date": "x"})
        assert "no field 'date'" in program.hear()["msg"]
    wait_until(lambda: "/mine" not in bridge_graph.system_state()[0], WITHIN)


@pytest.mark.parametrize(
    "operation",
    [
        {"op": "subscribe"},
        {"op": "subscribe", "topic": 3},
        {"op": "subscribe", "topic": "/not_there"},
        {"op": "subscribe", "topic": "/x", "type": "std_msgs/Nothing"},
        {"op": "subscribe", "topic": "/x", "type": ["std_msgs/String"]},
        {"op": "subscribe", "topic": "/x", "type": "std_msgs/String", "throttle_rate": "often"},
        {"op": "subscribe", "topic": "/x", "type": "std_msgs/String", "queue_length": -1},
        {"op": "subscribe", "topic": "/ space", "type": "std_msgs/String"},
        {"op": "publish", "topic": "/x", "type": "../../etc/passwd", "msg": {}},
        {"op": "publish", "topic": "/x", "type": "std_msgs/String", "msg": [1]},
        {"op": "publish", "topic": "/x" * 300, "type": "std_msgs/String", "msg": {}},
        {"op": "advertise_service", "service": "/x", "type": "std_srvs/Trigger"},
        {"op": "set_level", "level": "loud"},
        {"op": "fragment", "data": "{}", "num": 0, "total": 1},
        {"op": "x" * 1000},
    ],
)
def test_what_makes_no_sense_is_refused_with_the_reason(
    served: Served, operation: dict[str, Any]
) -> None:
    with talking(served.address) as program:
        program.say(**operation, id="this")
        told = program.hear()
        assert (told["op"], told["level"], told["id"]) == ("status", "error", "this")
        assert "expected" in told["msg"] or "invalid" in told["msg"]
        assert program.call("/rosapi/get_time")["result"] is True


@pytest.mark.parametrize(
    "value", ["1e999", "99999999999", '"\\u0000"', '"\\ud800"', "null", "", '{"a b/": 1}']
)
def test_a_parameter_is_set_or_refused_and_the_master_goes_on(served: Served, value: str) -> None:
    with talking(served.address) as program:
        told = program.call("/rosapi/set_param", name="/odd", value=value)
        assert told["result"] is True or isinstance(told["values"], str)
        assert program.call("/rosapi/get_time")["result"] is True
        assert program.call("/rosapi/get_param_names")["result"] is True


GARBAGE = int(os.environ.get("ROOMBA_GARBAGE", "3000"))
"""Frames; ./roomba soak sends more."""
FRAMES: tuple[str | bytes, ...] = (
    "",
    "garbage",
    "[" * 5000,
    "9" * 5000,
    '{"op": 3}',
    '{"op": "publish", "id": {}}',
    b"\x00\xff" * 50,
    '{"a": "\\ud800"}',
    "null",
)


def test_garbage_is_refused_and_then_the_program_is(served: Served, reader: str) -> None:
    sent, closed = 0, 0
    while sent < GARBAGE:
        with contextlib.suppress(ConnectionClosed), talking(reader) as program:
            for number in range(150):
                program.socket.send(FRAMES[number % len(FRAMES)])
                sent += 1
            while True:
                told = program.hear()
                assert told["level"] == "error"
        closed += 1
        assert program.socket.close_code == 1008
    assert closed >= GARBAGE / 150
    with talking(served.address) as program:
        assert program.call("/rosapi/get_time")["result"] is True


def test_a_compression_is_answered_with_json_and_a_warning_where_warnings_are_wanted(
    bridge_graph: RosGraph, reader: str
) -> None:
    Probe(bridge_graph)
    latched("/packed", String).publish("whole")
    with talking(reader) as program:
        program.say(op="set_level", level="warning")
        program.say(
            op="subscribe", topic="/packed", type="std_msgs/String", compression="cbor", id="this"
        )
        told = program.hear()
        assert (told["op"], told["level"], told["id"]) == ("status", "warning", "this")
        assert "expected compression none, got 'cbor'" in told["msg"]
        assert program.hear()["msg"] == {"data": "whole"}
