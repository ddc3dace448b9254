"""The true state of the home and the robot, for people alone: the robot hears none of it."""

from __future__ import annotations

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import SimHome

from roomba.configuration.nodes import PeriodsConfig
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator
from roomba.world.truth import HomeTruth
from roomba_ros.convert.common import pose_message
from roomba_ros.convert.sensors import sim_dirt_message, sim_home_message
from roomba_ros.runtime.timing.wall_period import WallPeriod

_HOME_EVERY = 4
"""Ticks between two looks at what stands about."""
_DIRT_EVERY = 20
"""Ticks between two looks at the dirt."""


class TruthTopics:
    """Tells how a home really is, and where the robot is in it.

    Publishes: ``sim/pose`` (PoseStamped, 20 Hz while heard), ``sim/home`` (SimHome, latched, at a
    change), ``sim/dirt`` (OccupancyGrid, 1 Hz while heard; a home that was turned tells none). On a
    fast clock pose and dirt are told less often: people look by their own.
    """

    def __init__(self, simulator: Simulator, periods: PeriodsConfig) -> None:
        """Connect all of them."""
        self._simulator, self._truth = simulator, HomeTruth(simulator.home)
        self._pose_due = WallPeriod(periods.true_pose_wall)
        self._dirt_due = WallPeriod(periods.true_dirt_wall)
        self._told: object = None
        self._pose = rospy.Publisher("sim/pose", PoseStamped, queue_size=1, tcp_nodelay=True)
        self._home = rospy.Publisher("sim/home", SimHome, queue_size=1, latch=True)
        self._dirt = rospy.Publisher("sim/dirt", OccupancyGrid, queue_size=1)

    def tell(self, now: float, tick: int, seen: Observation) -> None:
        """Publish what is due at a tick; ``now`` is the time for stamps, s."""
        if self._pose.get_num_connections() > 0 and self._pose_due.is_over():
            self._pose_due.begin()
            self._pose.publish(pose_message(now, seen.pose, "map"))
        if self._told is None or tick % _HOME_EVERY == 0:
            self._follow_home(now)
        is_looked_at = tick % _DIRT_EVERY == 0 and self._dirt.get_num_connections() > 0
        if is_looked_at and self._dirt_due.is_over():
            self._dirt_due.begin()
            self._tell_dirt(now)

    def _follow_home(self, now: float) -> None:
        it = self._simulator
        state = it.things.tobytes(), it.discs.tobytes(), it.numbers["lifted"]
        if state != self._told:
            self._told = state
            self._home.publish(sim_home_message(now, self._truth.now(it), "map"))

    def _tell_dirt(self, now: float) -> None:
        dirt = self._truth.dirt(self._simulator)
        if dirt is not None:
            self._dirt.publish(sim_dirt_message(now, *dirt, "map"))
