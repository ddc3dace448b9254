"""The simulated home and body as a node."""
