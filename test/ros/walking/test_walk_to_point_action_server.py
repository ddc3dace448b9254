import math
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise

import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from fixtures.graph import RosGraph
from fixtures.probe import Probe, Walker
from fixtures.waiting import wait_until
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseActionGoal, MoveBaseGoal
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from roomba_robot.msg import RobotPosition
from roomba_robot.srv import EmergencyStop
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

from roomba.configuration.robot import RobotConfig
from roomba_ros.runtime.action_client import ActionClient

SCRIPT = "walk_to_point_action_server.py"
SERVER = "/walk_to_point_action_server_node"
SOON = {"senses": 0.5}
"""s of wall time after which it takes goals though nothing tells it map and pose."""


def serving(graph: RosGraph) -> bool:
    return SERVER in graph.system_state()[0].get("/walk_to_point/status", [])


def test_a_second_server_is_refused_by_name_and_by_topic(graph: RosGraph) -> None:
    """One server walks the robot: a second one ends with an error, and the first goes on."""
    graph.configure_nodes(deadlines=SOON)
    first = graph.rosrun(SCRIPT)
    wait_until(lambda: serving(graph), 30.0)
    for arguments in ((), ("__name:=another_server",)):
        second = graph.rosrun(SCRIPT, *arguments)
        assert second.ends(30.0) == 1
        assert f"refused: {SERVER}" in second.output
    assert first.status is None
    assert serving(graph)


def test_a_server_that_died_is_no_rival(graph: RosGraph) -> None:
    graph.configure_nodes(deadlines=SOON)
    first = graph.rosrun(SCRIPT)
    wait_until(lambda: serving(graph), 30.0)
    graph.signal(SERVER.strip("/"), signal.SIGKILL)
    first.ends(30.0)
    second = graph.rosrun(SCRIPT)
    wait_until(lambda: graph.answers(SERVER), 30.0, "the new server answers")
    assert second.status is None


def test_without_map_and_pose_a_goal_is_rejected_with_the_reason(graph: RosGraph) -> None:
    graph.configure_nodes(deadlines=SOON)
    graph.rosrun(SCRIPT)
    Probe(graph)
    walker = Walker()
    walker.send(1.0, 1.0)
    assert walker.ends(30.0) == 5
    assert "map and position" in walker.text


def stamped(x: float, y: float, frame: str = "map") -> PoseStamped:
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation.w = 1.0
    return message


def stand(probe: Probe, pose: PoseStamped) -> None:
    """Tell where a robot is whose wheels stand."""
    odometry = Odometry()
    odometry.header.stamp = pose.header.stamp = rospy.Time.now()
    odometry.pose.pose.orientation.w = 1.0
    probe.send("/odom", odometry)
    probe.send("/pose", pose)


def room() -> OccupancyGrid:
    message = OccupancyGrid(data=[0] * 6400)
    message.info.resolution, message.info.width, message.info.height = 0.05, 80, 80
    message.info.origin.position.x = message.info.origin.position.y = -2.0
    message.info.origin.orientation.w = 1.0
    return message


def test_move_base_is_the_same_walk_and_the_newest_goal_counts(graph: RosGraph) -> None:
    graph.rosrun(SCRIPT)
    probe = Probe(graph)
    probe.hear("/move_base/goal", MoveBaseActionGoal)
    probe.send("/map", room())
    stand(probe, stamped(0.0, 0.0))
    walker = Walker()
    client = ActionClient("move_base", MoveBaseAction)
    wait_until(lambda: client.wait_for_server(rospy.Duration(0.01)), 30.0)

    client.send_goal(MoveBaseGoal(stamped(1.0, 0.0, "odom")))
    wait_until(lambda: client.get_state() == GoalStatus.REJECTED, 30.0, "another frame")
    assert "'odom'" in client.get_goal_status_text()

    poses: list[PoseStamped] = []
    client.send_goal(
        MoveBaseGoal(stamped(1.0, 0.0)),
        feedback_cb=lambda message: poses.append(message.base_position),
    )
    assert 0.0 < probe.next("/change_position", RobotPosition).pos_x <= 1.0
    wait_until(lambda: poses, 30.0, "where it is")

    walker.send(-1.0, 0.0)
    wait_until(lambda: client.get_state() == GoalStatus.PREEMPTED, 30.0, "the newer goal counts")
    assert client.get_goal_status_text() == "a newer goal took over"

    probe.send("/move_base_simple/goal", stamped(0.0, 0.0))
    assert walker.ends(30.0) == GoalStatus.PREEMPTED
    wait_until(
        lambda: "-simple-" in probe.newest["/move_base/goal"].goal_id.id,
        30.0,
        "RViz's goal is an ordinary one",
    )

    wanted = stamped(0.0, 0.0)
    wanted.pose.orientation.z = wanted.pose.orientation.w = math.sqrt(0.5)
    client.send_goal(MoveBaseGoal(wanted))
    heading = probe.next("/change_heading", Float32)
    assert math.isclose(heading.data, 0.5 * math.pi, rel_tol=1e-6), "there it turns"
    wait_until(lambda: client.get_state() == GoalStatus.ACTIVE, 30.0, "it has not ended")
    stand(probe, wanted)
    wait_until(lambda: client.get_state() == GoalStatus.SUCCEEDED, 30.0, "it looks there")


