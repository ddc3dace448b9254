"""Recordings of any robot: what a log is, and bags of ROS 1 and 2."""
