import math
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import rosgraph
import rospy
from fixtures.graph import RosGraph
from fixtures.nodes.refusal import refusal
from fixtures.nodes.simulated import Body, simulated, twist
from fixtures.nodes.standstill import PROMISE
from fixtures.probe import Probe
from fixtures.waiting import unchanged, wait_until
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import Bumper, SimHome
from roomba_robot.srv import InjectFault, SetDoor, SpillDirt, TurnCamera
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float32, Time
from std_srvs.srv import Trigger

from roomba.geometry import Pose
from roomba_ros.simulation.home_sim_node import main

TICK = 0.05
"""s of the robot's clock."""
STATION = Pose(0.3, 5.0, math.pi)
"""Of the apartment."""


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The simulation of the apartment, twice as fast as real time."""
    with simulated(tmp_path_factory.mktemp("home"), "_home:=apartment", "_speed:=2") as graph:
        yield graph


@pytest.fixture
def follower(tmp_path: Path) -> Iterator[RosGraph]:
    """The simulation of the apartment by the clock of another one."""
    with simulated(tmp_path, "_home:=apartment", "_clock:=false") as graph:
        yield graph


@pytest.mark.parametrize(
    ("parameter", "value", "said"),
    [
        ("/robot_max_speed", -0.5, "robot_max_speed"),
        ("/robot_max_speed", "fast", "robot_max_speed"),
        ("/max_cordinate", -500.0, "min_cordinate"),
        ("/home_sim_node/home", "no_such_home", "no_such_home"),
        ("/home_sim_node/speed", 0, "speed"),
        ("/home_sim_node/seed", -3, "seed"),
        ("/home_sim_node/sensors", "broken", "ideal or noisy"),
        ("/home_sim_node/empties", "often", "true or false"),
        ("/home_sim_node/drive_owner", 3, "a node's name"),
        ("/initial_post_x", 77.0, "does not fit"),
    ],
)
def test_a_wrong_parameter_ends_it_with_one_clear_line(
    master: RosGraph, parameter: str, value: object, said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """A missing or damaged home, and a value that makes no sense, are named before it starts."""
    master.set_param(parameter, value)
    try:
        assert said in refusal(main, master, capfd)
    finally:
        master.delete_param(parameter)


def test_a_second_clock_is_refused(master: RosGraph, capfd: pytest.CaptureFixture[str]) -> None:
    other = rosgraph.Master("/first/home_sim_node", master.uri)
    # The master itself stands for a node that answers.
    other.registerPublisher("/clock", "rosgraph_msgs/Clock", master.uri)
    try:
        line = refusal(main, master, capfd)
    finally:
        other.unregisterPublisher("/clock", master.uri)
    assert "but /first/home_sim_node publishes /clock; say clock:=false" in line


def test_its_script_ends_by_a_wrong_parameter_too(master: RosGraph) -> None:
    node = master.rosrun("home_sim_node.py", "_home:=no_such_home")
    assert node.ends(60.0) == 1
    assert "no_such_home" in node.output


def test_who_owns_no_clock_goes_by_that_of_another(follower: RosGraph) -> None:
    probe = Probe(follower)
    track: list[tuple[float, float]] = []
    rospy.Subscriber(
        "/odom",
        Odometry,
        lambda m: track.append((m.header.stamp.to_sec(), m.pose.pose.position.x)),
    )
    now = 100.0

    def is_there() -> bool:
        return bool(track) and track[-1][0] == pytest.approx(now)

    while now < 106.0:
        # Two ticks at once, and twice as fast as real time; a command counts for 0.15 s.
        now += 0.1
        probe.send("/cmd_vel_out", twist(-0.2))
        probe.send("/clock", Clock(rospy.Time.from_sec(now)), receivers=2)
        time.sleep(0.05)
        if now > 101.0:
            wait_until(is_there, 30.0, "it is as far as the clock")
    steady = [row for row in track if row[0] > 102.0]
    (begin, from_x), (end, to_x) = steady[0], steady[-1]
    assert end - begin > 3.0
    assert abs(to_x - from_x) / (end - begin) == pytest.approx(0.2, rel=0.1)
    # Nor does it go when that one stands.
    assert unchanged(lambda: track[-1][0], 0.5)
    assert is_there()


def test_the_body_drives_and_a_command_that_is_not_repeated_stops_it(follower: RosGraph) -> None:
    """By a clock of the test's own, which waits for each message: no machine is too slow for it."""
    probe = Probe(follower)
    now = 100.0

    def step() -> Odometry:
        """Let a tick pass, and return what the wheels tell then."""
        nonlocal now
        now = round(now + TICK, 2)
        probe.send("/clock", Clock(rospy.Time.from_sec(now)), receivers=2)
        wait_until(is_there, 30.0, "it is as far as the clock")
        return probe.newest["/odom"]

    def is_there() -> bool:
        told = probe.newest.get("/odom")
        return told is not None and told.header.stamp.to_sec() == pytest.approx(now)

    probe.hear("/odom", Odometry)
    begin = step().pose.pose.position.x
    for _ in range(100):
        probe.send("/cmd_vel_out", twist(-0.4))
        told = step()
        is_fast = told.twist.twist.linear.x == pytest.approx(-0.4, abs=0.03)
        if is_fast and abs(told.pose.pose.position.x - begin) > 0.2:
            break
    else:
        pytest.fail("it does not drive")
    speeds = [step().twist.twist.linear.x for _ in range(20)]
    stood = next(at for at, speed in enumerate(speeds) if speed == 0.0)
    # The last command was told two steps before the first of these speeds.
    assert TICK * (stood + 2) <= PROMISE + 1e-6
    assert not any(speeds[stood:])


