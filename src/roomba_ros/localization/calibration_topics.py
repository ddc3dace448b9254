"""The topics of the robot's calibration of itself, and the file in which it is kept."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Final

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Pose2D

from roomba.geometry import Pose
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.calibration.lidar import lidar_correction
from roomba.perception.localization.localizer import Localizer
from roomba.perception.slam.mapper import Mapper
from roomba.storage.calibration import CalibrationError, load_calibration, save_calibration
from roomba_ros.convert.calibration import calibration_message, correction_message
from roomba_ros.runtime.parameters import folder_of

_PERIOD: Final = 20
"""Ticks between two messages: a second."""
_KEPT_EVERY: Final = 50
"""Windows of motion, about a metre each, after which the calibration is saved."""


class CalibrationTopics:
    """Tells what the robot measured of its own errors, and keeps it between runs.

    Publishes: ``/diagnostics`` (DiagnosticArray, 1 Hz: ``calibration``), ``lidar_correction``
    (Pose2D, latched: by what the lidar's mount is moved, robot's frame).
    Parameters: ``~calibration`` (name of the robot's file, in ``~calibration_folder``, default:
    roomba_robot/calibration in the ROS home folder; without a name nothing is kept).
    """

    def __init__(self) -> None:
        """Connect nothing yet."""
        self._path: Path | None = None
        self._ticks = self._kept = 0
        self._told: Pose | None = None
        self._writer: threading.Thread | None = None

    def start(self) -> None:
        """Connect."""
        name = str(rospy.get_param("~calibration", ""))
        if name:
            self._path = folder_of("~calibration_folder", "calibration") / f"{name}.yaml"
        self._robot = str(rospy.get_param("robot_name", "roomba_robot"))
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=1)
        self._correction = rospy.Publisher("lidar_correction", Pose2D, queue_size=1, latch=True)

    def begin(self, knower: Localizer | Mapper, base: float) -> None:
        """Let a localizer or a mapper use the saved calibration; wheels are ``base`` m apart."""
        knower.belief["calibration"]["base"] = base
        kept = None
        try:
            kept = None if self._path is None else load_calibration(self._path, rospy.logwarn)
        except CalibrationError as error:
            rospy.logwarn("%s", error)
        if kept is not None:
            kept.take_up(knower.belief)
            self._kept = kept.windows
            rospy.loginfo("calibration, as kept: %s", kept)

    def tell(self, now: float, knower: Localizer | Mapper) -> None:
        """Publish and keep what is due at a tick."""
        correction = lidar_correction(knower.belief)
        if correction != self._told:
            self._told = correction
            self._correction.publish(correction_message(correction))
        self._ticks += 1
        if self._ticks % _PERIOD:
            return
        if self._diagnostics.get_num_connections() > 0:
            measured = Calibration.of(knower.belief)
            self._diagnostics.publish(calibration_message(now, measured, self._robot))
        if int(knower.belief["calibration"]["windows"][0]) >= self._kept + _KEPT_EVERY:
            self._keep(Calibration.of(knower.belief))

    def _keep(self, measured: Calibration) -> None:
        """Save the calibration in a thread: a disk that hangs must not stop the robot."""
        self._kept = measured.windows
        path, is_busy = self._path, self._writer is not None and self._writer.is_alive()
        if path is None or is_busy:
            return
        rospy.loginfo("calibration: %s", measured)
        self._writer = threading.Thread(target=_write, args=(measured, path), daemon=True)
        self._writer.start()


def _write(measured: Calibration, path: Path) -> None:
    try:
        save_calibration(measured, path)
    except OSError as error:
        rospy.logwarn("%s: what was measured of the robot cannot be kept: %s", path, error)
