"""The robot's estimate of itself and its home, from its sensors alone."""
