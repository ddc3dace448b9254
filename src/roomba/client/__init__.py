"""What a user interface can ask of a robot."""
