"""Cleaning with the whole robot, in a tiny home and on a fast clock."""

import contextlib
import math
import signal
import threading
from collections.abc import Callable, Iterator

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.homes.tiny_home import DOORWAY, FAR_ROOM, STATION, tiny_home
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import Point, PoseStamped, Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import (
    CleanAction,
    CleanFeedback,
    CleanGoal,
    CleanResult,
    DockAction,
    DockGoal,
    DockResult,
    MissedArea,
    Rectangle,
    VacuumState,
)
from roomba_robot.srv import EmergencyStop, InjectFault, InjectFaultRequest
from sensor_msgs.msg import BatteryState
from std_srvs.srv import Trigger

from roomba_ros.runtime.action_client import ActionClient

NODE = "mission_node"
WHOLE = CleanGoal()
EAST_OF_NEAR_ROOM = Rectangle(0.9, 0.0, 1.5, 1.4)
SMALL = CleanGoal(mode=CleanGoal.ZONES, zones=[EAST_OF_NEAR_ROOM])
LONG = 100.0
"""s of wall time, as are all deadlines: what a whole clean takes on a busy machine."""


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot in two little rooms, twelve times as fast as real time."""
    folder = tmp_path_factory.mktemp("robot")
    with RosGraph(folder) as own:
        own.launch(f"home:={tiny_home(folder)}", "speed:=12")
        yield own


class Order:
    """A goal of one of the mission's actions, and what is told of it."""

    def __init__(
        self,
        name: str,
        action: type,
        goal: CleanGoal | DockGoal,
        just_before: Callable[[], object] = lambda: None,
    ) -> None:
        self.feedback: list[CleanFeedback] = []
        self._client = ActionClient(name, action)
        wait_until(
            lambda: self._client.wait_for_server(rospy.Duration(0.01)), 40.0, f"a server of {name}"
        )
        just_before()
        self._client.send_goal(goal, feedback_cb=self.feedback.append)

    def ends(self, status: int, deadline: float = LONG) -> CleanResult | DockResult:
        """Wait for the end, that must be this one; return the result."""
        wait_until(lambda: self._client.simple_state == 2, deadline, "the goal ends")
        assert self._client.get_state() == status, self._client.get_goal_status_text()
        return self._client.get_result()


