"""The running robot knows where it is, says when it does not, and finds itself again."""

import math
from collections.abc import Iterator

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.probe import Probe, Walker
from fixtures.waiting import wait_until
from geometry_msgs.msg import PoseArray, PoseStamped, PoseWithCovarianceStamped
from roomba_robot.msg import Localization
from roomba_robot.srv import InjectFault, InjectFaultRequest
from std_srvs.srv import Empty

from roomba_ros.convert.common import quaternion_of


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot, four times as fast as real time."""
    with RosGraph(tmp_path_factory.mktemp("robot")) as own:
        own.launch("speed:=4")
        yield own


class Robot:
    """The running robot, and the hands that carry it."""

    def __init__(self, graph: RosGraph) -> None:
        self.probe = Probe(graph)
        self._inject = rospy.ServiceProxy("/sim/inject_fault", InjectFault)

    def inject(self, fault: str, value: float = 1.0, **where: float) -> None:
        answer = self._inject(InjectFaultRequest(fault=fault, value=value, **where))
        assert answer.success, answer.message

    def carry(self, x: float, y: float, theta: float) -> None:
        self.inject("lifted")
        self.until(Localization.SEARCHING, 30.0)
        self.inject("put", x=x, y=y, theta=theta)

    def until(self, state: int, deadline: float) -> Localization:
        wait_until(
            lambda: self.probe.next("/localization", Localization).state == state,
            deadline,
            f"localization state {state}",
        )
        return self.probe.newest["/localization"]

    def is_at(self, x: float, y: float) -> bool:
        return math.dist(self.probe.position(), (x, y)) < 0.05


def told(x: float, y: float, theta: float) -> PoseWithCovarianceStamped:
    message = PoseWithCovarianceStamped()
    message.header.frame_id = "map"
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation = quaternion_of(theta)
    return message


def place_of(message: PoseStamped) -> tuple[float, float]:
    return message.pose.position.x, message.pose.position.y


def test_what_people_tell_is_checked(shared_robot: RosGraph) -> None:
    hands = Robot(shared_robot)
    x, y = hands.probe.position()
    places: list[tuple[float, float]] = []
    heard = rospy.Subscriber("/pose", PoseStamped, lambda m: places.append(place_of(m)))
    for wrong in (told(x + 0.2, y, 3.4), told(5.0, 3.0, 0.0)):
        places.clear()

        def is_believed(pose: PoseWithCovarianceStamped = wrong) -> bool:
            # A scan may correct it before the next pose is told.
            hands.probe.send("/initialpose", pose)
            return any(math.dist(place, (x, y)) > 0.1 for place in places)

        wait_until(is_believed, 20.0, "it is believed", pause=0.2)
        hands.until(Localization.KNOWN, 20.0)
        wait_until(lambda: hands.is_at(x, y), 30.0, "it corrects the pose that was told")
    heard.unregister()
    bad = told(math.nan, 0.0, 0.0)
    hands.probe.send("/initialpose", bad)
    refused = "initialpose refused"
    wait_until(lambda: refused in shared_robot.programs[0].output, 30.0, "the refusal is told")
    wait_until(lambda: hands.is_at(x, y), 30.0, "it is where it was")


def test_asked_to_forget_its_place_it_finds_it(shared_robot: RosGraph) -> None:
    hands = Robot(shared_robot)
    x, y = hands.probe.position()
    hands.probe.hear("/particlecloud", PoseArray)
    states: list[int] = []
    rospy.Subscriber("/localization", Localization, lambda m: states.append(m.state))
    wait_until(lambda: states[-1:] == [Localization.KNOWN], 30.0, "it knows its place")
    rospy.ServiceProxy("/global_localization", Empty)()
    wait_until(lambda: set(states) != {Localization.KNOWN}, 30.0, "it forgot it")

    def deviation() -> float:
        told = hands.probe.next("/amcl_pose", PoseWithCovarianceStamped)
        return math.sqrt(told.pose.covariance[0])

    wait_until(lambda: 0.0 < deviation() < 0.1, 20.0, "it knows its place well")
    hands.until(Localization.KNOWN, 20.0)
    wait_until(lambda: hands.is_at(x, y), 20.0, "and it is right")
    assert hands.probe.next("/particlecloud", PoseArray).poses


def test_a_robot_whose_lidar_is_blocked_says_so_and_walks_slowly(shared_robot: RosGraph) -> None:
    hands = Robot(shared_robot)
    hands.inject("lidar_blocked")
    assert "lidar" in hands.until(Localization.ROUGH, 30.0).message
    walker = Walker()
    walker.send(1.0, 0.3)
    fastest = 0.0
    while walker.status in (GoalStatus.PENDING, GoalStatus.ACTIVE):
        fastest = max(fastest, hands.probe.speed())
    walker.arrives(30.0)
    assert 0.1 < fastest < 0.2
    hands.inject("lidar_blocked", 0.0)
    hands.until(Localization.KNOWN, 30.0)
    wait_until(lambda: hands.is_at(1.0, 0.3), 30.0, "it is where it walked")


def test_a_robot_carried_away_on_its_walk_finds_itself_and_arrives(shared_robot: RosGraph) -> None:
    hands = Robot(shared_robot)
    walker = Walker()
    walker.send(3.0, 4.0)
    wait_until(lambda: hands.probe.speed() > 0.3, 30.0, "it walks")
    hands.carry(7.5, 1.5, 2.0)
    hands.until(Localization.KNOWN, 30.0)
    walker.arrives(60.0)
    # The simulation's truth: the beams of the lidar fit the map there, and the goal is reached.
    wait_until(lambda: hands.is_at(3.0, 4.0), 30.0, "it is at the goal")
    wait_until(
        lambda: hands.probe.next("/localization", Localization).agreement > 0.9, 30.0, "it fits"
    )
