"""Drivers of robots that people own: each makes the robot on a line a body of the brain."""
