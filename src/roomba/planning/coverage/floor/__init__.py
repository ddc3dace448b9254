"""What floor there is to cover, and where the robot fits."""
