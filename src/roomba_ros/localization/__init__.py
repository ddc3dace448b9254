"""The robot's place on ROS."""
