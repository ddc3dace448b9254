"""The robot without ROS, around the simulated world."""