class Vacuum:
    """A robot on its station, with a full battery and nothing in its way, and what it tells."""

    def __init__(self, graph: RosGraph) -> None:
        self.probe = Probe(graph)
        self.state = VacuumState()
        self.phases: list[str] = []
        rospy.Subscriber("/vacuum/state", VacuumState, self._on_state)
        self.probe.hear("/odom", Odometry)
        self._inject = rospy.ServiceProxy("/sim/inject_fault", InjectFault)
        self.inject("no_obstacles")
        self.inject("charge", 1.0)
        wait_until(lambda: self.state.phase not in ("", "starting"), 60.0, "it is ready")
        if self.state.phase != "docked":
            # Wherever a test before this one failed.
            self.hold(False)
            self.dock().ends(GoalStatus.SUCCEEDED)
        self.does("docked")
        self.forget()

    def forget(self) -> None:
        """Forget what was heard of its state."""
        self.state = VacuumState()
        self.phases.clear()

    def _on_state(self, message: VacuumState) -> None:
        if self.phases[-1:] != [message.phase]:
            self.phases.append(message.phase)
        # The last: a test that waits for it looks at the others then.
        self.state = message

    def clean(self, goal: CleanGoal) -> Order:
        return Order("clean", CleanAction, goal)

    def dock(self) -> Order:
        return Order("dock", DockAction, DockGoal())

    def does(self, phase: str, deadline: float = 60.0) -> None:
        try:
            wait_until(lambda: self.state.phase == phase, deadline, phase)
        except AssertionError as error:
            raise AssertionError(f"{error}; it went through {self.phases}\n{self.state}") from None

    def inject(self, fault: str, value: float = 1.0, x: float = 0.0, y: float = 0.0) -> None:
        answer = self._inject(InjectFaultRequest(fault=fault, value=value, x=x, y=y))
        assert answer.success, answer.message

    def hold(self, engage: bool) -> None:
        """Engage or release the emergency stop."""
        assert rospy.ServiceProxy("/emergency_stop", EmergencyStop)(engage, "a child").success

    def twist(self) -> tuple[float, float]:
        twist = self.probe.next("/odom", Odometry).twist.twist
        return abs(twist.linear.x), abs(twist.angular.z)

    def shows_all_clean(self) -> None:
        wait_until(
            lambda: cleaned(self.probe.newest["/coverage_map"]) > 0.9, 30.0, "the map of all of it"
        )

    def is_driving(self) -> bool:
        return self.twist()[0] > 0.1

    def stops(self, order: Callable[[], object], *, stays: bool = True) -> None:
        """Give an order to a driving robot; it stands, how soon: test_standstill.py.

        And it stays so, unless it soon goes on by itself.
        """
        wait_until(self.is_driving, 30.0, "it drives")
        order()
        wait_until(lambda: max(self.twist()) < 1e-3, 30.0, "it stands")
        assert not stays or self.stands_for(40)

    def stands_for(self, messages: int) -> bool:
        """Whether the wheels stand in so many messages to come."""
        until = self.probe.counts["/odom"] + messages
        while self.probe.counts["/odom"] < until:
            if max(self.twist()) >= 1e-3:
                return False
        return True

    @contextlib.contextmanager
    def steered(self, angular: float) -> Iterator[None]:
        """Steer by ``cmd_vel``: turn the robot on the spot, rad/s."""
        command = Twist()
        command.angular.z = angular
        ended = threading.Event()

        def steer() -> None:
            while not ended.wait(0.02):
                publisher.publish(command)

        publisher = self.probe.publisher("/cmd_vel", Twist)
        wait_until(lambda: publisher.get_num_connections() >= 2, 30.0, "ears for /cmd_vel")
        steering = threading.Thread(target=steer)
        steering.start()
        try:
            yield
        finally:
            ended.set()
            steering.join()
            publisher.publish(Twist())


def in_order(part: list[str], whole: list[str]) -> bool:
    """Whether all of ``part`` comes in ``whole``, in this order."""
    rest = iter(whole)
    return all(word in rest for word in part)


def touched(result: CleanResult) -> float:
    """Return what was left around things that no map shows, m2.

    On a busy machine the robot's clock runs on while its nodes wait for their turn: then it
    touches a wall now and then, where it takes such a thing to be.
    """
    return math.fsum(missed.area for missed in result.missed if missed.reason == MissedArea.THING)


def is_clean(result: CleanResult) -> bool:
    """Whether nothing is left, but for what it touched, and that is little."""
    left = touched(result)
    return bool(left < 0.1 * result.wanted and result.covered + left > 0.99 * result.wanted)


def cleaned(message: OccupancyGrid) -> float:
    """Return the share of the wanted floor that a coverage map shows as clean."""
    shares = [share for share in message.data if share >= 0]
    return math.fsum(shares) / (100.0 * len(shares))


def test_a_clean_is_held_and_completed(shared_robot: RosGraph) -> None:
    vacuum = Vacuum(shared_robot)
    vacuum.probe.hear("/coverage_map", OccupancyGrid)
    clean = vacuum.clean(WHOLE)
    wait_until(lambda: vacuum.state.fraction > 0.2, LONG, "it cleans")

    vacuum.stops(rospy.ServiceProxy("/pause", Trigger))
    assert (vacuum.state.state, vacuum.state.phase) == ("paused", "paused")
    assert rospy.ServiceProxy("/resume", Trigger)().success
    wait_until(vacuum.is_driving, 30.0, "it goes on")

    result = clean.ends(GoalStatus.SUCCEEDED)
    assert (result.outcome, result.message) == (CleanResult.COMPLETED, "")
    assert is_clean(result), result
    assert result.wanted > 2.5
    assert result.dirt > 2.0
    assert 10.0 < result.distance < 40.0
    fractions = [feedback.fraction for feedback in clean.feedback]
    assert fractions[0] < 0.1
    assert max(fractions) > 0.95
    told = {"cleaning", "paused", "returning"}
    wait_until(lambda: told <= {f.state for f in clean.feedback}, 30.0, f"{told} as feedback")
    assert len({f.room for f in clean.feedback if f.room}) == 2

    vacuum.does("docked")
    assert vacuum.state.state == "docked"
    assert in_order(
        ["undocking", "cleaning", "paused", "cleaning", "returning", "docking", "docked"],
        vacuum.phases,
    )
    battery = vacuum.probe.next("/battery_state", BatteryState)
    assert battery.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
    vacuum.shows_all_clean()


