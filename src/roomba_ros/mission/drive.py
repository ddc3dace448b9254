"""The mission's access to drive, fan and station, and its priority over walks."""

from __future__ import annotations

import math
from typing import Final

import rospy
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import Twist as TwistMessage
from std_msgs.msg import Bool, Float32

from roomba.clock import ClockJumps
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Twist
from roomba.vocabulary import FanLevel
from roomba_ros.convert.common import twist_message, twist_of
from roomba_ros.convert.values import speed_of
from roomba_ros.runtime.subscriptions import subscribe

_STOP_REPEATS: Final = 5
"""Ticks for which a stop is repeated before the drive is left to others."""
_OTHERS: Final = "it was driven by hand or by another program; resume when that is done"
_STANDS: Final = (
    "another program wants the robot to stand (change_speed 0); want another speed, and resume"
)


class MissionDrive:
    """Drives while the mission wants to; notices when another program does.

    Publishes: ``cmd_vel_mission`` (Twist, 20 Hz while it drives), ``look_around`` (Bool, while the
    place has to be found), ``emptying_wanted`` (Bool, 20 Hz while the station is to empty the bin,
    and false at the end), ``vacuum_motor``, ``main_brush_motor`` (Float32, duty 0..1),
    ``walk_to_point/cancel``, ``move_base/cancel`` (GoalID: all walks end when it begins to drive).
    Subscribes: ``cmd_vel`` (Twist: what others want, which counts above the mission's),
    ``change_speed`` (Float32, m/s: with 0 the robot stands).
    """

    def __init__(self, config: RobotConfig, ending: float) -> None:
        """Connect nothing yet.

        After the mission cancels a walk, or stops looking around, those may drive for ``ending`` s.
        """
        self._config, self._ending = config, ending
        self._stops_left = 0
        self._looks = self._empties = False
        self._others_may_until = -math.inf
        self._others_drove = -math.inf
        self._cruise_speed = math.inf
        self._now = -math.inf
        self._jumps = ClockJumps()
        self._fan: FanLevel | None = None

    def start(self) -> None:
        """Connect."""
        self._command = rospy.Publisher(
            "cmd_vel_mission", TwistMessage, queue_size=1, tcp_nodelay=True
        )
        self._look_around = rospy.Publisher("look_around", Bool, queue_size=1)
        self._emptying = rospy.Publisher("emptying_wanted", Bool, queue_size=1)
        self._vacuum = rospy.Publisher("vacuum_motor", Float32, queue_size=1, latch=True)
        self._brush = rospy.Publisher("main_brush_motor", Float32, queue_size=1, latch=True)
        self._cancels = [
            rospy.Publisher(f"{action}/cancel", GoalID, queue_size=1)
            for action in ("walk_to_point", "move_base")
        ]
        subscribe("cmd_vel", TwistMessage, twist_of, self._on_other_command)
        subscribe("change_speed", Float32, speed_of, self._on_cruise_speed)

    def take(self) -> None:
        """Let all walks end: the mission is about to drive."""
        self._others_may_until = self._now + self._ending
        self._others_drove = -math.inf
        for publisher in self._cancels:
            publisher.publish(GoalID())

    def follow_clock(self, now: float) -> None:
        """Take the time, s of the robot's clock."""
        if self._jumps.at(now):
            self._others_may_until = self._others_drove = -math.inf
        self._now = now

    @property
    def taken_by(self) -> str:
        """Why the mission must leave the drive to another program; empty when it need not.

        That program may be a walk that this mission did not end, a sender of ``cmd_vel``, or one
        that stops the robot by speed 0.
        """
        if self._now - self._others_drove < self._config.body.command_timeout:
            return _OTHERS
        # A cancelled walk brakes by speed 0, too.
        if self._cruise_speed == 0.0 and self._now >= self._others_may_until:
            return _STANDS
        return ""

    def drive(self, twist: Twist | None, *, looks_around: bool) -> None:
        """Ask for a twist; None: stop, and then leave the drive to others."""
        if looks_around:
            self._others_may_until = self._now + self._ending
        if looks_around or self._looks:
            self._look_around.publish(looks_around)
        self._looks = looks_around
        if twist is not None:
            self._stops_left = _STOP_REPEATS
            self._command.publish(twist_message(twist))
        elif self._stops_left > 0:
            self._stops_left -= 1
            self._command.publish(TwistMessage())

    def set_fan(self, level: FanLevel | None) -> None:
        """Set the fan's power; None: as it was before the mission."""
        if level is self._fan:
            return
        self._fan, fan = level, self._config.fan
        self._vacuum.publish(fan.duty if level is None else fan.duty_at(level))
        self._brush.publish(self._config.brush.duty)

    def empty(self, *, is_wanted: bool) -> None:
        """Let the station empty the bin as long as that is wanted."""
        if is_wanted or self._empties:
            self._emptying.publish(is_wanted)
        self._empties = is_wanted

    def stop(self) -> None:
        """Stop what it drives."""
        if self._stops_left > 0:
            self._command.publish(TwistMessage())

    def _on_other_command(self, _: Twist) -> None:
        # A standstill counts as well: it holds the drive as any other twist does.
        if self._now >= self._others_may_until:
            self._others_drove = self._now

    def _on_cruise_speed(self, speed: float) -> None:
        self._cruise_speed = speed
