"""A service that gives pictures."""

import rospy
from roomba_robot.srv import TurnCamera, TurnCameraResponse


def turned(request):
    return TurnCameraResponse()  # TODO: the picture of the angle nearest to request.turn_degrees


def main():
    rospy.init_node("turn_camera_service_node")
    rospy.Service("turn_camera", TurnCamera, turned)
    rospy.spin()


main()
