"""The commands of the terminal that need no ROS."""
