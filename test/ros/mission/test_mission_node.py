"""The mission node alone, in a world that is made of topics."""

import math
import signal
import threading
import time

import pytest
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until
from geometry_msgs.msg import Point, PoseStamped, Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import (
    CleanAction,
    CleanGoal,
    DockStatus,
    EmptyingStation,
    Rectangle,
    UndockAction,
    UndockGoal,
    VacuumState,
    Zone,
    ZoneArray,
)
from roomba_robot.srv import EmergencyStop, SetZone
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Bool, Float32, String
from std_srvs.srv import Trigger

from roomba_ros.runtime.action_client import ActionClient

NODE = "mission_node"


class World(Probe):
    """A room of 3 x 3 m with the station at (1, 0), and a robot in it that hardly moves.

    It creeps at a tenth of what is wanted: one that stands would be stuck.
    """

    def __init__(self, graph: RosGraph) -> None:
        super().__init__(graph)
        self.x, self.is_docked = 1.0, True
        self.is_silent, self.bin_level = False, 0.0
        for topic, message in (("/map", room()), ("/station_pose", stamped(1.0, 0.0))):
            publisher = rospy.Publisher(topic, type(message), queue_size=1, latch=True)
            publisher.publish(message)
        self.hear("/cmd_vel_mission", Twist)
        self.hear("/vacuum/state", VacuumState)
        self.hear("/zones", ZoneArray)
        kinds = {"pose": PoseStamped, "odom": Odometry}
        kinds |= {"battery_state": BatteryState, "dock_status": DockStatus}
        kinds |= {"bin_level": Float32}
        self._topics = {name: self.publisher(f"/{name}", kind) for name, kind in kinds.items()}
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            if not self.is_silent:
                wanted = self.newest.get("/cmd_vel_mission", Twist())
                self.x += 0.1 * wanted.linear.x * 0.05
                pose, odometry = stamped(self.x, 0.0), Odometry()
                odometry.header.stamp = pose.header.stamp = rospy.Time.now()
                odometry.pose.pose.orientation.w = 1.0
                self._topics["odom"].publish(odometry)
                self._topics["pose"].publish(pose)
                self._topics["battery_state"].publish(BatteryState(percentage=0.8, capacity=1.8))
                self._topics["bin_level"].publish(self.bin_level)
                self._topics["dock_status"].publish(DockStatus(is_docked=self.is_docked))
            time.sleep(0.05)  # a robot tells all that at 20 Hz

    @property
    def state(self) -> VacuumState:
        return self.newest.get("/vacuum/state", VacuumState())

    def does(self, phase: str, deadline: float = 30.0) -> None:
        wait_until(lambda: self.state.phase == phase, deadline, f"{phase}, not {self.state}")

    def leaves_the_drive(self) -> bool:
        """Whether no command comes from one telling of the state to the next, a second later."""
        self.next("/vacuum/state", VacuumState)
        before = self.counts["/cmd_vel_mission"]
        self.next("/vacuum/state", VacuumState)
        return self.counts["/cmd_vel_mission"] == before

    def wants(self, linear: float) -> bool:
        message = self.newest.get("/cmd_vel_mission", Twist())
        return math.isclose(message.linear.x, linear, abs_tol=1e-6)


def stamped(x: float, y: float) -> PoseStamped:
    message = PoseStamped()
    message.header.frame_id = "map"
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation.w = 1.0
    return message


def room() -> OccupancyGrid:
    side = 64
    edge = (0, 1, side - 2, side - 1)
    data = [
        100 if row in edge or column in edge else 0 for row in range(side) for column in range(side)
    ]
    message = OccupancyGrid(data=data)
    message.info.resolution, message.info.width, message.info.height = 0.05, side, side
    message.info.origin.position.x = message.info.origin.position.y = -1.6
    message.info.origin.orientation.w = 1.0
    return message


def start(graph: RosGraph) -> tuple[World, Program]:
    node = graph.rosrun("mission_node.py")
    return World(graph), node


def client(name: str, action: type) -> ActionClient:
    found = ActionClient(name, action)
    wait_until(lambda: found.wait_for_server(rospy.Duration(0.01)), 30.0, f"the server of {name}")
    return found


def ends(client: ActionClient, deadline: float) -> int:
    wait_until(lambda: client.simple_state == 2, deadline, "the goal ends")
    return int(client.get_state())


def order(name: str) -> tuple[bool, str]:
    answer = rospy.ServiceProxy(name, Trigger)()
    return answer.success, answer.message


