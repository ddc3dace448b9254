"""A node that tells the dirt."""

from __future__ import annotations

import rospy
from std_msgs.msg import Float32

newest: list[float] = []
rospy.init_node("dirt_pub_node")
publisher = rospy.Publisher("dirt", Float32, queue_size=1)
rospy.Subscriber("dirt_raw", Float32, lambda message: newest.append(message.data))
rate = rospy.Rate(5)
while not rospy.is_shutdown():
    if newest:
        publisher.publish(newest[-1])
    rate.sleep()
