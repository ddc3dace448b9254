import math
import signal
import threading
import time
from collections.abc import Iterator
from functools import partial
from itertools import pairwise

import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from roomba_robot.msg import Bumper
from roomba_robot.srv import EmergencyStop
from std_msgs.msg import Float32, String


class SpeedProbe(Probe):
    """Asks the speed node for velocities, again and again, and hears what the drive gets."""

    def __init__(self, graph: RosGraph) -> None:
        super().__init__(graph)
        self.hear("/cmd_vel_out", Twist)
        self.wanted: Twist | None = None
        self._commands = self.publisher("/cmd_vel", Twist)
        wait_until(lambda: self._commands.get_num_connections() > 0, 10.0)
        threading.Thread(target=self._command, daemon=True).start()

    def _command(self) -> None:
        # A program that steers: 20 commands a second.
        while not rospy.is_shutdown():
            if self.wanted is not None:
                self._commands.publish(self.wanted)
            time.sleep(0.05)

    def want(self, linear: float, angular: float = 0.0) -> None:
        self.wanted = Twist()
        self.wanted.linear.x, self.wanted.angular.z = linear, angular

    def drive_gets(self, linear: float, angular: float | None = None) -> bool:
        message = self.newest.get("/cmd_vel_out")
        return (
            message is not None
            and math.isclose(message.linear.x, linear, abs_tol=1e-6)
            and (angular is None or math.isclose(message.angular.z, angular, abs_tol=1e-6))
        )


