"""The robot's published pose, continued by wheels and gyro."""

from __future__ import annotations

import math
import threading
import time

import rospy
from geometry_msgs.msg import PoseStamped
from roomba_robot.msg import Localization

from roomba.clock import is_recent
from roomba.configuration.nodes import HearingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.reckoned_path import ReckonedPath
from roomba.robot.readings import Readings
from roomba_ros.convert.localization import ToldPlace, knowledge_of
from roomba_ros.convert.readings import StampedPose, stamped_pose_of
from roomba_ros.runtime.senders import SELDOM_SILENT_AFTER, OneSender
from roomba_ros.runtime.subscriptions import subscribe


class HeardPlace:
    """Keeps the transform from dead reckoning's frame to the map, corrected by each pose it hears.

    A late pose corrects as well as a prompt one: it is compared with the reckoned pose at its
    stamp. Wheels and gyro give the motion since then.
    """

    def __init__(self, robot: RobotConfig, config: HearingConfig) -> None:
        """Connect nothing yet."""
        self._config = config
        self._lock = threading.Lock()
        self._senders = OneSender()
        self._reckoning = DeadReckoning(robot.localization, robot.gyro)
        self._newest: Readings | None = None
        self._pose: StampedPose | None = None
        self._heard = 0.0
        self._correction = Pose()
        self._corrected: StampedPose | None = None
        self._told = ToldPlace(Knowledge.KNOWN)

    def start(self) -> None:
        """Connect."""
        subscribe(
            "localization",
            Localization,
            knowledge_of,
            self._on_localization,
            queue_size=5,
            senders=OneSender(SELDOM_SILENT_AFTER),
        )
        subscribe(
            "pose",
            PoseStamped,
            stamped_pose_of,
            self._on_pose,
            queue_size=5,
            tcp_nodelay=True,
            senders=self._senders,
        )

    @property
    def told(self) -> Pose | None:
        """The last pose that was published, map frame; None before the first."""
        return None if self._pose is None else self._pose.pose

    @property
    def knowledge(self) -> tuple[Knowledge, str]:
        """How well the published place is known, and why not better.

        If two nodes publish it, one of them is wrong: the robot must not drive by it then.
        """
        conflict = self._senders.conflict
        if conflict:
            return Knowledge.SEARCHING, f"of its place {conflict}"
        return self._told.knowledge, self._told.reason

    @property
    def deviation(self) -> float:
        """The standard deviation of the published place, m."""
        return self._told.deviation

    @property
    def path(self) -> ReckonedPath:
        """The reckoned poses of the last seconds, by wheels and gyro."""
        return self._reckoning.path

    def move(self, readings: Readings) -> None:
        """Take what wheels and gyro say next."""
        self._reckoning.move(readings.time, readings.odometry, readings.turning)
        self._newest = readings
        self._correct()

    def at(self, now: float) -> Pose | None:
        """Return where the robot is at a time, s, map frame; None until enough was heard.

        A time after the newest odometry is extrapolated by the odometry's twist.
        """
        self._correct()
        newest = self._newest
        if self._corrected is None or newest is None:
            return None
        here = self._reckoned_at(min(now, newest.time))
        ahead = min(max(now - newest.time, 0.0), self._config.oldest_pose)
        return self._correction.compose(moved(here, newest.twist, ahead))

    def is_late(self, now: float, longest: float) -> bool:
        """Whether the newest pose is ``longest`` s old, or older: the robot must not drive by it.

        More time passes before the place is reported unknown: a busy machine may catch up.
        """
        stamp = -math.inf if self._corrected is None else self._corrected.stamp
        return now > stamp and not is_recent(now, stamp, longest)

    def is_silent(self, now: float) -> bool:
        """Whether the place is no longer published."""
        stamp = -math.inf if self._corrected is None else self._corrected.stamp
        is_old = not now - self._config.oldest_pose <= stamp
        return time.monotonic() > self._heard + self._config.silence and is_old

    def _correct(self) -> None:
        """Update the transform from dead reckoning's frame to the map, if a pose is new."""
        with self._lock:
            told = self._pose
        newest = self._newest
        if told is None or told == self._corrected or newest is None:
            return
        if self._corrected is not None and told.stamp > newest.time:
            # The pose came before the odometry that it was computed from.
            return
        then = self._reckoning.at(told.stamp)
        if then is None and self._corrected is not None:
            # The pose is older than the reckoned path.
            return
        self._correction = told.pose.compose((then or self._reckoning.pose).inverse())
        self._corrected = told

    def _reckoned_at(self, stamp: float) -> Pose:
        """Return the reckoned pose at a time, s; the present one if that time is forgotten."""
        return self._reckoning.at(stamp) or self._reckoning.pose

    def _on_pose(self, told: StampedPose) -> None:
        with self._lock:
            self._heard = time.monotonic()
            self._pose = told._replace(stamp=told.stamp or rospy.get_time())

    def _on_localization(self, told: ToldPlace) -> None:
        self._told = told


def moved(pose: Pose, twist: Twist, time: float) -> Pose:
    """Return a pose after a time, s, of motion along the arc of a twist."""
    turn = twist.angular * time
    # The chord of the arc, in the direction of its middle; sin(x)/x for small turns is 1.
    half = 0.5 * turn
    chord = twist.linear * time * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
    return pose.compose(Pose(chord * math.cos(half), chord * math.sin(half), turn))
