"""Loops that turn wishes into twists, and the limits above them."""
