"""The pose as it was heard, carried on by the wheels."""

from __future__ import annotations

import math
import time as wall
from collections.abc import Iterator

import pytest
from fixtures.nodes.lockstep import Lockstep
from roomba_robot.msg import Localization

from roomba.configuration.nodes import HearingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.perception.localization.estimate import Knowledge
from roomba.robot.readings import Readings
from roomba_ros.convert.common import pose_message
from roomba_ros.senses.heard_place import HeardPlace

TICK = 0.05
AHEAD = Twist(0.2, 0.0)


@pytest.fixture
def ros() -> Iterator[Lockstep]:
    """Topics without a master."""
    with Lockstep().installed() as lockstep:
        yield lockstep


def place() -> HeardPlace:
    heard = HeardPlace(RobotConfig(), HearingConfig())
    heard.start()
    return heard


def drive(heard: HeardPlace, start: float, ticks: int) -> None:
    """Let the wheels tell that it drives ahead, from the odometry's beginning on."""
    for tick in range(ticks):
        time = start + tick * TICK
        heard.move(Readings(time, Pose(0.2 * tick * TICK, 0.0, 0.0), twist=AHEAD))


def is_at(pose: Pose | None, x: float, y: float, theta: float) -> bool:
    assert pose is not None
    return (pose.x, pose.y, pose.theta) == pytest.approx((x, y, theta), abs=1e-9)


def test_a_pose_that_comes_late_is_as_good(ros: Lockstep) -> None:
    heard = place()
    drive(heard, 10.0, 5)
    assert heard.at(10.2) is None
    ros.publish("/pose", pose_message(10.1, Pose(3.0, 1.0, math.pi / 2.0), "map"))
    assert is_at(heard.at(10.1), 3.0, 1.0, math.pi / 2.0)
    assert is_at(heard.at(10.2), 3.0, 1.02, math.pi / 2.0)
    assert is_at(heard.told, 3.0, 1.0, math.pi / 2.0)


def test_after_the_last_odometry_it_is_where_its_twist_leads_but_not_for_ever(
    ros: Lockstep,
) -> None:
    heard = place()
    drive(heard, 10.0, 1)
    ros.publish("/pose", pose_message(10.0, Pose(), "map"))
    assert is_at(heard.at(10.3), 0.06, 0.0, 0.0)
    assert is_at(heard.at(99.0), 0.1, 0.0, 0.0)


def test_on_wheels_that_slip_the_gyro_tells_how_it_turned(ros: Lockstep) -> None:
    heard = place()
    for tick in range(5):
        # The wheels tell of no turn.
        turning = 0.0 if tick == 0 else 1.0
        heard.move(Readings(10.0 + tick * TICK, Pose(), twist=Twist(), turning=turning))
    ros.publish("/pose", pose_message(10.0, Pose(3.0, 1.0, 0.0), "map"))
    turned = heard.at(10.2)
    assert turned is not None
    assert turned.theta > 0.15, "both count, by their variances"


def test_a_pose_waits_for_the_odometry_that_it_follows_from(ros: Lockstep) -> None:
    heard = place()
    drive(heard, 10.0, 3)
    ros.publish("/pose", pose_message(10.1, Pose(1.0, 0.0, 0.0), "map"))
    assert is_at(heard.at(10.1), 1.0, 0.0, 0.0)
    ros.publish("/pose", pose_message(10.3, Pose(7.0, 0.0, 0.0), "map"))
    assert is_at(heard.at(10.1), 1.0, 0.0, 0.0)
    heard.move(Readings(10.3, Pose(0.06, 0.0, 0.0), twist=AHEAD))
    assert is_at(heard.at(10.3), 7.0, 0.0, 0.0)


def test_a_pose_from_before_all_that_is_remembered_changes_nothing(ros: Lockstep) -> None:
    heard = place()
    drive(heard, 10.0, 100)
    ros.publish("/pose", pose_message(14.9, Pose(1.0, 0.0, 0.0), "map"))
    assert is_at(heard.at(14.95), 1.01, 0.0, 0.0)
    ros.publish("/pose", pose_message(11.0, Pose(7.0, 0.0, 0.0), "map"))
    assert is_at(heard.at(14.95), 1.01, 0.0, 0.0)


def test_after_the_clock_was_set_back_what_was_driven_before_does_not_count(
    ros: Lockstep,
) -> None:
    heard = place()
    drive(heard, 500.0, 5)
    ros.publish("/pose", pose_message(500.2, Pose(), "map"))
    assert heard.at(500.2) is not None
    drive(heard, 10.0, 2)
    ros.publish("/pose", pose_message(10.0, Pose(2.0, 0.0, 0.0), "map"))
    assert is_at(heard.at(10.05), 2.01, 0.0, 0.0)


def test_it_tells_how_old_the_newest_pose_is(ros: Lockstep) -> None:
    heard = place()
    assert heard.is_silent(10.0)
    assert heard.is_late(10.0, 0.2)
    drive(heard, 10.0, 1)
    ros.publish("/pose", pose_message(10.0, Pose(), "map"))
    heard.at(10.0)
    assert not heard.is_silent(99.0), "it was heard just now"
    assert [heard.is_late(now, 0.2) for now in (9.9, 10.0, 10.19, 10.2)] == [
        False,
        False,
        False,
        True,
    ]


def test_it_passes_on_how_well_the_place_is_known(ros: Lockstep) -> None:
    heard = place()
    assert heard.deviation == 0.05, "a localizer of others tells nothing of it"
    lost = Localization(state=Localization.LOST, message="fog", position_deviation=1.5)
    ros.publish("/localization", lost)
    assert heard.knowledge == (Knowledge.LOST, "fog")
    assert heard.deviation == 1.5


def test_another_node_does_not_say_that_the_place_is_known(
    ros: Lockstep, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [100.0]
    monkeypatch.setattr(wall, "monotonic", lambda: now[0])
    heard = place()
    lost = Localization(state=Localization.LOST, message="carried away")
    ros.publish("/localization", lost, "/own")
    for _ in range(5):
        ros.publish("/localization", Localization(), "/other")
    assert heard.knowledge == (Knowledge.LOST, "carried away")
    now[0] += 3.1
    ros.publish("/localization", Localization(), "/other")
    assert heard.knowledge == (Knowledge.KNOWN, "")
