"""A robot that people own, as a node: its driver in place of the simulation."""