@pytest.fixture(scope="module")
def node(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The node, for tests after each of which it drives on."""
    with RosGraph(tmp_path_factory.mktemp("speed")) as graph:
        graph.start_master()
        graph.set_param("/robot_max_speed", 0.5)
        graph.set_param("/min_cordinate", -100.0)
        graph.set_param("/max_cordinate", 100.0)
        graph.rosrun("speed_pub_node.py")
        yield graph


def start(graph: RosGraph) -> SpeedProbe:
    """Become the program that steers; nothing is left of the commands of a test before."""
    probe = SpeedProbe(graph)
    graph.set_param("/robot_max_speed", 0.5)
    probe.send("/bumper", Bumper())
    probe.send("/change_speed", Float32(0.5))
    probe.want(2.0)
    wait_until(lambda: probe.drive_gets(0.5), 20.0, "the top speed")
    return probe


def test_limits_hold_and_a_changed_parameter_is_obeyed(node: RosGraph) -> None:
    probe = start(node)
    probe.want(2.0, 1.0)
    wait_until(lambda: probe.drive_gets(0.5, 0.25), 20.0, "the robot's top speed on the same arc")
    node.set_param("/robot_max_speed", 0.2)
    wait_until(lambda: probe.drive_gets(0.2), 20.0, "the new top speed")
    probe.send("/change_speed", Float32(0.1))
    wait_until(lambda: probe.drive_gets(0.1), 20.0, "the cruise speed")


def test_a_bad_speed_limit_is_refused_put_back_and_the_old_one_stays(node: RosGraph) -> None:
    """A top speed that is no positive number has no effect, and the parameter is put back."""
    probe = start(node)
    probe.want(2.0)
    wait_until(lambda: probe.drive_gets(0.5), 20.0)
    for bad in (-9.0, 0, "fast"):
        node.set_param("/robot_max_speed", bad)
        wait_until(lambda: node.param("/robot_max_speed") == 0.5, 20.0, f"{bad} is put back")
        probe.newest.clear()
        wait_until(lambda: probe.drive_gets(0.5), 20.0, "the old one")


def test_the_reports_other_spellings_mean_the_same(node: RosGraph) -> None:
    node.set_param("/max_coordinate", 5.0)
    wait_until(lambda: node.param("/max_cordinate") == 5.0, 20.0, "it is taken over")
    node.set_param("/min_coordinate", 77.0)
    wait_until(lambda: node.param("/min_cordinate") == -100.0, 20.0, "a wrong one is refused")


def refusals(node: RosGraph) -> int:
    return node.programs[-1].output.count("change_speed refused")


def has_refused_more(node: RosGraph, before: int) -> bool:
    return refusals(node) > before


def test_bad_wishes_are_refused_and_the_old_ones_stay(node: RosGraph) -> None:
    """A speed that is not finite, or negative, has no effect and is logged."""
    probe = start(node)
    probe.want(2.0)
    probe.send("/change_speed", Float32(0.3))
    wait_until(lambda: probe.drive_gets(0.3), 20.0)
    for bad in (math.inf, math.nan, -1.0):
        before = refusals(node)
        probe.send("/change_speed", Float32(bad))
        wait_until(partial(has_refused_more, node, before), 20.0)
    wish = Twist()
    wish.linear.x = math.nan

    def is_refused() -> bool:
        # A busy node takes the newest of several commands, and others are sent meanwhile.
        probe.send("/cmd_vel", wish)
        return "cmd_vel refused" in node.programs[-1].output

    wait_until(is_refused, 20.0)
    probe.newest.clear()
    wait_until(lambda: probe.drive_gets(0.3), 20.0, "the old ones")


def test_ten_commands_a_second_drive_without_a_halt(node: RosGraph) -> None:
    """Of a sender that is late itself nothing is expected: it tries again."""
    probe = start(node)
    probe.wanted = None
    gets: list[float] = []
    rospy.Subscriber("/cmd_vel_out", Twist, lambda message: gets.append(message.linear.x))
    command, sender = Twist(), probe.publisher("/cmd_vel", Twist)
    command.linear.x = 0.3

    def is_steady() -> bool:
        gets.clear()
        sent = [time.monotonic()]
        sender.publish(command)
        while len(sent) < 25:
            # A program that steers ten times a second.
            time.sleep(max(0.0, sent[-1] + 0.1 - time.monotonic()))
            sent.append(time.monotonic())
            sender.publish(command)
        return max(b - a for a, b in pairwise(sent)) < 0.12

    wait_until(is_steady, 60.0, "commands that come in time")
    assert len(gets) > 40
    assert min(gets[5:]) == pytest.approx(0.3)


def test_a_flood_of_commands_makes_no_flood_for_the_drive(node: RosGraph) -> None:
    """Between two of the loop's own messages, 20 a second, one more at most for each topic."""
    probe = start(node)
    probe.wanted = None
    stamps: list[float] = []
    rospy.Subscriber("/cmd_vel_out", Twist, lambda _: stamps.append(time.monotonic()))
    wait_until(lambda: len(stamps) > 3, 20.0, "it tells the drive")
    flood, command = probe.publisher("/cmd_vel", Twist), Twist()
    stamps.clear()
    began = time.monotonic()
    for number in range(5000):
        command.linear.x = 0.1 + 1e-5 * number
        flood.publish(command)
    elapsed = time.monotonic() - began
    wait_until(lambda: probe.drive_gets(command.linear.x), 20.0, "the newest one is obeyed")
    assert len([stamp for stamp in stamps if stamp < began + elapsed]) <= 2 * (20 * elapsed + 2)
    assert 5000 / elapsed > 1000.0


def test_silence_stops_the_drive(node: RosGraph) -> None:
    probe = start(node)
    probe.want(0.4)
    wait_until(lambda: probe.drive_gets(0.4), 20.0)
    probe.wanted = None
    wait_until(lambda: probe.drive_gets(0.0), 20.0, "standstill")


def test_the_mission_drives_while_no_other_program_does(node: RosGraph) -> None:
    probe = start(node)
    probe.wanted = None
    wait_until(lambda: probe.drive_gets(0.0), 20.0, "no command is fresh")
    mission = probe.publisher("/cmd_vel_mission", Twist)
    wait_until(lambda: mission.get_num_connections() > 0, 10.0)
    wish = Twist()
    wish.linear.x = 3.0

    def drives(linear: float) -> bool:
        mission.publish(wish)
        return probe.drive_gets(linear)

    wait_until(lambda: drives(0.5), 20.0, "the mission drives, within the same limit", pause=0.05)
    probe.want(-0.2)
    wait_until(lambda: drives(-0.2), 20.0, "direct steering comes first", pause=0.05)
    probe.wanted = None
    wait_until(lambda: drives(0.5), 20.0, "the mission drives again", pause=0.05)


def test_an_emergency_stop_holds_and_outlives_the_node(graph: RosGraph) -> None:
    graph.rosrun("speed_pub_node.py")
    probe = SpeedProbe(graph)
    probe.want(0.4)
    wait_until(lambda: probe.drive_gets(0.4), 20.0)
    call = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    assert call(True, "a child came in").success
    assert probe.next("/emergency_stop", String).data == "a child came in"
    wait_until(lambda: probe.drive_gets(0.0), 20.0, "it stands")
    old = graph.signal("speed_pub_node", signal.SIGKILL)
    graph.programs[-1].ends(20.0)
    probe.newest.clear()
    graph.rosrun("speed_pub_node.py")
    wait_until(lambda: graph.answers("speed_pub_node"), 40.0)
    assert graph.pid("speed_pub_node") != old
    wait_until(lambda: probe.drive_gets(0.0), 40.0, "the new node tells the drive to stand")
    wait_until(
        lambda: probe.newest.get("/emergency_stop") == String("a child came in"), 20.0, "it says so"
    )
    told: list[float] = []
    rospy.Subscriber("/cmd_vel_out", Twist, lambda message: told.append(message.linear.x))
    wait_until(lambda: len(told) > 10, 20.0, "the drive is told to stand, again and again")
    assert set(told) == {0.0}
    assert (
        call(True, "smoke\n\x00" + 100_000 * "!").message
        == "the drive is held: smoke  " + 193 * "!"
    )
    assert call(False, "").message == "the drive is free again"
    wait_until(lambda: probe.drive_gets(0.4), 20.0, "it drives")
    wait_until(lambda: probe.newest["/emergency_stop"].data == "", 20.0, "it says so")


def test_a_pressed_bumper_lets_nothing_push(node: RosGraph) -> None:
    probe = start(node)
    probe.want(0.4, 1.0)
    wait_until(lambda: probe.drive_gets(0.4, 1.0), 20.0)
    probe.send("/bumper", Bumper(is_left_pressed=True))
    wait_until(lambda: probe.drive_gets(0.0, 1.0), 20.0, "no pushing, but turning")
    probe.want(-0.2)
    wait_until(lambda: probe.drive_gets(-0.2), 20.0, "backing off")
    # The node of the next test is another one, of which this is not taken at once.
    probe.send("/bumper", Bumper())


def test_it_tells_the_speed_of_the_body(node: RosGraph) -> None:
    probe = start(node)
    odometry = Odometry()
    odometry.twist.twist.linear.x = -0.3
    probe.send("/odom", odometry)
    assert math.isclose(probe.next("/speed", Float32).data, 0.3, abs_tol=1e-6)


def test_a_flood_of_wishes_does_not_slow_it(node: RosGraph) -> None:
    """With 10,000 messages a second the speed still comes, at 10 Hz or nearly so."""
    probe = start(node)
    probe.send("/odom", Odometry())
    probe.next("/speed", Float32)
    flood = probe.publisher("/change_speed", Float32)
    before, begin = probe.counts["/speed"], time.monotonic()
    for sent in range(100, 20_001, 100):
        for _ in range(100):
            flood.publish(0.3)
        # A burst of a hundred each 10 ms.
        time.sleep(max(0.0, begin + sent / 10_000 - time.monotonic()))
    rate = (probe.counts["/speed"] - before) / (time.monotonic() - begin)
    # Each of 20,000 in a queue would hold it up.
    assert rate > 2.0
    wait_until(lambda: probe.drive_gets(0.3), 20.0, "the wish is obeyed")
