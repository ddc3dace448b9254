"""Floods on every topic, senseless connections to every port, a thousand viewers of the page."""

from __future__ import annotations

import asyncio
import contextlib
import random
import re
import resource
import socket
import time
from typing import Final
from urllib.parse import urlparse

import rosgraph
import rospy
from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.waiting import unchanged
from geometry_msgs.msg import Twist
from roomba_robot.srv import EmergencyStop
from roslib.message import get_message_class
from soak.arena import Arena
from soak.cleaner import ENDED, Cleaner
from soak.rows import Row, in_child, tell, until
from std_msgs.msg import Float32
from websockets.asyncio.client import ClientConnection, connect

FLOOD: Final = 10_000
"""Messages of a flood: per second, as far as one sender can, and in all."""
ANSWERED: Final = 1.0
"""s of wall time within which the emergency stop answers during a flood."""
OBEYED: Final = 60.0
"""s of wall time in which an order is done, or given up."""
_QUIET: Final = 1.0
"""s of wall time without a command, after which no order is under way any more."""
CONNECTIONS: Final = 10_000
VIEWERS: Final = 1_000
SHOWN: Final = 5.0
"""s of wall time within which each viewer gets a new state of the robot."""
_AT_ONCE: Final = 50
"""Connections that are opened before the first is closed again."""
_ORDERS: Final = (
    *(f"/{name}/" for name in ("clean", "dock", "undock", "explore", "walk_to_point", "move_base")),
    *("/move_base_simple/", "/change_position", "/change_heading", "/change_speed", "/cmd_vel"),
)
"""Beginnings of topics for orders: an empty message may be an order, to clean all or to stand."""
_SENSES: Final = (
    *(
        "/body",
        "/odom",
        "/imu",
        "/bumper",
        "/cliff",
        "/wheel_drop",
        "/battery_state",
        "/dock_status",
    ),
    *("/ir_omni", "/dirt_detect", "/bin_level"),
)
"""Topics of the body: the robot heeds there only the simulator's messages."""
_USUAL_SPEED: Final = 0.5
"""m/s; the speed that is set again after a flood that set it to 0."""
_LEFT_ALONE: Final = ("/clock", "/rosout", "/rosout_agg", "/tf", "/tf_static", "/diagnostics")
"""Topics of all ROS programs: a flood there would test ROS, not the robot."""


def floods(arena: Arena) -> list[Row]:
    """Send ten thousand empty messages on each topic that a node of the robot hears."""
    with RosGraph(arena.folder) as graph:
        graph.launch(f"home:={tiny_home(arena.folder)}", "speed:=3")

        def work() -> list[Row]:
            cleaner = Cleaner(graph)
            cleaner.keep_cleaning()
            rows = [flood(graph, cleaner, topic) for topic in heard_topics(graph)]
            cleaner.finish()
            return [cleaner.row, *rows]

        return in_child(arena.folder, work, 3000.0)


def heard_topics(graph: RosGraph) -> list[str]:
    """Return the topics that nodes hear; of the simulator's only the body's senses."""
    told, heard, _ = graph.system_state()
    return sorted(
        topic
        for topic, nodes in heard.items()
        if topic not in _LEFT_ALONE
        and (topic in _SENSES or "/home_sim_node" not in told.get(topic, ()))
        and any(not node.startswith("/soak") for node in nodes)
    )


def flood(graph: RosGraph, cleaner: Cleaner, topic: str) -> Row:
    """Send empty messages on a topic as fast as one sender can, while the robot cleans."""
    cleaner.keep_cleaning()
    row = Row(f"flood {topic}", 1)
    tell(row.what)
    cleaner.may_be_told_otherwise = topic.startswith(_ORDERS)
    kind = get_message_class(graph.topic_types().get(topic, ""))
    if kind is None:
        return row
    # The first call takes longer, as it connects.
    cleaner.probe.next("/speed", Float32)
    publisher = rospy.Publisher(topic, kind, queue_size=10)
    if until(lambda: publisher.get_num_connections() > 0, 5.0) is None:
        publisher.unregister()
        return row
    before, began, message = cleaner.probe.counts["/speed"], time.monotonic(), kind()
    for sent in range(FLOOD):
        publisher.publish(message)
        if sent % 1000 == 999:
            row.expect_within("stop answers", ANSWERED, _emergency_stop_answers)
            time.sleep(max(0.0, began + (sent + 1) / FLOOD - time.monotonic()))
    took = time.monotonic() - began
    if topic == "/change_speed":
        publisher.publish(_USUAL_SPEED)
        time.sleep(ANSWERED)
    publisher.unregister()
    row.measured("thousand messages a second", FLOOD / took / 1000.0)
    if cleaner.probe.counts["/speed"] - before < 0.5 * 10.0 * took:
        row.broken.append("the robot's speed was told less than half as often as it is to be")
    # Empty messages may have been orders: to pause, to stop, to go elsewhere.
    if cleaner.may_be_told_otherwise:
        _wait_until_obeyed(cleaner)
    if cleaner.state.phase == "cleaning":
        cleaner.goes_on(row)
    return row


