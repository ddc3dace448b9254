"""When a node ticks, how fast the simulated clock goes, and the signs of life of both."""
