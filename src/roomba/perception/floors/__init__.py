"""Which floor the robot is on, and what changed there."""
