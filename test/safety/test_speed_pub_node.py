"""The speed node without a graph: its commands to the drive, and their times."""

from __future__ import annotations

import math
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
import rospy
from fixtures.nodes.lockstep import Lockstep
from geometry_msgs.msg import Twist as TwistMessage
from nav_msgs.msg import Odometry
from roomba_robot.msg import BodyState, Bumper, Cliff, WheelDrop
from roomba_robot.srv import EmergencyStop, EmergencyStopRequest
from std_msgs.msg import Float32, String

from roomba.files.kept import sealed, unsealed
from roomba.geometry import STANDSTILL, Twist
from roomba_ros.convert.common import twist_message, twist_of
from roomba_ros.speed import speed_pub_node
from roomba_ros.speed.speed_pub_node import EMERGENCY_PARAMETER, SpeedPubNode

TICK = 0.05
AHEAD = Twist(0.3, 0.1)


@dataclass
class Rig:
    """The node, and what it published."""

    graph: Lockstep
    node: SpeedPubNode = field(default_factory=SpeedPubNode)
    driven: list[Twist] = field(default_factory=list)
    speeds: list[float] = field(default_factory=list)
    held: list[str] = field(default_factory=list)

    def start(self, **parameters: object) -> Rig:
        """Start the node and listen to it."""
        for name, value in parameters.items():
            self.graph.parameters[f"/{name}"] = value
        self.graph.hear("cmd_vel_out", lambda told: self.driven.append(twist_of(told)))
        self.graph.hear("speed", lambda told: self.speeds.append(told.data))
        self.graph.hear("emergency_stop", lambda told: self.held.append(told.data))
        self.graph.start("speed_pub_node", self.node)
        return self

    def told(self, topic: str, message: Any, sender: str = "/test") -> list[Twist]:
        """Return the commands that the drive gets at once when a node's message comes."""
        before = len(self.driven)
        self.graph.publish(topic, message, sender)
        return self.driven[before:]

    def ticked(self, seconds: float = TICK) -> list[Twist]:
        """Return the commands that the drive gets at a tick."""
        before = len(self.driven)
        self.graph.tick(seconds)
        return self.driven[before:]

    def stop(self, reason: str = "fire", *, engage: bool = True) -> str:
        """Call the emergency stop; return its answer."""
        request = EmergencyStopRequest(engage, reason)
        answer = self.graph.call("/emergency_stop", request)
        self.graph.deliver()
        assert answer.success
        return str(answer.message)


@pytest.fixture
def rig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Rig:
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    return Rig(Lockstep().install(monkeypatch))


@pytest.fixture
def stop_file(tmp_path: Path) -> Path:
    """The file in which the robot keeps its emergency stop."""
    return tmp_path / "roomba_robot" / "emergency_stop" / "robot.txt"


def test_a_command_is_passed_on_at_once_and_then_at_ticks_until_it_is_old(rig: Rig) -> None:
    rig.start()
    assert rig.node.period == TICK
    assert rig.told("cmd_vel", twist_message(AHEAD)) == [AHEAD]
    assert [rig.ticked() for _ in range(4)] == [[AHEAD], [AHEAD], [STANDSTILL], [STANDSTILL]]


def test_of_a_flood_the_first_change_of_each_topic_is_passed_on_between_ticks(rig: Rig) -> None:
    rig.start()
    for first in (AHEAD, Twist(0.3, -0.1), AHEAD):
        assert rig.told("cmd_vel", twist_message(first)) == [first]
        assert rig.told("cmd_vel", twist_message(Twist(0.1, 0.0))) == []
        assert rig.told("cmd_vel", twist_message(Twist(0.4, 0.0))) == []
        assert rig.told("change_speed", Float32(0.2)) == [Twist(0.2, 0.0)]
        assert rig.told("change_speed", Float32(0.45)) == []
        assert rig.ticked() == [Twist(0.4, 0.0)]