@pytest.mark.thorough
def test_with_a_low_battery_it_charges_and_goes_on(shared_robot: RosGraph) -> None:
    vacuum = Vacuum(shared_robot)
    levels: list[float] = []
    rospy.Subscriber("/battery_state", BatteryState, lambda m: levels.append(m.percentage))
    wait_until(lambda: levels, 30.0, "the battery's level")
    # A little above the reserve when it starts; then a little below twice the reserve.
    clean = Order("clean", CleanAction, SMALL, lambda: vacuum.inject("charge", 0.0825))
    vacuum.does("charging")
    assert in_order(["cleaning", "returning", "docking", "charging"], vacuum.phases)
    assert vacuum.state.state == "docked"
    battery = vacuum.probe.next("/battery_state", BatteryState)
    assert battery.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
    assert min(levels) < 0.0825
    vacuum.inject("charge", 0.1595)
    vacuum.does("undocking")
    assert vacuum.state.battery > 0.16
    result = clean.ends(GoalStatus.SUCCEEDED)
    assert result.outcome == CleanResult.COMPLETED
    assert result.covered > 0.9 * result.wanted
    vacuum.does("docked")


def test_a_shut_door_is_told(shared_robot: RosGraph) -> None:
    vacuum = Vacuum(shared_robot)
    x_min, y_min, x_max, y_max = DOORWAY
    for part in (0.1, 0.35, 0.65, 0.9):
        x, y = 0.5 * (x_min + x_max), y_min + part * (y_max - y_min)
        vacuum.inject("obstacle", 0.06, x=x, y=y)
    zones = [EAST_OF_NEAR_ROOM, Rectangle(*FAR_ROOM)]
    result = vacuum.clean(CleanGoal(mode=CleanGoal.ZONES, zones=zones)).ends(GoalStatus.SUCCEEDED)
    assert result.outcome == CleanResult.COMPLETED
    assert result.message.startswith("not clean: ")
    assert "a door is shut" in result.message
    vacuum.does("docked")
    shut = result.missed[0]
    assert shut.reason == MissedArea.SHUT
    assert "door is shut" in shut.message
    assert FAR_ROOM[0] < shut.at.x < FAR_ROOM[2]
    assert shut.room.startswith("Room")
    others = math.fsum(missed.area for missed in result.missed[1:])
    assert shut.area == pytest.approx(result.wanted - result.covered - others, abs=0.05)
    assert result.covered > 0.6


@pytest.mark.thorough
def test_a_blocked_station_is_told_and_found_when_it_is_free(shared_robot: RosGraph) -> None:
    vacuum = Vacuum(shared_robot)
    clean = vacuum.clean(SMALL)
    wait_until(lambda: vacuum.probe.position()[0] > 1.0, 30.0, "it has left the station")
    vacuum.inject("obstacle", 0.05, x=STATION[0] + 0.3, y=STATION[1])
    result = clean.ends(GoalStatus.ABORTED)
    assert result.outcome == CleanResult.NOT_DOCKED
    # It feels the thing, or that it gets no farther, whichever is told first on a busy machine.
    told = ("something stands before it", "does not move")
    assert any(words in result.message for words in told), result.message
    assert result.covered > 0.9 * result.wanted
    vacuum.does("error", 30.0)
    assert (vacuum.state.state, vacuum.state.message) == ("error", result.message)
    vacuum.inject("no_obstacles")
    assert vacuum.dock().ends(GoalStatus.SUCCEEDED).is_docked
    vacuum.does("docked")


