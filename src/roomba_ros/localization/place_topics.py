"""The topics of the robot's place: pose, covariance, and hypotheses."""

from __future__ import annotations

import rospy
from geometry_msgs.msg import PolygonStamped, PoseArray, PoseStamped, PoseWithCovarianceStamped
from roomba_robot.msg import Localization, RobotPosition
from tf2_msgs.msg import TFMessage

from roomba.configuration.nodes import PeriodsConfig
from roomba.geometry import Pose
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.perception.slam.mapper import Mapper
from roomba_ros.convert.common import pose_message, transform_message
from roomba_ros.convert.localization import (
    covariance_pose_message,
    footprint_message,
    localization_message,
    poses_message,
)
from roomba_ros.runtime.node import frame_id


class PlaceTopics:
    """Tells where the robot is.

    Publishes: ``position`` (RobotPosition, 10 Hz), ``pose`` (PoseStamped, 20 Hz, map frame),
    ``amcl_pose`` (PoseWithCovarianceStamped, 10 Hz while heard), ``localization`` (Localization, at
    a change and 1 Hz, latched), ``particlecloud`` (PoseArray, where it may be, 2 Hz while heard),
    ``footprint`` (PolygonStamped, the body's outline on the map, 10 Hz while heard),
    ``/tf`` (map -> odom, 10 Hz while heard).
    """

    def __init__(self, periods: PeriodsConfig, radius: float) -> None:
        """Connect nothing yet; ``radius`` is the body's, m."""
        self._periods, self._radius = periods, radius
        self._ticks = 0
        self._said: tuple[Knowledge, str] | None = None
        self._map_frame, self._odom_frame = "map", frame_id("odom")

    def start(self) -> None:
        """Connect."""
        self._position = rospy.Publisher("position", RobotPosition, queue_size=1)
        self._pose = rospy.Publisher("pose", PoseStamped, queue_size=1, tcp_nodelay=True)
        self._amcl_pose = rospy.Publisher("amcl_pose", PoseWithCovarianceStamped, queue_size=1)
        self._state = rospy.Publisher("localization", Localization, queue_size=1, latch=True)
        self._cloud = rospy.Publisher("particlecloud", PoseArray, queue_size=1)
        self._footprint = rospy.Publisher("footprint", PolygonStamped, queue_size=1)
        self._transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)

    def tell(
        self, now: float, stamp: float, localizer: Localizer | Mapper, estimate: Estimate
    ) -> None:
        """Publish what is due at a tick; ``stamp`` is that of the newest odometry, s.

        Poses have that stamp: they follow from it, and others can compare them.
        """
        self._pose.publish(pose_message(stamp or now, estimate.pose, self._map_frame))
        self._ticks += 1
        if self._ticks % self._periods.position_ticks == 0:
            self._position.publish(RobotPosition(estimate.pose.x, estimate.pose.y))
            if self._amcl_pose.get_num_connections() > 0:
                pose = covariance_pose_message(stamp or now, estimate, self._map_frame)
                self._amcl_pose.publish(pose)
            if self._footprint.get_num_connections() > 0:
                place = (estimate.pose, self._radius, self._map_frame)
                self._footprint.publish(footprint_message(stamp or now, *place))
            if self._transforms.get_num_connections() > 0:
                odometry = localizer.map_to_odometry
                self._transforms.publish(
                    [transform_message(now, odometry, self._map_frame, self._odom_frame)]
                )
        if self._ticks % self._periods.cloud_ticks == 0 and self._cloud.get_num_connections() > 0:
            self._cloud.publish(poses_message(now, localizer.hypotheses, self._map_frame))
        self._tell_state(now, estimate)

    def _tell_state(self, now: float, estimate: Estimate) -> None:
        said = (estimate.knowledge, estimate.reason)
        before = self._said
        if said != before or self._ticks % self._periods.state_ticks == 0:
            self._said = said
            self._state.publish(localization_message(now, estimate, self._map_frame))
        if before is not None and said[0] is before[0]:
            return
        if estimate.knowledge is not Knowledge.KNOWN:
            rospy.logwarn("the robot's place is %s: %s", estimate.knowledge.value, estimate.reason)
        elif before is not None:
            rospy.loginfo("the robot knows where it is: %s", _spot(estimate.pose))


def _spot(pose: Pose) -> str:
    return f"({pose.x:.2f}, {pose.y:.2f}), {pose.theta:.2f} rad"
