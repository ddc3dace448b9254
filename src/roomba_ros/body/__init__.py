"""A robot's body on ROS, simulated or of a robot that people own: what it tells and obeys."""
