"""Where the robot is on a map."""
