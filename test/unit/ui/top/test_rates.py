"""Rates of messages: nodes tell how many they sent, compared between two requests."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any
from xmlrpc.server import SimpleXMLRPCServer

import pytest
from fixtures.waiting import wait_until

from roomba.ui.top.rates import TopicRates


class Graph:
    """A master, and one node that is a server of its own: both are this one."""

    def __init__(self) -> None:
        self.server = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
        self.uri = f"http://127.0.0.1:{self.server.server_address[1]}"
        self.is_there = True
        self.sent = {"/pose": [10, 8], "/map": [1]}
        for method in ("getSystemState", "lookupNode", "getBusStats"):
            self.server.register_function(getattr(self, method), method)

    def getSystemState(self, _: str) -> Any:  # noqa: N802 - ROS calls it so
        if not self.is_there:
            return 0, "not now", []
        told = [[topic, ["/robot"]] for topic in self.sent] + [["/dead", ["/gone"]]]
        return 1, "", [told, [], []]

    def lookupNode(self, _: str, node: str) -> Any:  # noqa: N802
        return (1, "", self.uri) if node == "/robot" else (-1, f"unknown node {node}", "")

    def getBusStats(self, _: str) -> Any:  # noqa: N802
        topics = [
            [topic, 999, [[number, 99, count, True] for number, count in enumerate(counts)]]
            for topic, counts in {**self.sent, "/unheard": []}.items()
        ]
        return 1, "", [topics, [], []]


@pytest.fixture
def graph() -> Iterator[Graph]:
    made = Graph()
    thread = threading.Thread(target=made.server.serve_forever, args=(0.01,))
    thread.start()
    yield made
    made.server.shutdown()
    thread.join()
    made.server.server_close()


def test_they_are_counted_between_two_times(graph: Graph) -> None:
    rates = TopicRates(graph.uri)
    first = rates.ask()
    assert first is not None
    assert [(each.topic, each.rate, each.hearers) for each in first] == [
        ("/map", 0.0, 1),
        ("/pose", 0.0, 2),
    ]
    graph.sent["/pose"] = [1010, 1008]
    second = rates.ask()
    assert second is not None
    assert second[0].rate == 0.0
    # A thousand in much less than 10 s.
    assert second[1].rate > 100.0
    graph.sent["/pose"] = [3]
    third = rates.ask()
    assert third is not None
    assert (third[1].rate, third[1].hearers) == (0.0, 1)


@pytest.mark.parametrize("master", ["http://127.0.0.1:9", "nonsense", "http://:x/"])
def test_without_a_graph_there_are_none(master: str) -> None:
    assert TopicRates(master).ask() is None


def test_a_graph_that_ends_and_comes_back_is_noticed(graph: Graph) -> None:
    rates = TopicRates(graph.uri)
    assert rates.ask()
    graph.is_there = False
    assert rates.ask() is None
    graph.is_there = True
    wait_until(lambda: rates.ask() is not None, 5.0, "the graph is back")
