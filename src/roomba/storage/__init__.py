"""What the robot keeps between runs: maps, rooms, zones, checkpoints, pictures."""
