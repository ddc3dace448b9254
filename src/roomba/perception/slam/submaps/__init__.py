"""Submaps, the links between them, and the pose graph that places them."""