def test_a_cancelled_walk_frees_the_speed_when_its_wish_to_stay_was_heard(graph: RosGraph) -> None:
    graph.rosrun(SCRIPT)
    probe = Probe(graph)
    told: list[tuple[str, float]] = []
    probe.send("/map", room())
    stand(probe, stamped(0.0, 0.0))
    walker = Walker()
    rospy.Subscriber("/change_speed", Float32, lambda m: told.append(("speed", m.data)))
    rospy.Subscriber("/change_position", RobotPosition, lambda m: told.append(("to", m.pos_x)))
    walker.send(1.0, 0.0)
    wait_until(lambda: told and told[-1] != ("speed", 0.0) and len(told) > 20, 30.0, "it walks")
    walker.cancel()
    assert walker.ends(30.0) == GoalStatus.PREEMPTED
    stops = told.index(("speed", 0.0))

    def freed() -> int:
        speeds = [at for at, (kind, value) in enumerate(told) if kind == "speed" and value > 0.0]
        return next((at for at in speeds if at > stops), 0)

    wait_until(freed, 30.0, "the speed is free again")
    stays = [what for what in told[stops : freed()] if what == ("to", 0.0)]
    assert len(stays) >= 3, "at 20 Hz it was told to stay"


BEAMS = 360
THING = (0.7, 0.0, 0.15)


def scan_of_room(stamp: rospy.Time, things: list[tuple[float, float, float]]) -> LaserScan:
    """Return what a lidar in the middle of :func:`room` sees of its walls and round things."""
    angles = 2.0 * math.pi / BEAMS * np.arange(BEAMS)
    away = 2.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    for x, y, radius in things:
        along = x * np.cos(angles) + y * np.sin(angles)
        across = x * np.sin(angles) - y * np.cos(angles)
        hits = (np.abs(across) < radius) & (along > 0.0)
        depth = along - np.sqrt(np.maximum(radius**2 - across**2, 0.0))
        away = np.where(hits, np.minimum(away, depth), away)
    message = LaserScan(
        angle_increment=2.0 * math.pi / BEAMS, range_min=0.1, range_max=8.0, ranges=away.tolist()
    )
    message.header.stamp = stamp
    return message


@contextmanager
def standing_robot(
    probe: Probe, things: list[tuple[float, float, float]], speed: float = 0.0
) -> Iterator[list[float]]:
    """Tell pose, odometry and scans of a robot in the middle of the room, scans 10 times a second.

    What is in ``things`` it sees from then on. Its wheels tell the newest of the speeds that are
    given back, m/s; the first one is ``speed``.
    """
    speeds = [speed]
    ended = threading.Event()
    poses, scans = probe.publisher("/pose", PoseStamped), probe.publisher("/scan", LaserScan)
    wheels = probe.publisher("/odom", Odometry)

    def tell() -> None:
        number = 0
        while not ended.wait(0.05):
            number += 1
            pose = stamped(0.0, 0.0)
            pose.header.stamp = rospy.Time.now()
            if number % 2:
                scans.publish(scan_of_room(pose.header.stamp, list(things)))
            odometry = Odometry(header=pose.header)
            odometry.pose.pose.orientation.w = 1.0
            odometry.twist.twist.linear.x = speeds[-1]
            wheels.publish(odometry)
            poses.publish(pose)

    teller = threading.Thread(target=tell, daemon=True)
    teller.start()
    try:
        yield speeds
    finally:
        ended.set()
        teller.join()


