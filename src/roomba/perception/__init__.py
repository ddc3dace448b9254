"""What the robot believes about itself and its home, from its sensors alone."""