def test_orders_are_obeyed_or_refused_with_the_reason(graph: RosGraph) -> None:
    world, node = start(graph)
    cancels = [0]
    rospy.Subscriber(
        "/walk_to_point/cancel", GoalID, lambda _: cancels.__setitem__(0, cancels[0] + 1)
    )
    world.does("docked", 30.0)
    assert world.state.state == "docked"
    assert math.isclose(world.state.battery, 0.8, abs_tol=1e-6)
    assert order("pause") == (False, "cannot pause now: the robot is docked")

    clean = client("clean", CleanAction)
    clean.send_goal(CleanGoal(mode=CleanGoal.ROOMS, rooms=["Hall"]))
    assert ends(clean, 30.0) == GoalStatus.REJECTED
    assert "rooms" in clean.get_goal_status_text()

    undock = client("undock", UndockAction)
    undock.send_goal(UndockGoal())
    world.does("undocking", 30.0)
    wait_until(lambda: world.wants(-0.15), 30.0, "it backs out")
    wait_until(lambda: cancels == [1], 30.0, "walks are cancelled, once")
    assert order("pause") == (True, "paused")
    wait_until(lambda: world.wants(0.0), 30.0, "it stands")
    assert order("resume") == (True, "going on")
    wait_until(lambda: world.wants(-0.15), 30.0, "it goes on")

    undock.cancel_goal()
    assert ends(undock, 30.0) == GoalStatus.PREEMPTED
    wait_until(lambda: world.wants(0.0), 30.0, "it stands")
    wait_until(world.leaves_the_drive, 30.0, "the drive is left to others")

    undock.send_goal(UndockGoal())
    world.does("undocking", 30.0)
    graph.set_param("/robot_max_speed", 0.5)
    graph.rosrun("speed_pub_node.py")
    hold = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    hold.wait_for_service(30.0)
    assert hold(True, "a child").success
    world.does("emergency stop", 30.0)
    assert (world.state.state, world.state.message) == ("error", "a child")
    assert ends(undock, 30.0) == GoalStatus.ABORTED
    # The state is what the drive says, and no other node.
    world.send("/emergency_stop", String(""))
    wait_until(lambda: "emergency_stop refused" in node.output, 30.0, "the forged release is told")
    assert world.next("/vacuum/state", VacuumState).phase == "emergency stop"
    assert hold(False, "").success
    wait_until(lambda: world.state.state != "error", 30.0)


def test_zones_beyond_the_limits_are_refused_and_many_are_quickly_there(graph: RosGraph) -> None:
    world, _ = start(graph)
    world.does("docked", 30.0)
    call = rospy.ServiceProxy("/set_zone", SetZone)

    def refused(zone: Zone) -> str:
        answer = call(zone)
        assert not answer.success
        return str(answer.message)

    round_one = [Point(math.cos(0.01 * i), math.sin(0.01 * i), 0.0) for i in range(200_000)]
    assert "3 to 200 points, got 200000" in refused(Zone("far", Zone.NO_GO, round_one))
    assert len(refused(Zone(1_000_000 * "a", Zone.NO_GO, round_one[::100]))) < 200
    assert "printable" in refused(Zone("a\nb", Zone.NO_GO, round_one[::100]))
    corners = [Point(-1.0, -1.0, 0.0), Point(-0.8, -1.0, 0.0), Point(-0.8, -0.8, 0.0)]
    for number in range(100):
        assert call(Zone(f"zone {number}", Zone.NO_GO, corners)).success
    wait_until(lambda: len(world.newest["/zones"].zones) == 100, 20.0, "all are told")
    clean = client("clean", CleanAction)
    clean.send_goal(CleanGoal(mode=CleanGoal.ZONES, zones=1001 * [Rectangle(0.0, 0.0, 1.0, 1.0)]))
    assert ends(clean, 30.0) == GoalStatus.REJECTED
    assert "at most 1000 zones, got 1001" in clean.get_goal_status_text()


@pytest.mark.thorough
def test_a_disk_that_refuses_is_told_and_what_was_refused_is_kept_when_it_does_not(
    graph: RosGraph,
) -> None:
    memory = graph.folder / "ros_home" / "roomba_robot" / "mission"
    memory.parent.mkdir(parents=True)
    # In place of the folder: nothing can be written there.
    memory.write_text("")
    world, node = start(graph)
    world.x, world.is_docked = 0.0, False
    world.does("idle", 30.0)
    clean = client("clean", CleanAction)
    clean.send_goal(CleanGoal())
    world.does("cleaning")
    wait_until(lambda: "the errand is not remembered" in world.state.message, 5.0, "it is told")
    assert world.state.phase == "cleaning"
    memory.unlink()
    wait_until(lambda: list(memory.glob("robot/*.json")), 20.0, "it is remembered")
    wait_until(lambda: world.state.message == "", 20.0, lambda: f"all is well: {world.state}")
    assert node.output.count("the errand is not remembered") == 2
    assert order("stop")[0]


def test_a_disk_with_too_little_room_is_told_before_it_refuses_anything(graph: RosGraph) -> None:
    config = graph.folder / "nodes.yaml"
    config.write_text("memory: {free_space: 1.0e+18}\n")
    graph.set_param("/nodes_config", str(config))
    world, node = start(graph)
    world.does("docked", 30.0)
    wait_until(lambda: "No space left on device" in world.state.message, 5.0, "it is told")
    assert "may not be kept" in world.state.message
    assert world.state.state == "docked"
    assert node.output.count("No space left on device") == 1


