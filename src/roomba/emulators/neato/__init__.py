"""A Neato made up: its text protocol, byte for byte, over a robot in a simulated home."""
