"""What the robot's camera sees."""
