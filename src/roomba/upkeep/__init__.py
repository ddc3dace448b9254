"""What of the robot wears, and when it is due."""
