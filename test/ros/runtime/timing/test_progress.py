"""How a driving node tells the simulation its progress, with a publisher of the test's own."""

import pytest
import rospy
from std_msgs.msg import Time

from roomba_ros.runtime.timing.progress import NODES, Progress


class Publisher:
    """Keeps what is told, s."""

    made: list[str]
    told: list[float]

    def __init__(self, topic: str, kind: type, **_: object) -> None:
        assert kind is Time
        self.made.append(topic)

    def publish(self, stamp: rospy.Time) -> None:
        self.told.append(stamp.to_sec())


@pytest.fixture
def publisher(monkeypatch: pytest.MonkeyPatch) -> type[Publisher]:
    Publisher.made, Publisher.told = [], []
    monkeypatch.setattr(rospy, "Publisher", Publisher)
    monkeypatch.setattr(rospy.rostime, "is_wallclock", lambda: False)
    return Publisher


def started(name: str) -> Progress:
    progress = Progress()
    progress.start(name)
    return progress


def test_it_tells_each_tick_up_to_when_the_work_is_done(
    publisher: type[Publisher],
) -> None:
    progress = started(NODES[0])
    for tick in range(162, 202):
        progress.tell(0.025 * tick)
    assert publisher.told == pytest.approx([0.05 * tick for tick in range(81, 101)])


def test_a_clock_that_was_set_back_is_told_at_once(publisher: type[Publisher]) -> None:
    progress = started(NODES[0])
    for now in (500.0, 3.0, 3.03, 3.05):
        progress.tell(now)
    assert publisher.told == pytest.approx([500.0, 3.0, 3.05])


def test_a_node_that_drives_nothing_tells_nothing(publisher: type[Publisher]) -> None:
    started("dirt_pub_node").tell(7.0)
    assert publisher.made == publisher.told == []


def test_on_a_real_robot_no_node_tells_anything(
    publisher: type[Publisher], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rospy.rostime, "is_wallclock", lambda: True)
    for name in NODES:
        started(name).tell(7.0)
    assert publisher.made == publisher.told == []
