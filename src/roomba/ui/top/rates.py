"""The rate of each topic of a ROS graph, asked of its nodes: nothing is subscribed to for it.

Each node counts what it sent, and returns that by its XML-RPC interface (``getBusStats``). A topic
without subscribers is not sent, and so not counted. No ROS is needed to ask.
"""

from __future__ import annotations

import http.client
import os
import time
import xmlrpc.client
from dataclasses import dataclass
from typing import Any, Final
from urllib.parse import urlparse

from roomba.client.xml_rpc import ImpatientTransport

_PATIENCE: Final = 1.0
"""s of wall time that a node may take to answer."""
_CALLER: Final = "/roomba_top"
_FAILURES: Final = (OSError, http.client.HTTPException, xmlrpc.client.Error, ValueError, TypeError)


@dataclass(frozen=True, slots=True)
class Rate:
    """A topic, how often it is told, 1/s of wall time, and how many programs hear it."""

    topic: str
    rate: float
    hearers: int


class TopicRates:
    """Asks the nodes of a graph what they sent since the last time."""

    def __init__(self, master: str | None = None) -> None:
        """Ask nothing yet; by default of the master that ``$ROS_MASTER_URI`` names."""
        self._master = master or os.environ.get("ROS_MASTER_URI", "http://127.0.0.1:11311")
        self._counts: dict[tuple[str, str], int] = {}
        self._at = 0.0

    def ask(self) -> list[Rate] | None:
        """Return the topics that are heard, by name; None where there is no graph."""
        try:
            publishers = self._called(self._master, "getSystemState")[0]
            nodes = sorted({node for _, nodes in publishers for node in nodes})
        except _FAILURES:
            self._counts = {}
            return None
        counts: dict[tuple[str, str], int] = {}
        hearers: dict[str, int] = {}
        now = time.monotonic()
        for node in nodes:
            for topic, sent, count in self._sent_by(node):
                counts[node, topic] = sent
                hearers[topic] = hearers.get(topic, 0) + count
        passed, before = now - self._at, self._counts
        self._counts, self._at = counts, now
        rates = dict.fromkeys(hearers, 0.0)
        for key, sent in counts.items():
            if key in before and sent >= before[key]:
                rates[key[1]] += (sent - before[key]) / passed
        return [Rate(topic, rates[topic], hearers[topic]) for topic in sorted(hearers)]

    def _sent_by(self, node: str) -> list[tuple[str, int, int]]:
        """Return topic, number of messages and number of subscribers, of each topic of a node."""
        try:
            uri = self._called(self._master, "lookupNode", node)
            told = self._called(uri, "getBusStats")[0]
        except _FAILURES:
            return []
        found = []
        for topic, _, connections in told:
            if connections:
                # Each subscriber gets every message; one that came late was sent fewer.
                found.append(
                    (str(topic), max(int(each[2]) for each in connections), len(connections))
                )
        return found

    def _called(self, uri: str, method: str, *arguments: Any) -> Any:
        address = urlparse(uri)
        if address.scheme != "http" or not address.hostname:
            raise ValueError(f"expected http://HOST:PORT, got {uri}")
        with xmlrpc.client.ServerProxy(uri, transport=ImpatientTransport(_PATIENCE)) as server:
            code, message, value = getattr(server, method)(_CALLER, *arguments)
        if code != 1:
            raise ValueError(message)
        return value
