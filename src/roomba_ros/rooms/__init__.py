"""The rooms of the map on ROS."""
