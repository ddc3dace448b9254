import math
import signal
import threading
import time

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


def start(graph: RosGraph) -> SpeedProbe:
    graph.rosrun("speed_pub_node.py")
    return SpeedProbe(graph)


def test_limits_hold_and_a_changed_parameter_is_obeyed_within_a_second(graph: RosGraph) -> None:
    probe = start(graph)
    probe.want(2.0, 1.0)
    wait_until(lambda: probe.drive_gets(0.5, 0.25), 5.0, "the robot's top speed on the same arc")
    graph.set_param("/robot_max_speed", 0.2)
    wait_until(lambda: probe.drive_gets(0.2), 1.0, "the new top speed")
    probe.send("/change_speed", Float32(0.1))
    wait_until(lambda: probe.drive_gets(0.1), 2.0, "the cruise speed")


def test_a_bad_speed_limit_is_refused_put_back_and_the_old_one_stays(graph: RosGraph) -> None:
    """FAULTS row 28."""
    probe = start(graph)
    probe.want(2.0)
    wait_until(lambda: probe.drive_gets(0.5), 5.0)
    for bad in (-9.0, 0, "fast"):
        graph.set_param("/robot_max_speed", bad)
        wait_until(lambda: graph.param("/robot_max_speed") == 0.5, 2.0, f"{bad} is put back")
        assert probe.drive_gets(0.5)


def test_the_reports_other_spellings_mean_the_same(graph: RosGraph) -> None:
    graph.set_param("/min_cordinate", -100.0)
    graph.set_param("/max_cordinate", 100.0)
    start(graph)
    graph.set_param("/max_coordinate", 5.0)
    wait_until(lambda: graph.param("/max_cordinate") == 5.0, 3.0, "it is taken over")
    graph.set_param("/min_coordinate", 77.0)
    wait_until(lambda: graph.param("/min_cordinate") == -100.0, 3.0, "a wrong one is refused")


def test_bad_wishes_are_refused_and_the_old_ones_stay(graph: RosGraph) -> None:
    """FAULTS row 26: change_speed inf."""
    probe = start(graph)
    probe.want(2.0)
    probe.send("/change_speed", Float32(0.3))
    wait_until(lambda: probe.drive_gets(0.3), 5.0)
    for bad in (math.inf, math.nan, -1.0):
        probe.send("/change_speed", Float32(bad))
    probe.want(math.nan)
    time.sleep(0.3)
    assert probe.drive_gets(0.3)


def test_silence_stops_the_drive_within_its_time_out(graph: RosGraph) -> None:
    probe = start(graph)
    probe.want(0.4)
    wait_until(lambda: probe.drive_gets(0.4), 5.0)
    probe.wanted = None
    silent = time.monotonic()
    wait_until(lambda: probe.drive_gets(0.0), 2.0, "standstill")
    assert 0.3 < time.monotonic() - silent < 0.9


def test_the_mission_drives_while_nobody_else_does(graph: RosGraph) -> None:
    probe = start(graph)
    mission = probe.publisher("/cmd_vel_mission", Twist)
    wait_until(lambda: mission.get_num_connections() > 0, 10.0)
    wish = Twist()
    wish.linear.x = 3.0

    def drives(linear: float) -> bool:
        mission.publish(wish)
        time.sleep(0.05)
        return probe.drive_gets(linear)

    wait_until(lambda: drives(0.5), 5.0, "the mission drives, within the same limit")
    probe.want(-0.2)
    wait_until(lambda: drives(-0.2), 2.0, "who steers directly comes first")
    time.sleep(0.3)
    assert probe.drive_gets(-0.2)
    probe.wanted = None
    wait_until(lambda: drives(0.5), 2.0, "the mission drives again")


def test_an_emergency_stop_holds_and_outlives_the_node(graph: RosGraph) -> None:
    probe = start(graph)
    probe.want(0.4)
    wait_until(lambda: probe.drive_gets(0.4), 5.0)
    call = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    assert call(True, "a child came in").success
    assert probe.next("/emergency_stop", String).data == "a child came in"
    wait_until(lambda: probe.drive_gets(0.0), 1.0, "it stands")
    old = graph.signal("speed_pub_node", signal.SIGKILL)
    graph.programs[-1].ends(5.0)
    probe.newest.clear()
    graph.rosrun("speed_pub_node.py")
    wait_until(lambda: graph.answers("speed_pub_node"), 15.0)
    assert graph.pid("speed_pub_node") != old
    wait_until(lambda: probe.drive_gets(0.0), 10.0, "the new node tells the drive to stand")
    assert probe.newest["/emergency_stop"].data == "a child came in"
    time.sleep(0.3)
    assert probe.drive_gets(0.0)
    assert call(False, "").message == "the drive is free again"
    wait_until(lambda: probe.drive_gets(0.4), 2.0, "it drives")
    assert probe.newest["/emergency_stop"].data == ""


def test_a_pressed_bumper_lets_nothing_push(graph: RosGraph) -> None:
    probe = start(graph)
    probe.want(0.4, 1.0)
    wait_until(lambda: probe.drive_gets(0.4, 1.0), 5.0)
    probe.send("/bumper", Bumper(is_left_pressed=True))
    wait_until(lambda: probe.drive_gets(0.0, 1.0), 1.0, "no pushing, but turning")
    probe.want(-0.2)
    wait_until(lambda: probe.drive_gets(-0.2), 1.0, "backing off")


def test_it_tells_the_speed_of_the_body(graph: RosGraph) -> None:
    probe = start(graph)
    odometry = Odometry()
    odometry.twist.twist.linear.x = -0.3
    probe.send("/odom", odometry)
    assert math.isclose(probe.next("/speed", Float32).data, 0.3, abs_tol=1e-6)


def test_a_flood_of_wishes_does_not_slow_it(graph: RosGraph) -> None:
    """FAULTS row 30: 10,000 messages a second, and speed still comes at 10 Hz."""
    probe = start(graph)
    probe.send("/odom", Odometry())
    probe.next("/speed", Float32)
    flood = probe.publisher("/change_speed", Float32)
    wait_until(lambda: flood.get_num_connections() > 0, 5.0)
    before, begin = probe.counts["/speed"], time.monotonic()
    sent = 0
    while time.monotonic() - begin < 2.0:
        for _ in range(100):
            flood.publish(0.3)
        sent += 100
        time.sleep(max(0.0, begin + sent / 10_000 - time.monotonic()))
    rate = (probe.counts["/speed"] - before) / (time.monotonic() - begin)
    assert sent > 8_000
    assert rate > 8.5
