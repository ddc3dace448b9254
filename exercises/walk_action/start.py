"""An action that can be cancelled."""

import actionlib
import rospy
from roomba_robot.msg import WalkToPointAction, WalkToPointResult


class Walk:
    def __init__(self):
        self.server = actionlib.SimpleActionServer(
            "walk_to_point", WalkToPointAction, execute_cb=self.walk, auto_start=False
        )
        self.server.start()

    def walk(self, goal):
        # TODO: drive there, tell the distance, and obey a cancel
        self.server.set_succeeded(WalkToPointResult(time_spent=0.0))


rospy.init_node("walk_to_point_action_server_node")
Walk()
rospy.spin()
