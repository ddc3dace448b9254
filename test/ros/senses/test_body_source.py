"""A body is heard by its one message while that comes, and otherwise by single topics."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, field

import pytest
import rospy
from fixtures.nodes.lockstep import Lockstep
from nav_msgs.msg import Odometry
from roomba_robot.msg import BodyState

from roomba.geometry import Twist
from roomba.robot.readings import Readings
from roomba_ros.convert.readings import OdometryReading, odometry_of
from roomba_ros.runtime.senders import OneSender
from roomba_ros.runtime.subscriptions import subscribe
from roomba_ros.senses.body_source import BodySource


@dataclass
class Heard:
    """A source, and what came of it."""

    ros: Lockstep
    whole: list[Readings] = field(default_factory=list)
    single: list[OdometryReading] = field(default_factory=list)
    senders: OneSender = field(default_factory=OneSender)

    def __post_init__(self) -> None:
        """Connect."""
        self.source = BodySource(self.whole.append, self._subscribe, self.senders, 100.0, 1)
        self.source.start()

    def _subscribe(self) -> list[rospy.Subscriber]:
        return [subscribe("odom", Odometry, odometry_of, self.single.append, senders=self.senders)]

    def tell_both(self, sender: str = "/body") -> tuple[int, int]:
        """Let a node tell both; return how much was heard of each until now."""
        odometry = Odometry()
        odometry.pose.pose.orientation.w = 1.0
        self.ros.publish("body", BodyState(battery=0.5, linear=0.2, bin_level=0.25), sender)
        self.ros.publish("odom", odometry, sender)
        return len(self.whole), len(self.single)


@pytest.fixture
def heard() -> Iterator[Heard]:
    """A source on topics without a master."""
    with Lockstep().installed() as lockstep:
        yield Heard(lockstep)


def test_single_topics_are_left_when_the_first_whole_message_came(heard: Heard) -> None:
    heard.source.follow()
    assert not heard.source.is_whole
    assert heard.tell_both() == (1, 1)
    heard.source.follow()
    assert heard.source.is_whole
    for _ in range(2):
        heard.source.follow()
    assert heard.tell_both() == (2, 1)
    assert heard.whole[0].twist == Twist(0.2, 0.0)
    assert heard.whole[0].in_bin == 25.0


def test_single_topics_are_heard_again_when_no_node_tells_the_whole_any_more(heard: Heard) -> None:
    heard.tell_both()
    heard.source.follow()
    heard.ros.leave("body")
    for _ in range(2):
        heard.source.follow()
    assert not heard.source.is_whole
    assert heard.tell_both() == (2, 2)
    heard.source.follow()
    assert heard.source.is_whole
    assert heard.tell_both() == (3, 2)


@pytest.mark.parametrize("battery", [None, 1.01])
def test_single_topics_are_heard_again_when_no_whole_message_can_be_used(
    heard: Heard, monkeypatch: pytest.MonkeyPatch, battery: float | None
) -> None:
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    heard.tell_both()
    for seconds, is_whole in ((2.9, True), (0.2, False)):
        now[0] += seconds
        if battery is not None:
            heard.ros.publish("body", BodyState(battery=battery), "/body")
        heard.source.follow()
        assert heard.source.is_whole is is_whole
    assert heard.tell_both() == (2, 2)
    heard.source.follow()
    assert heard.source.is_whole


def test_a_node_that_does_not_tell_the_body_does_not_take_its_place(
    heard: Heard, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    odometry = Odometry()
    odometry.pose.pose.orientation.w = 1.0
    heard.ros.publish("odom", odometry, "/body")
    heard.tell_both("/other")
    heard.source.follow()
    assert (heard.source.is_whole, heard.whole) == (False, [])
    now[0] += 1.1
    heard.tell_both("/other")
    heard.source.follow()
    assert heard.source.is_whole
