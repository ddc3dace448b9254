"""The speed node: the speed loop, which decides the twist of the drive; and the robot's speed."""

from __future__ import annotations

import http.client
import math
import threading
import xmlrpc.client
from dataclasses import replace
from functools import partial
from typing import Final

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from roomba_robot.msg import Bumper, Cliff, WheelDrop
from roomba_robot.srv import EmergencyStop, EmergencyStopRequest, EmergencyStopResponse
from std_msgs.msg import Float32, String

from roomba import geometry
from roomba.control.speed_loop import Hazards, Hold, Source, SpeedLoop
from roomba.robot.readings import CliffReading
from roomba.storage.kept_stop import FOLDER, NO_REASON, KeptStop
from roomba_ros.convert.common import twist_message, twist_of
from roomba_ros.convert.readings import (
    OdometryReading,
    Sides,
    bumper_of,
    cliff_of,
    odometry_of,
    wheel_drop_of,
)
from roomba_ros.convert.values import speed_of
from roomba_ros.runtime.node import run_node
from roomba_ros.runtime.parameters import (
    LiveSeedParameters,
    folder_for,
    read_nodes_config,
    read_robot_config,
)
from roomba_ros.runtime.senders import SELDOM_SILENT_AFTER, OneSender
from roomba_ros.runtime.subscriptions import subscribe

EMERGENCY_PARAMETER: Final = "emergency_stop"
"""The parameter with the reason why the drive is held, kept in case the disk does not."""
_LONGEST_REASON: Final = 200


