"""Recorded drives of any robot, read from bags of ROS 1 and 2 and from CARMEN logs."""
