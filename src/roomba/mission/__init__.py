"""What the robot does: each task is a plain object that is ticked."""
