"""A Create 2 made up: the Open Interface, byte for byte, over a robot in a simulated home."""
