"""The robot's own maps on ROS."""
