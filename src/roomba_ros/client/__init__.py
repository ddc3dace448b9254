"""The robot for programs and for the menu, by ROS."""