@pytest.mark.thorough
def test_a_killed_mission_node_comes_back_and_ends_the_clean(shared_robot: RosGraph) -> None:
    vacuum = Vacuum(shared_robot)
    vacuum.probe.hear("/coverage_map", OccupancyGrid)
    vacuum.clean(SMALL)
    wait_until(lambda: vacuum.state.fraction > 0.3, 30.0, "some of it is clean")
    wanted = vacuum.state.wanted
    vacuum.stops(lambda: shared_robot.signal(NODE, signal.SIGKILL), stays=False)
    vacuum.forget()
    vacuum.does("cleaning", 30.0)
    assert vacuum.state.wanted == wanted
    vacuum.does("docked")
    assert in_order(["cleaning", "returning", "docking", "docked"], vacuum.phases)
    vacuum.shows_all_clean()


def test_a_clean_that_was_held_goes_on_when_told_also_if_its_node_was_killed_meanwhile(
    shared_robot: RosGraph,
) -> None:
    vacuum = Vacuum(shared_robot)
    vacuum.probe.hear("/coverage_map", OccupancyGrid)
    clean = vacuum.clean(SMALL)
    wait_until(lambda: vacuum.state.fraction > 0.3, 30.0, "some of it is clean")
    vacuum.stops(lambda: vacuum.hold(True))
    vacuum.does("emergency stop", 30.0)
    covered = vacuum.state.covered
    shared_robot.signal(NODE, signal.SIGKILL)
    vacuum.forget()
    vacuum.does("emergency stop", 30.0)
    assert vacuum.state.covered == pytest.approx(covered, abs=0.05)
    vacuum.hold(False)
    vacuum.does("paused", 30.0)
    assert vacuum.stands_for(100)
    assert rospy.ServiceProxy("/resume", Trigger)().success
    assert clean.ends(GoalStatus.SUCCEEDED).outcome == CleanResult.COMPLETED
    vacuum.does("docked")
    vacuum.shows_all_clean()


def test_after_a_walk_and_an_emergency_stop_it_finds_home(shared_robot: RosGraph) -> None:
    vacuum = Vacuum(shared_robot)
    goal = PoseStamped()
    goal.header.frame_id = "map"
    goal.pose.position, goal.pose.orientation.w = Point(1.3, 0.4, 0.0), 1.0
    vacuum.probe.send("/move_base_simple/goal", goal)
    wait_until(
        lambda: math.dist(vacuum.probe.position(), (1.3, 0.4)) < 0.05, 30.0, "it walks there"
    )
    vacuum.does("idle")

    clean = vacuum.clean(SMALL)
    vacuum.does("cleaning")
    vacuum.stops(lambda: vacuum.hold(True))
    vacuum.does("emergency stop", 30.0)
    assert (vacuum.state.state, vacuum.state.message) == ("error", "a child")
    vacuum.clean(SMALL).ends(GoalStatus.REJECTED, 30.0)
    # The mission stands by itself; that no other program can drive is the speed loop's work.
    with vacuum.steered(0.8):
        assert vacuum.stands_for(80)
        vacuum.hold(False)
        wait_until(lambda: vacuum.twist()[1] > 0.4, 30.0, "it obeys manual steering")
    vacuum.does("paused", 30.0)
    wait_until(lambda: max(vacuum.twist()) < 1e-3, 30.0, "it stands")
    assert vacuum.stands_for(40)
    assert rospy.ServiceProxy("/stop", Trigger)().success
    result = clean.ends(GoalStatus.PREEMPTED, 30.0)
    assert (result.outcome, result.covered > 0.0) == (CleanResult.STOPPED, True)
    vacuum.does("idle", 30.0)
    assert vacuum.dock().ends(GoalStatus.SUCCEEDED).is_docked
    vacuum.does("docked")
