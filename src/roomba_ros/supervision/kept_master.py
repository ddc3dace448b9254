"""A ROS master that saves its state: its successor knows all parameters and registrations.

ROS's own master begins empty. Nodes that run do not register again, so no other program finds them.
"""

from __future__ import annotations

import contextlib
import copy
import logging
import signal
import socket
import threading
import time
import xmlrpc.client
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlparse
from xml.parsers.expat import ExpatError

import rosgraph.roslogging
from rosgraph.xmlrpc import XmlRpcNode
from rosmaster.master_api import ROSMasterHandler

from roomba.files.kept import KeptFileError, read_kept, write_kept
from roomba_ros.runtime.graph.master import MasterState, master_state
from roomba_ros.runtime.timing.heart import HEART

WORKERS: Final = 8
"""Threads that call nodes; with ROS's three, three frozen nodes would hold up all others."""
ANSWER_WITHIN: Final = 1.0
"""s of wall time for a call of a node; a silent node does not hold up the master for longer."""
_KEEP_PERIOD: Final = 0.2
"""s of wall time between two looks at what changed."""

Memory = dict[str, Any]


def be_master(port: int, file: Path) -> None:
    """Serve on a port until told to end; the master's state is saved in a file."""
    rosgraph.roslogging.configure_logging("rosmaster", logging.INFO, filename="master.log")
    socket.setdefaulttimeout(ANSWER_WITHIN)
    ended = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ended.set())
    handler = ROSMasterHandler(WORKERS)
    memory = _recalled(file)
    if memory is not None:
        remind(handler, memory)
    node = XmlRpcNode(port, handler)
    node.start()
    HEART.begin()
    while not ended.wait(_KEEP_PERIOD):
        HEART.beat()
        now = memory_of(handler)
        if now != memory:
            memory = now
            _keep(memory, file)
    node.shutdown("told to end")


def memory_of(handler: Any) -> Memory:
    """Return what a master knows: parameters, publishers, subscribers and services.

    Subscribers of a parameter are told when it changes. Registrations are lists of name, node,
    address of the node, and type or address of the service.
    """
    with handler.param_server.lock:
        parameters = copy.deepcopy(handler.param_server.parameters)
    with handler.ps_lock:
        types, services = handler.topics_types, handler.services
        return {
            "parameters": parameters,
            "publishers": [[*row, types.get(row[0], "*")] for row in _rows(handler.publishers.map)],
            "watchers": _rows(handler.param_subscribers.map),
            "subscribers": [
                [*row, types.get(row[0], "*")] for row in _rows(handler.subscribers.map)
            ],
            "services": [
                [*row, services.service_api_map[row[0]][1]]
                for row in _rows(services.map)
                if row[0] in (services.service_api_map or {})
            ],
        }


def _rows(registered: dict[str, list[tuple[str, str]]]) -> list[list[str]]:
    return [[name, *node] for name, nodes in sorted(registered.items()) for node in nodes]


def remind(handler: Any, memory: Memory) -> None:
    """Restore a master's state, as far as it is about nodes that are still there."""
    handler.param_server.parameters = memory["parameters"]
    addresses = {
        row[2]
        for part in ("publishers", "subscribers", "services", "watchers")
        for row in memory[part]
    }
    there = {address for address in addresses if _listens(address)}
    for part, register in (
        ("subscribers", handler.registerSubscriber),
        ("publishers", handler.registerPublisher),
    ):
        for topic, node, address, kind in memory[part]:
            if address in there:
                register(node, topic, kind, address)
    for service, node, address, place in memory["services"]:
        if address in there:
            handler.registerService(node, service, place, address)
    for parameter, node, address in memory["watchers"]:
        if address in there:
            handler.subscribeParam(node, address, parameter)


def _listens(address: str) -> bool:
    place = urlparse(address)
    with contextlib.suppress(OSError):
        socket.create_connection((place.hostname, place.port or 0), ANSWER_WITHIN).close()
        return True
    return False


def _keep(memory: Memory, file: Path) -> None:
    try:
        write_kept(file, xmlrpc.client.dumps((memory,), allow_none=True).encode())
    except (OSError, TypeError, OverflowError) as error:
        logging.getLogger("rosmaster").error("what the master knows is not kept: %s", error)


def _recalled(file: Path) -> Memory | None:
    log = logging.getLogger("rosmaster")
    try:
        return read_kept(file, _memory_in, log.error)
    except KeptFileError as error:
        log.error("what the last master knew is lost: %s", error)
        return None


def _memory_in(content: bytes) -> Memory:
    try:
        (memory,), _ = xmlrpc.client.loads(content)
    except (ExpatError, xmlrpc.client.Error) as error:
        raise ValueError(f"expected what a master knew: {error}") from error
    if not isinstance(memory, dict):
        raise ValueError(f"expected what a master knew, got {type(memory).__name__}")
    return memory


def wait_for_master(seconds: float, ended: Callable[[], bool]) -> bool:
    """Return whether the master answers within so many seconds, or the waiting has ended."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        # A busy master may take long for its first answer.
        if ended() or master_state() is MasterState.ANSWERS:
            return True
        time.sleep(0.02)
    return False