def test_a_node_that_drives_and_falls_behind_is_waited_for(shared_robot: RosGraph) -> None:
    probe = Probe(shared_robot)

    def held() -> bool:
        # Here no mission runs: this test tells how far one is.
        probe.send("/mission_node/progress", Time(rospy.Time.now()))
        end = time.monotonic() + 1.5  # it goes on without it after 2 s
        while time.monotonic() < end:
            if unchanged(rospy.get_time, 0.5):
                return True
        return False

    wait_until(held, 30.0, "the clock stands")
    told = rospy.get_time()
    wait_until(lambda: rospy.get_time() > told + 2.0, 30.0, "it goes on without it")


def test_what_cannot_be_driven_is_refused(shared_robot: RosGraph) -> None:
    body = Body(shared_robot, Pose(1.0, 5.0, 0.0))
    wait_until(lambda: body.odometry().twist.twist.angular.z == 0.0, 10.0, "it stands")
    before = body.odometry().pose.pose
    body.probe.send("/cmd_vel_out", twist(math.nan))
    body.drive(0.0, 1.0, lambda: abs(body.odometry().twist.twist.angular.z) > 0.5, "it turns")
    after = body.odometry().pose.pose
    assert math.dist(
        (after.position.x, after.position.y), (before.position.x, before.position.y)
    ) == pytest.approx(0.0, abs=0.02)
    assert after.orientation.z != before.orientation.z


def test_it_puts_the_robot_at_the_homes_station_and_says_where(shared_robot: RosGraph) -> None:
    assert shared_robot.param("/initial_post_x") == pytest.approx(STATION.x)
    assert shared_robot.param("/initial_post_y") == pytest.approx(STATION.y)
    assert shared_robot.param("/initial_post_theta") == pytest.approx(STATION.theta)
    known = Body(shared_robot, STATION).probe.next("/map", OccupancyGrid)
    assert (known.info.width, known.info.height) == (204, 204)


def test_the_bumper_is_told(shared_robot: RosGraph) -> None:
    body = Body(shared_robot, STATION)
    body.probe.hear("/bumper", Bumper)

    def is_pressed() -> bool:
        bumper = body.probe.newest.get("/bumper", Bumper())
        return bool(bumper.is_left_pressed and bumper.is_right_pressed)

    assert not is_pressed()
    body.drive(0.4, 0.0, is_pressed, "it feels the station")


def test_crumbs_can_be_spilled_and_are_felt(shared_robot: RosGraph) -> None:
    probe = Body(shared_robot, STATION).probe
    spill = rospy.ServiceProxy("/sim/spill", SpillDirt)
    spill.wait_for_service(10.0)
    before = probe.next("/dirt_raw", Float32).data
    assert spill(STATION.x, STATION.y, 0.05, 7.0).success
    wait_until(lambda: probe.next("/dirt_raw", Float32).data > before + 5.0, 15.0)
    refused = spill(1000.0, 0.0, 0.05, 7.0)
    assert not refused.success
    assert "no floor" in refused.message


