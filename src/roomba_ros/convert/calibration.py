"""What the robot measured of its own errors, as messages."""

from __future__ import annotations

from typing import Final

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Pose2D

from roomba.geometry import Pose
from roomba.perception.calibration.calibration import Calibration
from roomba_ros.convert.common import header
from roomba_ros.convert.errors import MessageError, require_finite

_MOST: Final = 0.5
"""m and rad; a lidar that is off by more is another robot's."""


def correction_message(correction: Pose) -> Pose2D:
    """Return by what the lidar's mount is moved, robot's frame."""
    return Pose2D(correction.x, correction.y, correction.theta)


def correction_of(message: Pose2D) -> Pose:
    """Return by what the lidar's mount is moved, robot's frame; raises MessageError."""
    require_finite("a correction of the lidar's mount", message.x, message.y, message.theta)
    correction = Pose(message.x, message.y, message.theta)
    if correction.distance_to(0.0, 0.0) > _MOST or abs(correction.theta) > _MOST:
        raise MessageError(
            f"expected a correction of the lidar's mount below {_MOST:g} m and rad, got "
            f"({message.x:g}, {message.y:g}, {message.theta:g})"
        )
    return correction


def calibration_message(now: float, calibration: Calibration, robot: str) -> DiagnosticArray:
    """Return what was measured of a robot, and how sure that is (REP 107)."""
    status = DiagnosticStatus(
        level=DiagnosticStatus.OK,
        name=f"{robot}: calibration",
        message=str(calibration),
        hardware_id=robot,
        values=[
            KeyValue(f"{name} ({unit})", f"{value:.3f} +- {deviation:.3f}")
            for name, value, deviation, unit in calibration.told()
        ],
    )
    return DiagnosticArray(header(now, ""), [status])
