"""What the mission is told: what the robot senses, and the map that it plans on."""
