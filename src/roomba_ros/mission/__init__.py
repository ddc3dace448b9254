"""The mission as a node."""