def test_a_full_bin_is_told_and_waited_for(graph: RosGraph) -> None:
    world, _ = start(graph)
    world.x, world.is_docked = 0.0, False
    world.does("idle", 30.0)
    clean = client("clean", CleanAction)
    clean.send_goal(CleanGoal())
    world.does("cleaning", 30.0)
    world.bin_level = 1.0
    world.does("returning", 30.0)
    assert world.state.message.startswith("bin full")
    assert world.state.hindrance == VacuumState.BIN_FULL
    world.x, world.is_docked = 1.0, True
    world.does("bin full", 30.0)
    assert (world.state.state, world.state.message[:8]) == ("error", "bin full")
    assert order("resume")[0] is False
    assert order("empty_bin") == (
        False,
        "expected an empty dust bin, got one that is 100% full by its level sensor",
    )
    world.bin_level = 0.0
    world.does("undocking", 30.0)
    assert (world.state.message, world.state.hindrance) == ("", VacuumState.NONE)
    assert order("empty_bin") == (True, "the bin counts as empty now")


def test_its_station_empties_the_bin_as_long_as_it_is_told_to(graph: RosGraph) -> None:
    world, _ = start(graph)
    world.does("docked", 30.0)
    by_hand = "cannot empty its bin at its station: its station empties no bin: empty it by hand"
    assert order("empty_at_station") == (False, by_hand)
    world.hear("/emptying_wanted", Bool)

    def tell(is_at_work: bool, bag: float) -> None:
        world.send("/emptying_station", EmptyingStation(is_at_work, bag))

    tell(False, 1.0)
    wait_until(lambda: "the bag of its station is full" in order("empty_at_station")[1], 10.0)
    tell(False, 0.2)
    wait_until(lambda: order("empty_at_station")[0], 10.0, "it is taken")
    world.does("emptying", 10.0)
    wait_until(lambda: world.counts["/emptying_wanted"] > 5, 10.0, "it is told again and again")
    tell(True, 0.2)
    before = world.counts["/emptying_wanted"]
    wait_until(lambda: world.counts["/emptying_wanted"] > before + 5, 10.0, "it goes on")
    tell(False, 0.3)
    world.does("docked", 10.0)
    wait_until(lambda: not world.newest["/emptying_wanted"].data, 10.0, "it is told to end")


def test_a_killed_node_goes_on_with_its_clean_and_keeps_its_zones(graph: RosGraph) -> None:
    world, node = start(graph)
    world.x, world.is_docked = 0.0, False
    world.does("idle", 30.0)
    zone = Zone("bowl", Zone.NO_GO, [Point(-1, -1, 0), Point(-0.5, -1, 0), Point(-0.5, -0.5, 0)])
    assert rospy.ServiceProxy("/set_zone", SetZone)(zone).message == "the zones are: bowl"
    clean = client("clean", CleanAction)
    clean.send_goal(CleanGoal())
    world.does("cleaning")
    wait_until(lambda: world.state.seconds_to_go > 0.0, 30.0)
    usual = world.state.seconds_to_go
    graph.set_param("/robot_max_speed", 0.1)
    wait_until(lambda: world.state.seconds_to_go > 2.5 * usual, 30.0, "it reckons with 0.1 m/s")
    graph.set_param("/robot_max_speed", 0.5)
    wait_until(lambda: not world.wants(0.0) or world.newest["/cmd_vel_mission"].angular.z, 30.0)
    wanted = world.state.wanted
    memory = graph.folder / "ros_home" / "roomba_robot" / "mission" / "robot"
    wait_until(lambda: list(memory.glob("*.json")), 30.0, "it is remembered")
    graph.signal(NODE, signal.SIGKILL)
    node.ends(30.0)
    world.newest.clear()
    graph.rosrun("mission_node.py")
    world.does("cleaning")
    assert math.isclose(world.state.wanted, wanted, rel_tol=1e-4)
    assert [zone.name for zone in world.newest["/zones"].zones] == ["bowl"]
    # Its client's goal is served on.
    world.newest.pop("/clean/status", None)
    told = world.next("/clean/status", GoalStatusArray)
    assert [status.status for status in told.status_list] == [GoalStatus.ACTIVE]
    assert clean.get_state() == GoalStatus.ACTIVE

    # Another program steers: the mission gives way, once it no longer lets a walk end.
    steered = Twist()
    steered.angular.z = 0.5

    def is_noticed() -> bool:
        world.send("/cmd_vel", steered)
        return bool(world.state.phase == "paused")

    wait_until(is_noticed, 30.0, "the mission gives way")
    assert "driven by hand or by another program" in world.state.message
    assert order("resume")[0]
    world.does("cleaning", 30.0)

    # The place is told no more: it stands, and asks for nothing but to find it again.
    world.is_silent = True
    wait_until(lambda: world.newest["/cmd_vel_mission"] == Twist(), 30.0, "it stands")
    assert order("stop") == (True, "stopped")
    world.does("idle", 30.0)
    assert ends(clean, 30.0) == GoalStatus.PREEMPTED
    assert clean.get_goal_status_text() == "it was told to stop"
