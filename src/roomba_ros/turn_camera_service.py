"""The camera service: keeps the newest picture of each angle and shows the nearest one."""

from __future__ import annotations

import threading
from pathlib import Path

import rospkg
import rospy
from geometry_msgs.msg import PoseStamped
from numpy.typing import NDArray
from roomba_robot.srv import TurnCamera, TurnCameraRequest, TurnCameraResponse

from roomba.errors import PictureError
from roomba.geometry import Pose
from roomba.pictures_folder import ANGLES, PictureFolder, nearest_angle
from roomba_ros.convert import image_message, picture_of, pose_of
from roomba_ros.node import frame_id, run_node

_TRAVELLED = 0.1
"""m; moving less than this since the last picture is no travelling."""
_TURNED = 0.3
"""rad; turning as much as this is as good as travelling."""


class TurnCameraService:
    """Takes a picture every 3 s while the robot travels, going through the five angles.

    Services: ``turn_camera`` (TurnCamera: the newest picture of the angle nearest to the wish).
    Calls: ``camera/capture`` (TurnCamera) of the robot's camera.
    Subscribes: ``pose`` (PoseStamped).
    Parameters: ``~picture_folder`` (default: ``roomba_robot/Images`` in the ROS home folder).
    """

    period = 3.0

    def start(self) -> None:
        """Connect."""
        default = Path(rospkg.get_ros_home()) / "roomba_robot" / "Images"
        self._folder = PictureFolder(Path(rospy.get_param("~picture_folder", "") or default))
        self._lock = threading.Lock()
        self._capture = rospy.ServiceProxy("camera/capture", TurnCamera)
        self._pose: Pose | None = None
        self._pictured: Pose | None = None
        self._missing = list(ANGLES)
        self._next = 0
        rospy.Subscriber("pose", PoseStamped, self._on_pose, queue_size=1)
        rospy.Service("turn_camera", TurnCamera, self._on_turn_camera)

    def tick(self, now: float) -> None:
        """Take a first picture of each angle, and the next of the round when it travels."""
        pose = self._pose
        if pose is None or not (self._missing or self._has_travelled(pose)):
            return
        try:
            for angle in list(self._missing) or [ANGLES[self._next]]:
                self._take(angle)
        except PictureError as error:
            rospy.logwarn_throttle(60.0, "no picture taken: %s", error)
            return
        if self._pictured is not None:
            self._next = (self._next + 1) % len(ANGLES)
        self._pictured = pose

    def stop(self) -> None:
        """Nothing of this node moves the robot."""

    def _has_travelled(self, pose: Pose) -> bool:
        last = self._pictured
        if last is None:
            return True
        turned = abs(Pose(theta=last.theta).inverse().compose(Pose(theta=pose.theta)).theta)
        return pose.distance_to(last.x, last.y) > _TRAVELLED or turned > _TURNED

    def _take(self, angle: int) -> NDArray:
        try:
            picture = picture_of(self._capture(float(angle)).image)
        except (rospy.ServiceException, rospy.ROSException, ValueError) as error:
            raise PictureError(f"the robot's camera does not answer: {error}") from error
        with self._lock:
            self._folder.write(angle, picture)
            if angle in self._missing:
                self._missing.remove(angle)
        return picture

    def _on_turn_camera(self, request: TurnCameraRequest) -> TurnCameraResponse:
        try:
            picture = self._picture_near(request.turn_degrees)
        except PictureError as error:
            raise rospy.ServiceException(str(error)) from error
        return TurnCameraResponse(image_message(rospy.get_time(), picture, frame_id("camera")))

    def _picture_near(self, degrees: float) -> NDArray:
        angle = nearest_angle(degrees)
        if angle in self._missing:
            return self._take_or_old(angle)
        try:
            return self._folder.read(angle)
        except PictureError as error:
            rospy.logwarn("%s; taking a new one", error)
            try:
                return self._take(angle)
            except PictureError as second:
                raise PictureError(f"{error}; and {second}") from second

    def _take_or_old(self, angle: int) -> NDArray:
        """Take the first picture of this run; without a camera the last good one counts."""
        try:
            picture = self._take(angle)
        except PictureError as error:
            if not self._folder.has(angle):
                raise PictureError(
                    f"{self._folder.path(angle)}: no picture yet; {error}"
                ) from error
            rospy.logwarn("%s; showing the last picture there is", error)
            return self._folder.read(angle)
        if angle in self._missing:
            self._missing.remove(angle)
        return picture

    def _on_pose(self, message: PoseStamped) -> None:
        self._pose = pose_of(message)


def main() -> None:
    """Run the node."""
    run_node("turn_camera_service_node", TurnCameraService)
