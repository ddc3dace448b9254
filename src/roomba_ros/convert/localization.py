"""What is known of the robot's place, as ROS messages: a part of
:mod:`roomba_ros.convert.common`."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped, TransformStamped
from numpy.typing import NDArray
from roomba_robot.msg import Localization
from sensor_msgs.msg import LaserScan

from roomba.geometry import Pose
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba_ros.convert.common import header, planar_pose_message, pose_of_message, theta_of

STATES = {
    Knowledge.KNOWN: Localization.KNOWN,
    Knowledge.ROUGH: Localization.ROUGH,
    Knowledge.SEARCHING: Localization.SEARCHING,
    Knowledge.LOST: Localization.LOST,
}
SAME_TIME = 0.06
"""s; a gyro sample so near to an odometry's time is of the same motion."""
_PLANAR = (0, 1, 5)
"""Of a covariance's six axes x, y, z and the turns about them: x, y and the turn about z."""
_LEAST_DEVIATION = (0.1, 0.1)
"""m, rad; of a pose whose sender does not say how sure it is."""


def localization_message(now: float, estimate: Estimate, frame_id: str) -> Localization:
    """Return how well the place is known."""
    return Localization(
        header=header(now, frame_id),
        state=STATES[estimate.knowledge],
        position_deviation=estimate.position_deviation,
        heading_deviation=estimate.heading_deviation,
        agreement=estimate.agreement,
        message=estimate.reason,
    )


def knowledge_of(message: Localization) -> Knowledge:
    """Return how well the place is known; raises ValueError for a state that there is not."""
    for knowledge, state in STATES.items():
        if state == message.state:
            return knowledge
    raise ValueError(f"expected a state from 0 to {len(STATES) - 1}, got {message.state}")


def covariance_pose_message(
    now: float, estimate: Estimate, frame_id: str
) -> PoseWithCovarianceStamped:
    """Return a pose with its covariance, as amcl tells it."""
    message = PoseWithCovarianceStamped(header=header(now, frame_id))
    message.pose.pose = planar_pose_message(estimate.pose)
    covariance = [0.0] * 36
    for row, axis in enumerate(_PLANAR):
        for column, other in enumerate(_PLANAR):
            covariance[6 * axis + other] = float(estimate.covariance[row, column])
    message.pose.covariance = covariance
    return message


def told_pose_of(message: PoseWithCovarianceStamped) -> tuple[Pose, tuple[float, float]]:
    """Return a pose that somebody told, and how unsure it is, m and rad.

    Raises ValueError for numbers that are not finite.
    """
    pose = pose_of_message(message.pose.pose)
    covariance = message.pose.covariance
    variances = (max(covariance[0], covariance[7]), covariance[35])
    if not all(map(math.isfinite, (pose.x, pose.y, pose.theta, *variances))):
        raise ValueError(f"expected finite numbers, got {pose} with the variances {variances}")
    unsure = tuple(
        math.sqrt(variance) if variance > 0.0 else least
        for variance, least in zip(variances, _LEAST_DEVIATION, strict=True)
    )
    return pose, (unsure[0], unsure[1])


def poses_message(now: float, poses: Iterable[Pose], frame_id: str) -> PoseArray:
    """Return several poses of one frame."""
    return PoseArray(header(now, frame_id), [planar_pose_message(pose) for pose in poses])


def ranges_of(message: LaserScan) -> NDArray[np.float32]:
    """Return a scan's ranges, float32 [beams], m."""
    return np.array(message.ranges, np.float32)


def lidar_of(message: LaserScan, mount: Pose) -> LidarModel:
    """Return the lidar that a scan is of; ``mount`` is its place in the robot's frame.

    Raises ValueError for a scan without beams, with angles that are not finite, or all one angle.
    """
    beams, step = len(message.ranges), message.angle_increment
    is_fan = math.isfinite(message.angle_min + beams * step) and (step != 0.0 or beams == 1)
    if not (beams and is_fan):
        raise ValueError(
            f"expected a scan with beams at finite angles, each at another one, got {beams} from "
            f"{message.angle_min} on by {step} rad"
        )
    angles = message.angle_min + np.arange(beams) * message.angle_increment
    return LidarModel(angles, message.range_min, message.range_max, mount)


def mount_of(message: TransformStamped) -> Pose:
    """Return where a part is mounted, as seen from above."""
    translation = message.transform.translation
    return Pose(translation.x, translation.y, theta_of(message.transform.rotation))
