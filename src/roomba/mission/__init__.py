"""The robot's tasks: each one is a plain object that is ticked."""
