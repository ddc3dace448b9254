"""A node that tells the dirt."""

import rospy
from std_msgs.msg import Float32


def main():
    rospy.init_node("dirt_pub_node")
    publisher = rospy.Publisher("dirt", Float32, queue_size=1)
    rate = rospy.Rate(5)
    while not rospy.is_shutdown():
        publisher.publish(0.0)  # TODO: the newest value of dirt_raw, and only when there is one
        rate.sleep()


main()
