"""Any operation of a program is answered by the bridge, which goes on for all others.

``ROOMBA_EXAMPLES=5000`` tries so many operations, others each time.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any, Final

import pytest
from fixtures.graph import RosGraph
from fixtures.spoiled import NUMBERS, spoiled, spoiled_values
from fixtures.waiting import wait_until
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from ros.rosbridge.conftest import Served
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from roomba_ros.rosbridge.rosapi import SERVICES

Parts = list[list[str]]
"""Topics that are published, and services, by their names."""

WITHIN: Final = 20.0
MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
FUZZ: Final = settings(
    max_examples=MORE or 150,
    derandomize=not MORE,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
HEADER: Final = {"seq": 1, "stamp": {"secs": 1, "nsecs": 2}, "frame_id": "map"}
SENSIBLE: Final[tuple[dict[str, Any], ...]] = (
    {"op": "advertise", "topic": "/any", "type": "std_msgs/String", "latch": True},
    {"op": "unadvertise", "topic": "/any"},
    {"op": "publish", "topic": "/any", "type": "std_msgs/String", "msg": {"data": "x"}},
    {
        "op": "publish",
        "topic": "/any_pose",
        "type": "geometry_msgs/PoseStamped",
        "msg": {"header": HEADER, "pose": {"position": {"x": 1.0, "y": 2, "z": None}}},
    },
    {
        "op": "publish",
        "topic": "/any_grid",
        "type": "nav_msgs/OccupancyGrid",
        "msg": {"header": HEADER, "info": {"resolution": 0.05, "width": 2}, "data": [0, -1, 100]},
    },
    {
        "op": "publish",
        "topic": "/any_scan",
        "type": "sensor_msgs/CompressedImage",
        "msg": {"format": "png", "data": "AAEC"},
    },
    {"op": "subscribe", "topic": "/any", "type": "std_msgs/String", "throttle_rate": 3, "id": "a"},
    {"op": "subscribe", "topic": "/rosout", "queue_length": 1, "compression": "none"},
    {"op": "unsubscribe", "topic": "/any", "id": "a"},
    {"op": "call_service", "service": "/dashboard_node/get_loggers", "args": {}},
    {"op": "call_service", "service": "/rosapi/set_param", "args": {"name": "/n", "value": "1"}},
    {"op": "set_level", "level": "error"},
    {"op": "auth", "mac": "not the token", "client": "x", "rand": "y", "t": 1},
    *(
        {"op": "call_service", "service": f"/rosapi/{name}", "args": ["/rosout"], "id": "b"}
        for name in SERVICES
    ),
)
SAID: Final[st.SearchStrategy[str | bytes]] = st.one_of(
    st.sampled_from(SENSIBLE).flatmap(spoiled_values).map(json.dumps),
    st.sampled_from(SENSIBLE)
    .flatmap(lambda operation: spoiled(json.dumps(operation).encode()))
    .map(lambda content: content.decode("utf-8", errors="replace")),
    st.fixed_dictionaries(
        {
            "op": st.sampled_from([operation["op"] for operation in SENSIBLE]),
            "topic": st.one_of(st.text(max_size=20), st.just("/any")),
            "service": st.one_of(st.text(max_size=20), st.just("/rosapi/topics")),
            "type": st.sampled_from(["std_msgs/String", "std_msgs/Nothing", "std_msgs/UInt8"]),
            "msg": st.dictionaries(st.just("data"), st.sampled_from([*NUMBERS, "x", None, []])),
            "args": st.sampled_from([{}, [], [1], {"topic": 1}, "x", None]),
        }
    ).map(json.dumps),
    st.binary(max_size=60),
)


class Conversation:
    """A program that is connected, and connects anew when it was closed for its nonsense."""

    def __init__(self, address: str) -> None:
        self.address = address
        self._socket: ClientConnection | None = None
        self.count = 0

    def end(self) -> None:
        """Close the connection."""
        if self._socket is not None:
            self._socket.close()

    def say(self, said: str | bytes) -> None:
        """Say it, and then what must be answered."""
        self.count += 1
        asked = {"op": "call_service", "service": "/rosapi/get_time", "id": f"time {self.count}"}
        if self._socket is None:
            self._socket = connect(self.address, max_size=None, compression=None)
        try:
            self._socket.send(said)
            self._socket.send(json.dumps(asked))
            while True:
                told = json.loads(self._socket.recv(WITHIN))
                if told.get("id") == asked["id"]:
                    break
        except ConnectionClosed:
            pytest.fail(f"it is closed after {said!r}")
        assert told["result"] is True, told


@pytest.fixture(scope="module")
def untouched(bridge_graph: RosGraph) -> Parts:
    """What there is before a program comes."""
    return parts_of_others(bridge_graph)


@pytest.fixture
def known(served: Served, untouched: Parts) -> Iterator[Conversation]:
    """A program with the token."""
    conversation = Conversation(served.address)
    yield conversation
    conversation.end()


@pytest.fixture
def unknown(served: Served, untouched: Parts) -> Iterator[Conversation]:
    """A program without it; what another one published is taken back before."""
    wait_until(lambda: parts_of_others(served.graph) == untouched, WITHIN, "all is as before")
    conversation = Conversation(f"ws://127.0.0.1:{served.port}/rosbridge")
    yield conversation
    conversation.end()


@FUZZ
@given(said=SAID)
def test_any_operation_is_answered(known: Conversation, said: str | bytes) -> None:
    known.say(said)


@FUZZ
@given(said=SAID)
def test_a_program_without_the_token_changes_nothing(
    bridge_graph: RosGraph, unknown: Conversation, untouched: Parts, said: str | bytes
) -> None:
    unknown.say(said)
    assert parts_of_others(bridge_graph) == untouched


def parts_of_others(graph: RosGraph) -> Parts:
    """Return what is published and served; what the bridge listens to is its own matter."""
    published, _, served = graph.system_state()
    return [sorted(published), sorted(served)]


def test_the_bridge_told_of_no_error_of_its_own(bridge_graph: RosGraph) -> None:
    assert "Traceback" not in bridge_graph.programs[-1].output
