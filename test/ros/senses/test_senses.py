"""The senses of a node that does not localize the robot itself."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from fixtures.nodes.lockstep import Lockstep
from roomba_robot.msg import Bumper, Localization
from rospy import Time
from sensor_msgs.msg import LaserScan

from roomba.configuration.nodes import HearingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.grid import FREE, GridFrame, OccupancyMap
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.surface_field import SurfaceField
from roomba.robot.lookout import Lookout
from roomba_ros.convert.common import odometry_message, pose_message
from roomba_ros.senses.senses import HeardSenses

CONFIG = RobotConfig()


@pytest.fixture
def ros() -> Iterator[Lockstep]:
    """Topics without a master."""
    with Lockstep().installed() as lockstep:
        yield lockstep


def heard_senses() -> HeardSenses:
    senses = HeardSenses(CONFIG, HearingConfig(), "odom", "scan", "bumper")
    senses.start()
    return senses


def empty_floor() -> Lookout:
    """Look for things where a map shows none."""
    lookout = Lookout(CONFIG)
    frame = GridFrame(0.05, -2.0, -2.0, 80, 80)
    floor = OccupancyMap(frame, np.full(frame.shape, FREE, np.int8))
    lookout.look_beside(SurfaceField.of(floor))
    return lookout


def tell(ros: Lockstep, stamp: float, distance: float = 1.0) -> None:
    """Tell place, odometry and a scan that meets something ahead, m."""
    ros.publish("/pose", pose_message(stamp, Pose(), "map"))
    ros.publish("/odom", odometry_message(stamp, Pose(), Twist(0.1, 0.0), "odom", "base_link"))
    scan = LaserScan(angle_increment=0.01, range_max=8.0, ranges=[distance] * 20)
    scan.header.stamp = Time.from_sec(stamp)
    ros.publish("/scan", scan)


def things(lookout: Lookout) -> int:
    assert lookout.things is not None
    return len(lookout.things.cells(1))


def test_it_senses_what_was_heard_last_and_where_it_is_now(ros: Lockstep) -> None:
    senses = heard_senses()
    assert senses.at(10.0) is None
    assert senses.missing("odom", "bumper") == ("pose", "odom", "bumper")
    ros.publish("/bumper", Bumper(is_left_pressed=True))
    ros.publish("/localization", Localization(state=Localization.ROUGH, message="dark"))
    tell(ros, 10.0)
    assert senses.missing("odom", "bumper") == ()
    now = senses.at(10.1)
    assert now is not None
    assert now.now == 10.1
    assert now.pose.x == pytest.approx(0.01)
    assert (now.bumper_left, now.bumper_right) == (True, False)
    assert (now.knowledge, now.trouble) == (Knowledge.ROUGH, "dark")


def test_a_scan_is_shown_once_and_only_where_the_place_is_known(ros: Lockstep) -> None:
    senses, lookout = heard_senses(), empty_floor()
    ros.publish("/localization", Localization(state=Localization.SEARCHING))
    tell(ros, 10.0)
    senses.at(10.0)
    senses.show(lookout)
    assert things(lookout) == 0
    ros.publish("/localization", Localization(state=Localization.KNOWN))
    senses.at(10.05)
    senses.show(lookout)
    assert things(lookout) == 0, "it was shown before"
    tell(ros, 10.2)
    senses.at(10.2)
    senses.show(lookout)
    assert things(lookout) > 0


def test_scans_between_those_that_are_looked_at_are_left_out(ros: Lockstep) -> None:
    senses, lookout = heard_senses(), empty_floor()
    for tick, distance in enumerate((1.0, 0.5)):
        stamp = 10.0 + 0.5 * tick * CONFIG.timing.scan_period
        tell(ros, stamp, distance)
        senses.at(stamp)
        senses.show(lookout)
    assert lookout.things is not None
    spots = np.array(lookout.things.obstacles(1))
    assert np.hypot(spots[:, 0], spots[:, 1]).min() > 0.9