def test_while_a_cancelled_walk_brakes_its_setpoint_is_told_on(graph: RosGraph) -> None:
    """A stream that falls silent counts as one whose sender vanished."""
    graph.rosrun(SCRIPT)
    probe = Probe(graph)
    told: list[tuple[str, float]] = []
    rospy.Subscriber("/change_speed", Float32, lambda m: told.append(("speed", m.data)))
    rospy.Subscriber("/change_position", RobotPosition, lambda m: told.append(("to", m.pos_x)))
    probe.send("/map", room())
    with standing_robot(probe, [], 0.3) as speeds:
        walker = Walker()
        walker.send(1.0, 0.0)
        wait_until(lambda: len([what for what, _ in told if what == "to"]) > 5, 30.0, "it walks")
        walker.cancel()
        wait_until(lambda: told.count(("speed", 0.0)) > 5, 30.0, "it brakes")
        speeds.append(0.0)
        assert walker.ends(30.0) == GoalStatus.PREEMPTED
    braking = told[told.index(("speed", 0.0)) :]
    ahead = [x for what, x in braking if what == "to" and x > 0.05]
    assert len(ahead) >= 4


def test_the_emergency_stop_ends_a_walk_and_takes_no_other(graph: RosGraph) -> None:
    """Releasing it is no order to drive: what was asked for before is asked for again."""
    graph.rosrun(SCRIPT)
    graph.rosrun("speed_pub_node.py")
    probe = Probe(graph)
    probe.send("/map", room())
    probe.hear("/walk_to_point/status", GoalStatusArray)
    stop = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    with standing_robot(probe, []):
        walker = Walker()
        stop.wait_for_service(30.0)
        walker.send(1.0, 0.0)
        probe.next("/change_position", RobotPosition)
        assert stop(True, "a child came in").success
        assert walker.ends(30.0) == GoalStatus.ABORTED
        assert "a child came in" in walker.text
        walker.send(1.0, 0.0)
        assert walker.ends(30.0) == GoalStatus.REJECTED
        assert "release it first" in walker.text
        before, told = probe.counts["/change_position"], probe.counts["/walk_to_point/status"]
        assert stop(False, "").success
        # Five times a second.
        wait_until(lambda: probe.counts["/walk_to_point/status"] > told + 5, 30.0, "time passes")
        assert probe.counts["/change_position"] == before
        walker.send(1.0, 0.0)
        probe.next("/change_position", RobotPosition)


def nearest(path: Path, x: float, y: float) -> float:
    """Return how near a path comes to a point, m."""
    corners = np.array([(pose.pose.position.x, pose.pose.position.y) for pose in path.poses])
    shares = np.linspace(0.0, 1.0, 50)[:, None]
    legs = [a + shares * (b - a) for a, b in pairwise(corners)]
    return float(np.hypot(*(np.concatenate(legs) - (x, y)).T).min())


def test_what_the_lidar_sees_is_walked_around_and_forgotten_when_it_is_gone(
    graph: RosGraph,
) -> None:
    graph.rosrun(SCRIPT)
    probe = Probe(graph)
    probe.hear("/plan", Path)
    probe.send("/map", room())
    things: list[tuple[float, float, float]] = []
    keeps = RobotConfig().body.radius + THING[2]
    with standing_robot(probe, things):
        walker = Walker()
        walker.send(1.5, 0.0)
        wait_until(lambda: "/plan" in probe.newest, 30.0, "a plan")
        assert nearest(probe.newest["/plan"], *THING[:2]) < 0.01, "straight, for nothing is seen"
        things.append(THING)
        wait_until(
            lambda: nearest(probe.newest["/plan"], *THING[:2]) > keeps,
            30.0,
            "a way around what came",
        )
        things.clear()

        def goes_straight() -> bool:
            walker.send(1.5, 0.0)
            plan = probe.next("/plan", Path)
            return nearest(plan, *THING[:2]) < 0.01

        wait_until(goes_straight, 30.0, "the straight way again when it was taken away")
