"""The floor to cover, and where the robot fits."""
