"""An action that can be cancelled."""

from __future__ import annotations

import math

import actionlib
import rospy
from roomba_robot.msg import (
    RobotPosition,
    WalkToPointAction,
    WalkToPointFeedback,
    WalkToPointGoal,
    WalkToPointResult,
)


class Walk:
    def __init__(self) -> None:
        self.here: RobotPosition | None = None
        rospy.Subscriber("position", RobotPosition, self.on_position, queue_size=1)
        self.setpoint = rospy.Publisher("change_position", RobotPosition, queue_size=1)
        self.server = actionlib.SimpleActionServer(
            "walk_to_point", WalkToPointAction, execute_cb=self.walk, auto_start=False
        )
        self.server.start()

    def on_position(self, position: RobotPosition) -> None:
        self.here = position

    def walk(self, goal: WalkToPointGoal) -> None:
        began, rate = rospy.get_time(), rospy.Rate(20)
        x, y = goal.destin.dest_x, goal.destin.dest_y
        while not rospy.is_shutdown():
            if self.server.is_preempt_requested():
                self.server.set_preempted()
                return
            self.setpoint.publish(x, y)
            if self.here is not None:
                left = math.hypot(x - self.here.pos_x, y - self.here.pos_y)
                if left < 0.03:
                    break
                self.server.publish_feedback(WalkToPointFeedback(distance=left))
            rate.sleep()
        self.server.set_succeeded(WalkToPointResult(time_spent=rospy.get_time() - began))


rospy.init_node("walk_to_point_action_server_node")
walk = Walk()
rospy.spin()
