"""Walking in the default home, as a user's action client sees it."""

import math
from collections.abc import Iterator

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.probe import Probe, Walker
from fixtures.waiting import wait_until
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import RobotPosition
from std_msgs.msg import Float32

ENCODER_COUNT = 0.00045  # m; /odom tells ways in whole counts of the wheels' encoders
CALIBRATION = 1.005  # its wheels are up to five deviations larger than their makers say


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot, three times as fast as real time."""
    with RosGraph(tmp_path_factory.mktemp("robot")) as own:
        own.launch("speed:=3")
        yield own


def test_the_reports_walk_there_and_back(shared_robot: RosGraph) -> None:
    """(3, 4) from (0, 0) at 0.5 m/s: 5.0 m, about 10 s, and home again."""
    probe = Probe(shared_robot)
    walker = Walker()
    probe.position()
    walker.send(3.0, 4.0)
    walker.arrives(40.0)
    assert math.dist(probe.position(), (3.0, 4.0)) < 0.05
    assert 10.0 <= walker.time_spent < 14.0
    assert walker.feedback[0] == pytest.approx(5.0, abs=0.1)
    assert sorted(walker.feedback, reverse=True) == walker.feedback
    assert len(walker.feedback) >= 4
    walker.send(0.0, 0.0)
    walker.arrives(40.0)
    assert math.dist(probe.position(), (0.0, 0.0)) < 0.05


def test_short_ways_and_where_it_stands(shared_robot: RosGraph) -> None:
    """A goal where the robot stands, and one 0.3 m away, are reached within 5 cm."""
    probe = Probe(shared_robot)
    walker = Walker()
    x, y = probe.position()
    for away in (0.0, 0.3):
        walker.send(x, y + away)
        walker.arrives(30.0)
        assert math.dist(probe.position(), (x, y + away)) < 0.05


@pytest.mark.parametrize(
    ("x", "y", "said"),
    [
        (math.nan, 0.0, "finite"),
        (0.0, math.inf, "finite"),
        (101.0, 0.0, "outside the limits"),
        (1e6, 0.0, "outside the limits"),
        (50.0, 50.0, "nearest reachable point"),
    ],
)
def test_what_cannot_be_walked_to_is_rejected_at_once(
    shared_robot: RosGraph, x: float, y: float, said: str
) -> None:
    """A goal that is not finite, outside the limits or in no room is rejected; nothing moves."""
    probe = Probe(shared_robot)
    walker = Walker()
    before = probe.position()
    walker.send(x, y)
    assert walker.ends(30.0) == GoalStatus.REJECTED
    assert said in walker.text
    assert math.dist(probe.position(), before) < 0.05


def test_cancel_stops_it_on_its_way(shared_robot: RosGraph) -> None:
    """After a cancel the robot stands and stays where it is; how soon: test_standstill.py."""
    probe = Probe(shared_robot)
    walker = Walker()
    walker.send(3.0, 4.0)
    wait_until(lambda: probe.speed() > 0.45, 30.0, "full speed")
    walker.cancel()
    assert walker.ends(30.0) == GoalStatus.PREEMPTED
    wait_until(lambda: probe.speed() < 0.01, 30.0, "it stands")
    stopped, since = probe.position(), rospy.get_time()
    wait_until(lambda: rospy.get_time() > since + 1.0, 30.0, "a second passes")
    assert math.dist(probe.position(), stopped) < 0.02
    assert math.dist(stopped, (3.0, 4.0)) > 1.0


def test_the_robots_own_pose_counts_and_a_newer_goal_takes_over_without_a_halt(
    shared_robot: RosGraph,
) -> None:
    """A wrong start in the goal has no effect; a newer goal preempts the older one."""
    probe = Probe(shared_robot)
    probe.hear("/position", RobotPosition)
    first, second = Walker(), Walker()
    x, y = probe.position()
    odometry: list[float] = []
    rospy.Subscriber("/odom", Odometry, lambda m: odometry.append(m.twist.twist.linear.x))
    first.send(3.0, 4.0, cur_x=-40.0, cur_y=70.0)
    wait_until(lambda: probe.speed() > 0.4, 30.0)
    assert math.dist(probe.position(), (x, y)) < 3.0
    odometry.clear()
    second.send(2.4, 3.8)
    assert first.ends(30.0) == GoalStatus.PREEMPTED
    wait_until(lambda: len(odometry) > 15, 30.0)
    assert min(odometry[:15]) > 0.05
    second.arrives(30.0)
    assert math.dist(probe.position(), (2.4, 3.8)) < 0.05


def test_never_above_the_top_speed_nor_a_jump(shared_robot: RosGraph) -> None:
    """The track has no step faster than the top speed; `rosparam set` lowers it in a walk."""
    probe = Probe(shared_robot)
    track: list[tuple[float, float, float]] = []
    rospy.Subscriber(
        "/odom",
        Odometry,
        lambda m: track.append(
            (m.header.stamp.to_sec(), m.pose.pose.position.x, m.pose.pose.position.y)
        ),
    )
    walker = Walker()
    walker.send(3.0, 4.0)
    walker.arrives(40.0)
    walker.send(0.0, 0.0)
    wait_until(lambda: probe.speed() > 0.4, 30.0, "full speed")
    shared_robot.set_param("/robot_max_speed", 0.2)
    wait_until(lambda: 0.15 < probe.speed() < 0.21, 30.0, "the new top speed")
    assert math.dist(probe.position(), (0.0, 0.0)) > 0.5, "that was no braking at the goal"
    shared_robot.set_param("/robot_max_speed", 0.5)
    walker.arrives(40.0)
    assert len(track) > 100
    for apart in (1, 20):
        for (t1, *from_), (t2, *to) in zip(track, track[apart:], strict=False):
            assert math.dist(from_, to) <= 0.5 * CALIBRATION * (t2 - t1) + ENCODER_COUNT


def test_a_single_wish_drives_there_without_an_action(shared_robot: RosGraph) -> None:
    probe = Probe(shared_robot)
    x, y = probe.position()
    probe.send("/change_speed", Float32(0.5), receivers=1)
    probe.send("/change_position", RobotPosition(x + 0.6, y), receivers=1)
    wait_until(lambda: math.dist(probe.position(), (x + 0.6, y)) < 0.05, 30.0, "it is there")


def test_the_map_is_latched(shared_robot: RosGraph) -> None:
    message = Probe(shared_robot).next("/map", OccupancyGrid)
    assert message.info.resolution == pytest.approx(0.05)
    assert set(message.data) <= {-1, 0, 100}
