"""Only the speed node's messages count for the emergency stop."""

from collections.abc import Iterator

import pytest
from fixtures.nodes.lockstep import Lockstep
from std_msgs.msg import String

from roomba_ros.runtime.held_drive import HeldDrive


@pytest.fixture
def ros() -> Iterator[Lockstep]:
    with Lockstep().installed() as lockstep:
        yield lockstep


def test_the_drive_is_held_for_the_reason_that_was_told_last(ros: Lockstep) -> None:
    told: list[str] = []
    kept, passed_on = HeldDrive(), HeldDrive(told.append)
    for held in (kept, passed_on):
        held.start()
        assert held.reason == ""
    for reason in ("a child", ""):
        ros.publish("/emergency_stop", String(reason), "/speed_pub_node")
        assert (kept.reason, passed_on.reason) == (reason, reason)
    assert told == ["a child", ""]


def test_what_another_node_tells_holds_nothing(ros: Lockstep) -> None:
    told: list[str] = []
    held = HeldDrive(told.append)
    held.start()
    ros.publish("/emergency_stop", String("a child"), "/evil")
    assert (held.reason, told) == ("", [])