def _wait_until_obeyed(cleaner: Cleaner) -> None:
    """Wait until the orders are done, or given up: the next clean would give way to them."""
    probe = cleaner.probe
    probe.hear("/cmd_vel", Twist)
    until(lambda: unchanged(lambda: probe.counts["/cmd_vel"], _QUIET), OBEYED)


def _emergency_stop_answers() -> bool:
    return bool(rospy.ServiceProxy("/emergency_stop", EmergencyStop)(False, "").success)


def connections(arena: Arena) -> list[Row]:
    """Open thousands of senseless connections to each port of each node."""
    with RosGraph(arena.folder) as graph:
        graph.launch(f"home:={tiny_home(arena.folder)}", "speed:=3")

        def work() -> list[Row]:
            cleaner = Cleaner(graph)
            row = connect_senselessly(graph, cleaner, arena.random, CONNECTIONS)
            cleaner.finish()
            return [cleaner.row, row]

        return in_child(arena.folder, work, 1800.0)


def connect_senselessly(
    graph: RosGraph, cleaner: Cleaner, random: random.Random, number: int
) -> Row:
    """Open so many connections to all ports while the robot cleans."""
    cleaner.keep_cleaning()
    row = Row("senseless connections")
    tell(row.what)
    places = _places(graph)
    began = time.monotonic()
    while row.times < number:
        row.times += _connect_senselessly(places, random)
        row.expect_within("stop answers", ANSWERED, _emergency_stop_answers)
    row.measured("all", time.monotonic() - began)
    cleaner.goes_on(row)
    return row


def _places(graph: RosGraph) -> list[tuple[str, int]]:
    """Return the ports at which nodes listen: for topics and services, and for XML-RPC."""
    master = rosgraph.Master("/soak_places", graph.uri)
    publishers, subscribers, services = graph.system_state()
    nodes = {
        node for part in (publishers, subscribers) for names in part.values() for node in names
    }
    addresses = [master.lookupNode(node) for node in nodes if not node.startswith("/soak")]
    addresses += [master.lookupService(service) for service in services]
    places = {(urlparse(address).hostname, urlparse(address).port) for address in addresses}
    return [(host, port) for host, port in places if host and port]


def _connect_senselessly(places: list[tuple[str, int]], random: random.Random) -> int:
    """Open some connections, say nonsense or nothing, close them; return how many."""
    opened = []
    for _ in range(_AT_ONCE):
        with contextlib.suppress(OSError):
            connection = socket.create_connection(random.choice(places), 2.0)
            connection.sendall(random.randbytes(random.choice((0, 1, 4, 200, 5000))))
            opened.append(connection)
    for connection in opened:
        connection.close()
    return _AT_ONCE


def viewers(arena: Arena) -> list[Row]:
    """Look at the page from a thousand places, while the robot cleans."""
    arguments = (f"home:={tiny_home(arena.folder)}", "speed:=3", "page:=true", "page_port:=0")
    with RosGraph(arena.folder) as graph:
        graph.launch(*arguments)

        def work() -> list[Row]:
            cleaner = Cleaner(graph)
            row = look(graph, cleaner, VIEWERS)
            cleaner.finish()
            return [cleaner.row, row]

        return in_child(arena.folder, work, ENDED + 600.0)


def look(graph: RosGraph, cleaner: Cleaner, number: int) -> Row:
    """Look at the page from so many places while the robot cleans."""
    cleaner.keep_cleaning()
    row = Row("viewers", number)
    tell(row.what)
    run = graph.programs[0]
    run.says("The page: ", START_DEADLINE)
    found = re.findall(r"The page: http://127\.0\.0\.1:(\d+)/", run.output)
    # The newest process: one that was killed is back, maybe at another port.
    asyncio.run(_look(f"ws://127.0.0.1:{found[-1]}/live", number, row))
    row.expect_within("stop answers", ANSWERED, _emergency_stop_answers)
    cleaner.goes_on(row)
    return row


async def _look(live: str, number: int, row: Row) -> None:
    """Open all viewers, and let each get several messages anew."""
    opened: list[ClientConnection] = []
    try:
        for begin in range(0, number, _AT_ONCE):
            told = await asyncio.gather(
                *(
                    connect(live, open_timeout=30.0, max_size=None)
                    for _ in range(begin, begin + _AT_ONCE)
                ),
                return_exceptions=True,
            )
            opened += [each for each in told if not isinstance(each, BaseException)]
        if len(opened) < number:
            row.broken.append(f"{len(opened)} of {number} viewers were let in")
        for name in ("first look", "second look"):
            began = time.monotonic()
            await asyncio.gather(*(_two_messages(each) for each in opened))
            row.expect(name, time.monotonic() - began, SHOWN)
    finally:
        await asyncio.gather(*(each.close() for each in opened), return_exceptions=True)


async def _two_messages(viewer: ClientConnection) -> None:
    for _ in range(2):
        await asyncio.wait_for(viewer.recv(), 60.0)


def enough_descriptors() -> None:
    """Let this process, and those that it starts, have as many connections as they need."""
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(most, 16_384), most))