def test_a_flood_of_one_source_holds_up_no_change_of_another(rig: Rig) -> None:
    rig.start()
    assert rig.told("cmd_vel_mission", twist_message(AHEAD)) == [AHEAD]
    assert rig.told("cmd_vel_mission", twist_message(Twist(0.2, 0.0))) == []
    assert rig.told("cmd_vel", twist_message(STANDSTILL)) == [STANDSTILL]


def test_what_changes_nothing_waits_for_the_tick_and_holds_up_no_change(rig: Rig) -> None:
    rig.start()
    assert rig.told("cmd_vel", twist_message(AHEAD)) == [AHEAD]
    assert rig.ticked() == [AHEAD]
    assert rig.told("cmd_vel", twist_message(AHEAD)) == []
    assert rig.told("cmd_vel_mission", twist_message(Twist(0.1, 0.0))) == []
    assert rig.told("change_speed", Float32(0.45)) == []
    assert rig.told("cmd_vel", twist_message(STANDSTILL)) == [STANDSTILL]
    assert rig.ticked() == [STANDSTILL]
    assert rig.told("change_speed", Float32(0.0)) == []
    assert rig.told("cmd_vel", twist_message(AHEAD)) == []
    assert rig.ticked() == [STANDSTILL]
    assert rig.told("change_speed", Float32(0.45)) == [AHEAD]


@pytest.mark.parametrize("parts", [(math.nan, 0.0), (0.0, math.inf)])
def test_what_is_no_number_drives_nothing(rig: Rig, parts: tuple[float, float]) -> None:
    rig.start()
    message = TwistMessage()
    message.linear.x, message.angular.z = parts
    assert rig.told("cmd_vel", message) == []
    assert rig.ticked() == [STANDSTILL]


def test_a_speed_that_is_wanted_limits_what_is_driven(rig: Rig) -> None:
    rig.start()
    rig.told("change_speed", Float32(0.1))
    assert rig.told("cmd_vel", twist_message(Twist(0.3, 0.3))) == [Twist(0.1, 0.1)]
    assert rig.told("change_speed", Float32(-1.0)) == []
    assert rig.ticked() == [Twist(0.1, 0.1)]


def test_the_robots_top_speed_limits_what_is_driven_from_the_next_tick_on(rig: Rig) -> None:
    rig.start(robot_max_speed=0.2)
    assert rig.told("cmd_vel", twist_message(Twist(0.4, 0.4))) == [Twist(0.2, 0.2)]
    rospy.set_param("/robot_max_speed", -9.0)
    rig.graph.tick(TICK)
    assert rospy.get_param("/robot_max_speed") == 0.2
    rospy.set_param("/robot_max_speed", 0.1)
    rig.graph.tick(TICK)
    rig.told("cmd_vel", twist_message(Twist(0.4, 0.4)))
    assert rig.ticked() == [Twist(0.1, 0.1)]


@pytest.mark.parametrize(
    ("topic", "on", "off", "driven"),
    [
        ("bumper", Bumper(is_left_pressed=True), Bumper(), Twist(-0.1, 0.0)),
        ("bumper", Bumper(is_right_pressed=True), Bumper(), Twist(-0.1, 0.0)),
        ("cliff", Cliff(is_cliff_front_left=True), Cliff(), Twist(-0.1, 0.0)),
        ("wheel_drop", WheelDrop(is_left_dropped=True), WheelDrop(), STANDSTILL),
        ("wheel_drop", WheelDrop(is_right_dropped=True), WheelDrop(), STANDSTILL),
    ],
)
def test_a_hazard_is_obeyed_at_once_and_its_end_at_the_next_tick(
    rig: Rig, topic: str, on: Any, off: Any, driven: Twist
) -> None:
    rig.start()
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.told(topic, on) == [driven]
    assert rig.told(topic, on) == []
    assert rig.ticked() == [driven]
    assert rig.told(topic, off) == []
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() == [AHEAD]


@pytest.mark.parametrize("battery", [0.5, 1.01, math.nan])
def test_what_the_body_tells_in_one_message_silences_no_hazard(rig: Rig, battery: float) -> None:
    rig.start()
    rig.told("body", BodyState(battery=0.5), "/body")
    rig.told("cmd_vel", twist_message(AHEAD))
    rig.ticked()
    rig.told("body", BodyState(is_left_pressed=True, battery=battery), "/body")
    assert rig.told("bumper", Bumper(is_left_pressed=True), "/body") == [Twist(-0.1, 0.0)]


