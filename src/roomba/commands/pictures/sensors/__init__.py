"""Pictures of the body, of its sensors, and of what they measure in the simulated world."""
