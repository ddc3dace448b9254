"""The camera service: keeps the newest picture of each angle and shows the nearest one."""

from __future__ import annotations

import math
import threading
import time
from pathlib import Path

import numpy as np
import rospkg
import rospy
from geometry_msgs.msg import PoseStamped
from numpy.typing import NDArray
from roomba_robot.srv import TurnCamera, TurnCameraRequest, TurnCameraResponse

from roomba.errors import PictureError, RoombaError
from roomba.geometry import Pose, wrap_angle
from roomba.storage.pictures_folder import ANGLES, PictureFolder, nearest_angle
from roomba_ros.convert.common import image_message, picture_of, pose_of
from roomba_ros.runtime.calls import call_service
from roomba_ros.runtime.node import frame_id, run_node
from roomba_ros.runtime.parameters import read_nodes_config
from roomba_ros.runtime.subscriptions import subscribe


class TurnCameraService:
    """Keeps a picture of each of five angles up to date: one every 3 s while the robot travels.

    On a fast clock it takes hardly more pictures in a second of wall time.

    Services: ``turn_camera`` (TurnCamera: the newest picture of the angle nearest to the wish).
    Calls: ``camera/capture`` (TurnCamera) of the robot's camera.
    Subscribes: ``pose`` (PoseStamped).
    Parameters: ``~picture_folder`` (default: ``roomba_robot/Images`` in the ROS home folder),
    ``nodes_config``.
    """

    period = 3.0

    def start(self) -> None:
        """Connect."""
        self._config = read_nodes_config().pictures
        own = rospy.get_namespace().strip("/")
        default = Path(rospkg.get_ros_home()) / "roomba_robot" / own / "Images"
        self._folder = PictureFolder(Path(rospy.get_param("~picture_folder", "") or default))
        self._lock = threading.Lock()
        self._capture = rospy.ServiceProxy("camera/capture", TurnCamera)
        self._pose: Pose | None = None
        self._pictured: dict[int, Pose | None] = {}
        self._taken = -math.inf
        self._round = list(ANGLES)
        subscribe("pose", PoseStamped, pose_of, self._on_pose)
        rospy.Service("turn_camera", TurnCamera, self._on_turn_camera)

    def tick(self, now: float) -> None:
        """Take a first picture of each angle at once, later one that is not up to date."""
        pose = self._pose
        if pose is None or time.monotonic() < self._taken + self._config.rest:
            return
        old = [angle for angle in self._round if self._is_old(angle, pose)]
        wanted = [angle for angle in old if angle not in self._pictured] or old[:1]
        try:
            for angle in wanted:
                self._take(angle)
                self._taken = time.monotonic()
                # To the end of the round, so that all angles get their turn.
                self._round.remove(angle)
                self._round.append(angle)
        except PictureError as error:
            rospy.logwarn_throttle(60.0, "no picture taken: %s", error)

    def stop(self) -> None:
        """Nothing of this node moves the robot."""

    def _is_old(self, angle: int, pose: Pose) -> bool:
        last = self._pictured.get(angle)
        if last is None:
            return True
        turned = abs(wrap_angle(pose.theta - last.theta))
        travelled = pose.distance_to(last.x, last.y)
        return travelled > self._config.travelled or turned > self._config.turned

    def _take(self, angle: int) -> NDArray[np.uint8]:
        pose = self._pose
        try:
            picture = picture_of(call_service(self._capture, float(angle)).image)
        except (RoombaError, ValueError) as error:
            raise PictureError(f"the robot's camera gave no picture: {error}") from error
        with self._lock:
            self._folder.write(angle, picture)
            self._pictured[angle] = pose
        return picture

    def _on_turn_camera(self, request: TurnCameraRequest) -> TurnCameraResponse:
        try:
            picture = self._picture_near(request.turn_degrees)
        except PictureError as error:
            raise rospy.ServiceException(str(error)) from error
        return TurnCameraResponse(image_message(rospy.get_time(), picture, frame_id("camera")))

    def _picture_near(self, degrees: float) -> NDArray[np.uint8]:
        angle = nearest_angle(degrees)
        if angle not in self._pictured:
            return self._take_or_old(angle)
        try:
            return self._folder.read(angle)
        except PictureError as error:
            rospy.logwarn("%s; taking a new one", error)
            try:
                return self._take(angle)
            except PictureError as second:
                raise PictureError(f"{error}; and {second}") from second

    def _take_or_old(self, angle: int) -> NDArray[np.uint8]:
        """Take the first picture of this run; without a camera use the last good picture."""
        try:
            return self._take(angle)
        except PictureError as error:
            if not self._folder.has(angle):
                path = self._folder.path(angle)
                raise PictureError(f"{path}: no picture yet; {error}") from error
            rospy.logwarn("%s; showing the last picture there is", error)
            return self._folder.read(angle)

    def _on_pose(self, pose: Pose) -> None:
        self._pose = pose


def main() -> None:
    """Run the node."""
    run_node("turn_camera_service_node", TurnCameraService)
