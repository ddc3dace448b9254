"""A service that gives pictures."""

from __future__ import annotations

from pathlib import Path

import cv2
import rospy
from cv_bridge import CvBridge
from roomba_robot.srv import TurnCamera, TurnCameraRequest, TurnCameraResponse

FOLDER = Path(rospy.myargv()[1])


def turned(request: TurnCameraRequest) -> TurnCameraResponse:
    angle = min((-30, -15, 0, 15, 30), key=lambda each: abs(each - request.turn_degrees))
    picture = cv2.imread(str(FOLDER / f"{angle}.png"))
    return TurnCameraResponse(CvBridge().cv2_to_imgmsg(picture, "bgr8"))


rospy.init_node("turn_camera_service_node")
rospy.Service("turn_camera", TurnCamera, turned)
rospy.spin()