class SpeedPubNode:
    """Keeps every wanted twist within the limits and stops the drive without a fresh command.

    Publishes: ``speed`` (Float32, m/s, 10 Hz), ``cmd_vel_out`` (Twist, to the drive, 20 Hz, and
    between two of these at once for the first message of each topic), ``emergency_stop`` (String,
    latched: why the drive is held, empty when it is not).
    Subscribes: ``change_speed`` (Float32, cruise speed wanted, m/s), ``cmd_vel`` (Twist), and
    ``cmd_vel_mission`` (Twist), which counts while no fresh ``cmd_vel`` does; ``odom`` (Odometry),
    ``bumper`` (Bumper), ``cliff`` (Cliff), ``wheel_drop`` (WheelDrop): a hazard is obeyed at once;
    of two nodes that tell the same of the body, the first counts until it is silent. It does not
    hear ``body``: no number of that can get a hazard refused, and no tick changes a connection.
    Services: ``emergency_stop`` (EmergencyStop): the drive is held until it is released, also by
    a node that takes this one's place: why is kept in a file of the robot's, and by the master.
    Parameters: ``robot_max_speed``; a bad value is refused and set back. ``emergency_stop``: kept.
    """

    period: float

    def start(self) -> None:
        """Read the limits and connect."""
        self._parameters = LiveSeedParameters(guardian=True)
        self._lock, self._keeping = threading.Lock(), threading.Lock()
        self._reason = ""
        robot = rospy.get_namespace().strip("/") or "robot"
        self._kept = KeptStop(folder_for("", FOLDER), robot)
        config, self._told_every = read_robot_config(), read_nodes_config().periods.speed
        body, self.period = config.body, config.timing.tick
        self._loop = SpeedLoop(body, self._parameters.values.robot_max_speed)
        self._hazards = Hazards()
        self._speed: float | None = None
        self._speed_told = -math.inf
        self._hold = Hold.NO_COMMAND
        self._hold_logged = Hold.NO_COMMAND
        self._passed_on: set[str] = set()
        self._told_drive: geometry.Twist | None = None
        self._speed_publisher = rospy.Publisher("speed", Float32, queue_size=1)
        self._drive = rospy.Publisher("cmd_vel_out", Twist, queue_size=1, tcp_nodelay=True)
        self._emergency = rospy.Publisher("emergency_stop", String, queue_size=1, latch=True)
        self._engage_again()
        rospy.Service("emergency_stop", EmergencyStop, self._on_emergency_stop)
        for name, kind, convert in (
            ("bumper", Bumper, bumper_of),
            ("cliff", Cliff, cliff_of),
            ("wheel_drop", WheelDrop, wheel_drop_of),
        ):
            felt, one = partial(self._on_hazard, name), OneSender(SELDOM_SILENT_AFTER)
            subscribe(name, kind, convert, felt, tcp_nodelay=True, senders=one)
        subscribe("odom", Odometry, odometry_of, self._on_odometry, senders=OneSender())
        subscribe("change_speed", Float32, speed_of, self._on_change_speed)
        for source in Source:
            take = partial(self._on_command, source)
            subscribe(source.value, Twist, twist_of, take, tcp_nodelay=True)

    def tick(self, now: float) -> None:
        """Obey changed limits, tell the drive and tell the speed."""
        max_speed = self._parameters.refresh().robot_max_speed
        with self._lock:
            self._loop.set_max_speed(max_speed)
            self._passed_on.clear()
        self._tell_drive(now)
        self._tell_speed(now)

    def stop(self) -> None:
        """Stop the drive."""
        self._drive.publish(Twist())

    def _pass_on(self, now: float, topic: str) -> None:
        """Send the drive at once what a topic changes, unless that happened since the last tick.

        Further messages of the topic wait for the tick: a flood of messages must not flood the
        drive. A message that changes nothing waits as well: the drive has the same twist already.
        """
        with self._lock:
            if topic in self._passed_on:
                return
            before, twist = self._told_drive, self._decide(now)
            if twist != before:
                self._passed_on.add(topic)
                self._drive.publish(twist_message(twist))
        self._log_hold()

    def _tell_drive(self, now: float) -> None:
        with self._lock:
            self._drive.publish(twist_message(self._decide(now)))
        self._log_hold()

    def _decide(self, now: float) -> geometry.Twist:
        """Return the twist that the drive gets next.

        Hold the lock until the twist is sent: no older twist may come after a newer one.
        """
        self._told_drive, self._hold = self._loop.tick(now)
        return self._told_drive

    def _log_hold(self) -> None:
        """Log why the drive is held, when that is new; not under the lock, as logging may block."""
        with self._lock:
            hold, is_new = self._hold, self._hold is not self._hold_logged
            self._hold_logged = hold
        if is_new and hold not in (Hold.NONE, Hold.NO_COMMAND):
            rospy.loginfo("the drive is held: %s", hold.value)

    def _tell_speed(self, now: float) -> None:
        is_due = not 0.0 <= now - self._speed_told < self._told_every - 0.5 * self.period
        if self._speed is not None and is_due:
            self._speed_told = now
            self._speed_publisher.publish(self._speed)

    def _engage_again(self) -> None:
        """Hold the drive if it was held when the node before this one ended."""
        reason = rospy.get_param(EMERGENCY_PARAMETER, "")
        reason = self._kept.reason() or (reason if isinstance(reason, str) else "")
        if reason:
            rospy.logwarn("the emergency stop still holds the drive: %s", reason)
            self._reason, self._loop.emergency = reason, True
        self._emergency.publish(self._reason)
        if reason:
            self._keep()

    def _on_emergency_stop(self, request: EmergencyStopRequest) -> EmergencyStopResponse:
        reason = _shown(request.reason) if request.engage else ""
        with self._lock:
            was_held = self._loop.emergency
            self._reason, self._loop.emergency = reason, request.engage
            self._emergency.publish(reason)
        self._tell_drive(rospy.get_time())
        rospy.logwarn(f"emergency stop: {reason}" if reason else "emergency stop released")
        # Only after the drive is held: a disk may take long, or refuse.
        return EmergencyStopResponse(True, _answer(reason, was_held) + self._keep())

    def _keep(self) -> str:
        """Save the newest state; return a sentence for the client if that fails."""
        said = ""
        refused = self._kept.keep(lambda: self._reason)
        if refused:
            said = f"; but {refused}"
            rospy.logwarn(f"emergency stop: {refused}")
            with self._lock:
                if self._loop.emergency:
                    self._emergency.publish(self._reason + said)
        try:
            with self._keeping:
                rospy.set_param(EMERGENCY_PARAMETER, self._reason)
        except (OSError, http.client.HTTPException, xmlrpc.client.Error) as error:
            said += f"; but the master does not keep that, should this node end: {error}"
        return said

    def _on_command(self, source: Source, twist: geometry.Twist) -> None:
        now = rospy.get_time()
        with self._lock:
            self._loop.command(now, twist, source)
        self._pass_on(now, source.value)

    def _on_change_speed(self, speed: float) -> None:
        with self._lock:
            self._loop.set_cruise_speed(speed)
        self._pass_on(rospy.get_time(), "change_speed")

    def _on_hazard(self, hazard: str, felt: Sides | CliffReading) -> None:
        with self._lock:
            self._hazards = replace(self._hazards, **{hazard: felt.any})
            self._loop.set_hazards(self._hazards)
        if felt.any:
            self._pass_on(rospy.get_time(), hazard)

    def _on_odometry(self, told: OdometryReading) -> None:
        self._speed = abs(told.twist.linear)


def _shown(reason: str) -> str:
    """Return a reason as one line of bounded length: no text may make the stop fail."""
    text = "".join(letter if letter.isprintable() else " " for letter in reason[:_LONGEST_REASON])
    return text.strip() or NO_REASON


def _answer(reason: str, was_held: bool) -> str:
    if reason:
        return f"the drive is held: {reason}"
    return "the drive is free again" if was_held else "the drive was not held"


def main() -> None:
    """Run the node."""
    run_node("speed_pub_node", SpeedPubNode)
