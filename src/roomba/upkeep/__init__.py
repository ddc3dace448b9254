"""Parts of the robot that wear, and when they are due."""
