"""The robot's estimate of its pose as ROS messages, and poses that are told, as values."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from geometry_msgs.msg import Point32, PolygonStamped, PoseArray, PoseWithCovarianceStamped
from roomba_robot.msg import Localization

from roomba.geometry import Pose
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba_ros.convert.common import header, planar_pose_message, pose_of_message
from roomba_ros.convert.errors import MessageError, require_finite

STATES = {
    Knowledge.KNOWN: Localization.KNOWN,
    Knowledge.ROUGH: Localization.ROUGH,
    Knowledge.SEARCHING: Localization.SEARCHING,
    Knowledge.LOST: Localization.LOST,
}
SAME_TIME = 0.06
"""s; a gyro sample belongs to an odometry message if their stamps are no farther apart."""
_PLANAR = (0, 1, 5)
"""Of a covariance's six axes x, y, z and the turns about them: x, y and the turn about z."""
_CORNERS = 24
"""Corners of the body's outline: within 1 % of its circle."""
_LEAST_DEVIATION = (0.1, 0.1)
"""m, rad; deviations of a pose whose sender does not say how sure it is."""


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


class ToldPlace(NamedTuple):
    """How well the place is known, why not better, and its standard deviation, m."""

    knowledge: Knowledge
    reason: str = ""
    deviation: float = 0.05
    """The default where nothing else is told: other packages' localizers are off by centimetres."""


def knowledge_of(message: Localization) -> ToldPlace:
    """Return how well the place is known.

    Raises MessageError for a state that there is not, and for numbers that are not finite.
    """
    require_finite(
        "deviations and an agreement",
        message.position_deviation,
        message.heading_deviation,
        message.agreement,
    )
    for knowledge, state in STATES.items():
        if state == message.state:
            return ToldPlace(knowledge, message.message, message.position_deviation)
    raise MessageError(f"expected a state from 0 to {len(STATES) - 1}, got {message.state}")


def footprint_message(now: float, pose: Pose, radius: float, frame_id: str) -> PolygonStamped:
    """Return the outline of a round body of ``radius`` m at a pose; its first corner is ahead."""
    message = PolygonStamped(header=header(now, frame_id))
    for corner in range(_CORNERS):
        bearing = pose.theta + math.tau * corner / _CORNERS
        x, y = pose.x + radius * math.cos(bearing), pose.y + radius * math.sin(bearing)
        message.polygon.points.append(Point32(x, y, 0.0))
    return message


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
    """Return a pose that a person or a program told, and its deviations, m and rad.

    Raises MessageError for another frame than the map's, and for numbers that are not finite.
    """
    frame = message.header.frame_id.lstrip("/")
    if frame not in ("", "map"):
        raise MessageError(f"expected the frame 'map', got {frame!r}")
    pose = pose_of_message(message.pose.pose)
    covariance = message.pose.covariance
    require_finite("variances", covariance[0], covariance[7], covariance[35])
    variances = (max(covariance[0], covariance[7]), covariance[35])
    unsure = tuple(
        math.sqrt(variance) if variance > 0.0 else least
        for variance, least in zip(variances, _LEAST_DEVIATION, strict=True)
    )
    return pose, (unsure[0], unsure[1])


def poses_message(now: float, poses: Iterable[Pose], frame_id: str) -> PoseArray:
    """Return several poses of one frame."""
    return PoseArray(header(now, frame_id), [planar_pose_message(pose) for pose in poses])