def test_a_bin_can_be_emptied_and_its_level_tells(shared_robot: RosGraph) -> None:
    body = Body(shared_robot, STATION)
    body.probe.hear("/bin_level", Float32)

    def level() -> float:
        return float(body.probe.newest.get("/bin_level", Float32(-1.0)).data)

    spill = rospy.ServiceProxy("/sim/spill", SpillDirt)
    spill.wait_for_service(10.0)
    assert spill(STATION.x, STATION.y, 0.3, 7.0).success
    body.drive(-0.2, 0.0, lambda: level() > 0.0, "it picks up crumbs")
    empty = rospy.ServiceProxy("/sim/empty_bin", Trigger)
    answer = empty()
    assert answer.success
    assert answer.message.endswith("g were in the bin")
    # It still rolls over some crumbs.
    wait_until(lambda: empty().success and level() == 0.0, 15.0)


def test_doors_are_moved_and_the_truth_is_told(shared_robot: RosGraph) -> None:
    """Of the home, of what was put down, of the dirt, and of the place of the robot."""
    probe = Body(shared_robot, STATION).probe
    pose = probe.next("/sim/pose", PoseStamped).pose.position
    assert math.dist((pose.x, pose.y), (STATION.x, STATION.y)) < 0.05
    before = probe.next("/sim/dirt", OccupancyGrid)
    assert 0 <= min(before.data) < max(before.data) <= 100
    first = probe.next("/sim/home", SimHome)
    set_door = rospy.ServiceProxy("/sim/set_door", SetDoor)
    door = first.doors[0]
    assert not door.shut

    probe.hear("/sim/home", SimHome)
    assert set_door(door.name, True).success
    wait_until(lambda: home_now(probe).doors[0].shut, 15.0, "a shut door")
    assert set_door(door.name, False).success
    wait_until(lambda: not home_now(probe).doors[0].shut, 15.0, "an open door")
    refused = set_door("gate", True)
    assert not refused.success
    assert door.name in refused.message
    interfere = rospy.ServiceProxy("/sim/inject_fault", InjectFault)
    assert interfere("obstacle", 0.1, 2.0, 2.0, 0.0).success
    wait_until(lambda: len(home_now(probe).things) == len(first.things) + 1, 15.0, "a thing")
    assert interfere("no_obstacles", 1.0, 0.0, 0.0, 0.0).success
    assert interfere("lifted", 1.0, 0.0, 0.0, 0.0).success
    wait_until(lambda: home_now(probe).lifted, 15.0, "a lifted robot")
    assert interfere("lifted", 0.0, 0.0, 0.0, 0.0).success
    wait_until(lambda: not home_now(probe).lifted, 15.0, "a robot on the floor")
    spill = rospy.ServiceProxy("/sim/spill", SpillDirt)
    assert spill(2.0, 2.0, 0.25, 6.0).success
    wait_until(
        lambda: sum(probe.next("/sim/dirt", OccupancyGrid).data) > sum(before.data) + 1000,
        15.0,
        "dirt on the floor",
    )


def home_now(probe: Probe) -> SimHome:
    return probe.newest["/sim/home"]


def test_pictures_are_taken_at_any_angle_that_the_camera_can_turn_to(
    shared_robot: RosGraph,
) -> None:
    Body(shared_robot, STATION)
    capture = rospy.ServiceProxy("/camera/capture", TurnCamera)
    capture.wait_for_service(10.0)
    left, right = capture(20.0).image, capture(-20.0).image
    assert (left.width, left.height, left.encoding) == (1024, 768, "rgb8")
    assert left.data != right.data
    for wrong in (31.0, math.nan):
        with pytest.raises(rospy.ServiceException, match="expected an angle from -30 to 30"):
            capture(wrong)


def test_the_clock_moves_by_whole_steps_only(shared_robot: RosGraph) -> None:
    """Time passes by the simulation's steps, not by the wall clock."""
    body = Body(shared_robot, STATION)
    first = rospy.get_rostime()
    wait_until(lambda: rospy.get_rostime() > first, 10.0, "time passes")
    body.odometry()
    passed = rospy.get_rostime() - first
    assert passed.to_nsec() % 50_000_000 == 0
