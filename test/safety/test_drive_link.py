"""The last link before the body: only fresh commands of its owner, none in an emergency stop."""

from __future__ import annotations

import math
import threading
from typing import Any

import pytest
import rospy
from fixtures.nodes.lockstep import Lockstep
from geometry_msgs.msg import Twist as TwistMessage
from std_msgs.msg import String

from roomba.errors import ConfigError
from roomba.geometry import STANDSTILL, Twist
from roomba_ros.body.drive_link import DriveLink
from roomba_ros.convert.common import twist_message

STEP = 0.01
TIMEOUT = 0.15
OWNER = "/speed_pub_node"
AHEAD = Twist(0.3, 0.1)


@pytest.fixture
def graph(monkeypatch: pytest.MonkeyPatch) -> Lockstep:
    return Lockstep().install(monkeypatch)


def link(**parameters: object) -> DriveLink:
    for name, value in parameters.items():
        rospy.set_param(f"~{name}", value)
    found = DriveLink(TIMEOUT, threading.Lock())
    found.start()
    return found


def send(graph: Lockstep, topic: str, message: Any, sender: str = OWNER) -> None:
    graph.publish(topic, message, sender=sender)


def drive(graph: Lockstep, twist: Twist, sender: str = OWNER) -> None:
    send(graph, "cmd_vel_out", twist_message(twist), sender)


def test_it_drives_as_its_owner_says_until_that_is_old(graph: Lockstep) -> None:
    drive_link = link()
    assert drive_link.step(STEP) == STANDSTILL
    drive(graph, AHEAD)
    twists = [drive_link.step(STEP) for _ in range(20)]
    assert twists == 15 * [AHEAD] + 5 * [STANDSTILL]


@pytest.mark.parametrize("sender", ["/evil", "/speed_pub_node_2", ""])
def test_what_others_send_drives_and_releases_nothing(graph: Lockstep, sender: str) -> None:
    drive_link = link()
    drive(graph, AHEAD, sender)
    assert drive_link.step(STEP) == STANDSTILL
    send(graph, "emergency_stop", String("fire"))
    send(graph, "emergency_stop", String(""), sender)
    drive(graph, AHEAD)
    assert drive_link.step(STEP) == STANDSTILL
    send(graph, "emergency_stop", String(""))
    send(graph, "emergency_stop", String("joke"), sender)
    drive(graph, AHEAD)
    assert drive_link.step(STEP) == AHEAD


def test_the_emergency_stop_holds_until_its_release(graph: Lockstep) -> None:
    drive_link = link()
    drive(graph, AHEAD)
    send(graph, "emergency_stop", String("fire"))
    assert drive_link.step(STEP) == STANDSTILL
    drive(graph, AHEAD)
    assert drive_link.step(STEP) == STANDSTILL
    send(graph, "emergency_stop", String(""))
    assert drive_link.step(STEP) == STANDSTILL
    drive(graph, AHEAD)
    assert drive_link.step(STEP) == AHEAD


@pytest.mark.parametrize("bad", [Twist(math.nan, 0.0), Twist(0.0, -math.inf)])
def test_what_is_no_number_is_refused(graph: Lockstep, bad: Twist) -> None:
    drive_link = link()
    drive(graph, AHEAD)
    drive(graph, bad)
    assert drive_link.step(STEP) == AHEAD


class Watched:
    """A lock that notes how often it was taken."""

    def __init__(self) -> None:
        self.taken = 0

    def __enter__(self) -> None:
        self.taken += 1

    def __exit__(self, *_: object) -> None:
        pass


def test_a_message_waits_while_the_wheels_are_stepped(graph: Lockstep) -> None:
    lock = Watched()
    DriveLink(TIMEOUT, lock).start()  # type: ignore[arg-type]
    drive(graph, AHEAD)
    assert lock.taken == 1
    send(graph, "emergency_stop", String("fire"))
    assert lock.taken == 2


def test_the_newest_message_alone_waits_and_comes_without_delay(
    graph: Lockstep, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard: dict[str, dict[str, Any]] = {}
    subscribe = rospy.Subscriber

    def watched(name: str, kind: type, hear: Any, **options: Any) -> Any:
        heard[name] = {"kind": kind, **options}
        return subscribe(name, kind, hear, **options)

    monkeypatch.setattr(rospy, "Subscriber", watched)
    link()
    at_once = {"queue_size": 1, "tcp_nodelay": True}
    assert heard == {
        "cmd_vel_out": {"kind": TwistMessage, **at_once},
        "emergency_stop": {"kind": String, **at_once},
    }


def test_another_node_may_be_the_owner(graph: Lockstep) -> None:
    drive_link = link(drive_owner="my_driver")
    drive(graph, AHEAD)
    assert drive_link.step(STEP) == STANDSTILL
    drive(graph, AHEAD, "/my_driver")
    assert drive_link.step(STEP) == AHEAD


def test_any_node_may_drive_when_the_owner_is_any(graph: Lockstep) -> None:
    drive_link = link(drive_owner="any")
    drive(graph, AHEAD, "/whichever")
    assert drive_link.step(STEP) == AHEAD


@pytest.mark.parametrize("name", ["", 7, None, ["speed_pub_node"]])
def test_an_owner_that_is_no_name_is_refused(graph: Lockstep, name: object) -> None:
    assert graph.parameters == {}
    with pytest.raises(ConfigError, match="drive_owner: expected a node's name, or any, got"):
        link(drive_owner=name)