def test_no_tick_changes_a_connection(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    rig.start()
    rig.told("body", BodyState(battery=0.5), "/body")
    monkeypatch.setattr(rospy, "Subscriber", _waits_for_the_master)
    rig.ticked()
    rig.graph.leave("body")
    assert rig.ticked() == [STANDSTILL]


def test_nothing_comes_between_what_was_decided_and_what_the_drive_is_told(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    locks: list[Any] = []
    new_lock = threading.Lock

    def kept() -> Any:
        locks.append(new_lock())
        return locks[-1]

    monkeypatch.setattr(threading, "Lock", kept)
    rig.start()
    held: list[bool] = []
    publish = type(rospy.Publisher("cmd_vel_out", TwistMessage)).publish

    def watched(publisher: Any, *told: Any, **fields: Any) -> None:
        if publisher.name == "/cmd_vel_out":
            held.append(any(lock.locked() for lock in locks))
        publish(publisher, *told, **fields)

    monkeypatch.setattr(type(rospy.Publisher("cmd_vel_out", TwistMessage)), "publish", watched)
    rig.told("cmd_vel", twist_message(AHEAD))
    rig.told("bumper", Bumper(is_left_pressed=True))
    rig.ticked()
    assert held == [True] * 3


def _waits_for_the_master(*_: Any, **__: Any) -> None:
    pytest.fail("a tick subscribed: without a master it waits without end")


def test_hazards_and_a_wanted_speed_do_not_use_up_each_others_turn(rig: Rig) -> None:
    rig.start()
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.told("change_speed", Float32(0.15)) == [Twist(0.15, 0.05)]
    assert rig.told("bumper", Bumper(is_left_pressed=True)) == [Twist(-0.1, 0.0)]
    assert rig.told("wheel_drop", WheelDrop(is_left_dropped=True)) == [STANDSTILL]


def test_one_hazard_ends_and_the_other_stays(rig: Rig) -> None:
    rig.start()
    rig.told("wheel_drop", WheelDrop(is_left_dropped=True))
    rig.told("bumper", Bumper(is_left_pressed=True))
    rig.told("bumper", Bumper())
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() == [STANDSTILL]


@pytest.mark.parametrize(
    ("topic", "on", "off"),
    [
        ("bumper", Bumper(is_left_pressed=True), Bumper()),
        ("cliff", Cliff(is_cliff_front_left=True), Cliff()),
        ("wheel_drop", WheelDrop(is_left_dropped=True), WheelDrop()),
    ],
)
def test_another_node_ends_no_hazard_and_makes_none_while_the_body_tells_it(
    rig: Rig, monkeypatch: pytest.MonkeyPatch, topic: str, on: Any, off: Any
) -> None:
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    rig.start()
    rig.told(topic, on, "/body")
    now[0] += 2.9
    rig.told(topic, off, "/other")
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() != [AHEAD]
    rig.told(topic, off, "/body")
    assert rig.told(topic, on, "/other") == []
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() == [AHEAD]
    now[0] += 3.1
    assert rig.told(topic, on, "/other") != []


def test_another_node_tells_no_speed_while_the_body_tells_it(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    rig.start()
    rig.graph.publish("odom", odometry(0.2), "/body")
    rig.graph.publish("odom", odometry(0.5), "/other")
    rig.graph.tick(TICK)
    now[0] += 1.1
    rig.graph.publish("odom", odometry(0.5), "/other")
    rig.graph.tick(2.0 * TICK)
    assert rig.speeds == pytest.approx([0.2, 0.5])


def test_why_the_drive_is_held_is_logged_once(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    lines: list[str] = []
    monkeypatch.setattr(rospy, "loginfo", lambda text, *rest: lines.append(text % rest))
    rig.start()
    rig.ticked()
    rig.told("bumper", Bumper(is_left_pressed=True))
    for _ in range(3):
        rig.told("cmd_vel", twist_message(AHEAD))
        rig.ticked()
    rig.told("bumper", Bumper())
    rig.told("cmd_vel", twist_message(AHEAD))
    rig.ticked()
    for _ in range(5):
        rig.ticked()
    assert lines == ["the drive is held: the bumper is pressed"]


def test_the_services_and_topics_that_wait_are_by_their_types(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    served: list[object] = []
    serve = rospy.Service

    def watched(name: str, kind: type, handler: Any) -> Any:
        served.extend((name, kind))
        return serve(name, kind, handler)

    monkeypatch.setattr(rospy, "Service", watched)
    rig.start()
    assert served == ["emergency_stop", EmergencyStop]


def test_the_emergency_stop_holds_at_once_is_told_and_answered(rig: Rig) -> None:
    rig.start()
    assert rig.held == [""]
    rig.told("cmd_vel", twist_message(AHEAD))
    before = len(rig.driven)
    assert rig.stop("smoke") == "the drive is held: smoke"
    assert rig.driven[before:] == [STANDSTILL]
    assert rig.held == ["", "smoke"]
    assert rospy.get_param(EMERGENCY_PARAMETER) == "smoke"
    assert rig.ticked() == [STANDSTILL]
    assert rig.told("cmd_vel", twist_message(AHEAD)) == []
    before = len(rig.driven)
    assert rig.stop("ignored", engage=False) == "the drive is free again"
    assert rig.driven[before:] == [STANDSTILL]
    assert rig.held == ["", "smoke", ""]
    assert rospy.get_param(EMERGENCY_PARAMETER) == ""
    assert rig.ticked() == [STANDSTILL]
    assert rig.told("cmd_vel", twist_message(AHEAD)) == [AHEAD]
    assert rig.stop(engage=False) == "the drive was not held"
    assert rig.graph.logged == [
        "emergency stop: smoke",
        "emergency stop released",
        "emergency stop released",
    ]


@pytest.mark.parametrize(
    ("reason", "shown"),
    [
        ("", "no reason was given"),
        (" \n\0 ", "no reason was given"),
        ("  a\nb\x1b[31m ", "a b [31m"),
        (1000 * "a", 200 * "a"),
        ("100 % sure: %s %d", "100 % sure: %s %d"),
    ],
)
def test_no_text_of_a_reason_keeps_the_robot_from_it(rig: Rig, reason: str, shown: str) -> None:
    rig.start()
    assert rig.stop(reason) == f"the drive is held: {shown}"
    assert rig.held == ["", shown]
    assert rig.graph.logged == [f"emergency stop: {shown}"]
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() == [STANDSTILL]


def test_a_node_that_was_killed_holds_again(rig: Rig) -> None:
    rig.start(emergency_stop="smoke")
    assert rig.held == ["smoke"]
    assert rig.graph.logged == ["the emergency stop still holds the drive: smoke"]
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() == [STANDSTILL]
    assert rig.stop(engage=False) == "the drive is free again"


@pytest.mark.parametrize("kept", ["", 7, True, ["fire"], None])
def test_what_is_kept_and_no_reason_holds_nothing(rig: Rig, kept: object) -> None:
    rig.start(emergency_stop=kept)
    assert rig.held == [""]
    assert rig.graph.logged == []
    assert rig.told("cmd_vel", twist_message(AHEAD)) == [AHEAD]


def test_a_master_that_is_gone_does_not_keep_it_from_holding(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig.start()

    def gone(*_: object) -> None:
        raise ConnectionRefusedError(111, "refused")

    monkeypatch.setattr(rospy, "set_param", gone)
    answer = rig.stop("smoke")
    assert answer.startswith(
        "the drive is held: smoke; but the master does not keep that, should this node end: "
    )
    assert "refused" in answer
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() == [STANDSTILL]


def test_the_stop_is_on_the_disk_before_the_answer_and_gone_before_that_of_its_release(
    rig: Rig, stop_file: Path
) -> None:
    rig.start()
    assert not stop_file.exists()
    request = EmergencyStopRequest(True, "smoke")
    assert rig.graph.call("/emergency_stop", request).message == "the drive is held: smoke"
    assert unsealed(stop_file.read_bytes()) == b"smoke"
    rig.stop(engage=False)
    assert not stop_file.exists()


def test_a_robot_that_was_killed_holds_again(rig: Rig, stop_file: Path) -> None:
    stop_file.parent.mkdir(parents=True)
    stop_file.write_bytes(sealed(b"smoke"))
    rig.start()
    assert rig.held == ["smoke"]
    assert rig.graph.logged == ["the emergency stop still holds the drive: smoke"]
    assert rospy.get_param(EMERGENCY_PARAMETER) == "smoke"
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() == [STANDSTILL]
    assert rig.stop(engage=False) == "the drive is free again"
    assert not stop_file.exists()


def test_what_the_disk_says_comes_before_what_the_master_says(rig: Rig, stop_file: Path) -> None:
    stop_file.parent.mkdir(parents=True)
    stop_file.write_bytes(sealed(b"fire"))
    rig.start(emergency_stop="smoke")
    assert rig.held == ["fire"]


def test_what_the_master_alone_has_is_kept_on_the_disk(rig: Rig, stop_file: Path) -> None:
    rig.start(emergency_stop="smoke")
    assert unsealed(stop_file.read_bytes()) == b"smoke"


def test_a_damaged_file_holds_and_says_so(rig: Rig, stop_file: Path) -> None:
    stop_file.parent.mkdir(parents=True)
    stop_file.write_bytes(b"")
    rig.start()
    (held,) = rig.held
    assert held.startswith(f"it counts as held, as {stop_file} is damaged: ")
    assert rig.graph.logged == [f"the emergency stop still holds the drive: {held}"]
    rig.told("cmd_vel", twist_message(AHEAD))
    assert rig.ticked() == [STANDSTILL]


def test_robots_in_namespaces_keep_their_own(
    rig: Rig, stop_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rospy, "get_namespace", lambda: "/home/X/")
    rig.start()
    rig.stop("smoke")
    assert unsealed((stop_file.parent / "home" / "X.txt").read_bytes()) == b"smoke"


def test_a_disk_that_refuses_does_not_keep_it_from_holding_and_is_told(
    rig: Rig, stop_file: Path
) -> None:
    stop_file.parent.parent.mkdir()
    stop_file.parent.write_bytes(b"no folder")
    rig.start()
    assert rig.held == [""]
    rig.told("cmd_vel", twist_message(AHEAD))
    forgotten = "it is forgotten if the robot is killed, as the disk refused: "
    answer = rig.stop("smoke")
    assert answer.startswith(f"the drive is held: smoke; but {forgotten}")
    assert rig.held == ["", "smoke", answer.removeprefix("the drive is held: ")]
    assert rig.graph.logged[0] == "emergency stop: smoke"
    assert rig.graph.logged[1].startswith(f"emergency stop: {forgotten}")
    assert rospy.get_param(EMERGENCY_PARAMETER) == "smoke"
    assert rig.ticked() == [STANDSTILL]
    assert rig.stop(engage=False) == "the drive is free again"


def test_disk_and_master_that_both_refuse_are_both_told(
    rig: Rig, stop_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stop_file.parent.parent.mkdir()
    stop_file.parent.write_bytes(b"no folder")
    rig.start()

    def gone(*_: object) -> None:
        raise ConnectionRefusedError(111, "refused")

    monkeypatch.setattr(rospy, "set_param", gone)
    answer = rig.stop("smoke")
    assert answer.startswith("the drive is held: smoke; but it is forgotten if the robot is killed")
    assert "; but the master does not keep that, should this node end: " in answer


def test_a_file_that_cannot_be_removed_does_not_keep_it_from_being_released(
    rig: Rig, stop_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    rig.start()
    rig.stop("fire")
    monkeypatch.setattr("roomba.storage.kept_stop.remove_kept", refuse)
    before = len(rig.held)
    answer = rig.stop(engage=False)
    again = "it holds again if the robot is killed, as the disk refused: "
    assert answer.startswith(f"the drive is free again; but {again}")
    assert stop_file.exists()
    assert rig.held[before:] == [""]
    assert rig.told("cmd_vel", twist_message(AHEAD)) == [AHEAD]


def test_what_is_no_file_holds_and_gives_way_to_one_when_it_is_released(
    rig: Rig, stop_file: Path
) -> None:
    stop_file.mkdir(parents=True)
    rig.start()
    (held,) = rig.held
    assert "is damaged" in held
    assert rig.stop(engage=False) == "the drive is free again"
    assert not stop_file.exists()
    assert stop_file.with_name("robot.txt.damaged").is_dir()


def odometry(linear: float) -> Odometry:
    message = Odometry()
    message.pose.pose.orientation.w = 1.0
    message.twist.twist.linear.x = linear
    return message


def test_the_speed_is_told_ten_times_a_second_once_the_wheels_say_it(rig: Rig) -> None:
    rig.start()
    for _ in range(4):
        rig.ticked()
    assert rig.speeds == []
    for number in range(1, 9):
        rig.graph.publish("odom", odometry(-0.01 * number))
        rig.ticked()
    assert rig.speeds == pytest.approx([0.01, 0.03, 0.05, 0.07])


def test_the_speed_is_told_after_the_clock_was_set_back(rig: Rig) -> None:
    rig.start()
    rig.graph.publish("odom", odometry(0.2))
    rig.node.tick(1000.0)
    rig.node.tick(900.0)
    rig.node.tick(900.05)
    rig.graph.deliver()
    assert rig.speeds == pytest.approx([0.2, 0.2])


def test_the_speed_is_told_once_while_the_clock_stands(rig: Rig) -> None:
    rig.start()
    rig.graph.publish("odom", odometry(0.2))
    for _ in range(3):
        rig.node.tick(1000.0)
    rig.graph.deliver()
    assert rig.speeds == pytest.approx([0.2])


def test_it_stops_the_drive_when_it_ends(rig: Rig) -> None:
    rig.start()
    rig.told("cmd_vel", twist_message(AHEAD))
    rig.node.stop()
    rig.graph.deliver()
    assert rig.driven[-1] == STANDSTILL


def test_it_runs_under_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[object] = []
    monkeypatch.setattr(speed_pub_node, "run_node", lambda *about: ran.extend(about))
    speed_pub_node.main()
    assert ran == ["speed_pub_node", SpeedPubNode]


def test_the_newest_message_alone_waits_and_commands_go_out_without_delay(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A queue would be driven later; Nagle's algorithm holds small messages back."""
    publishers: dict[str, dict[str, Any]] = {}
    advertise = rospy.Publisher

    def watched(name: str, kind: type, **options: Any) -> Any:
        publishers[name] = {"kind": kind, **options}
        return advertise(name, kind, **options)

    subscribers: dict[str, dict[str, Any]] = {}
    subscribe = rospy.Subscriber

    def heard(name: str, kind: type, hear: Any, **options: Any) -> Any:
        subscribers[name] = {"kind": kind, **options}
        return subscribe(name, kind, hear, **options)

    monkeypatch.setattr(rospy, "Publisher", watched)
    monkeypatch.setattr(rospy, "Subscriber", heard)
    rig.start()
    assert publishers == {
        "speed": {"kind": Float32, "queue_size": 1},
        "cmd_vel_out": {"kind": TwistMessage, "queue_size": 1, "tcp_nodelay": True},
        "emergency_stop": {"kind": String, "queue_size": 1, "latch": True},
    }
    at_once = {
        "bumper": Bumper,
        "cliff": Cliff,
        "wheel_drop": WheelDrop,
        "cmd_vel": TwistMessage,
        "cmd_vel_mission": TwistMessage,
    }
    later = {"odom": Odometry, "change_speed": Float32}
    assert subscribers == {
        name: {"kind": kind, "queue_size": 1, "tcp_nodelay": name in at_once}
        for name, kind in (at_once | later).items()
    }
