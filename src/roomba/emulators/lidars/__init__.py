"""Lidars made up: their frames, byte for byte, of what one sees in a simulated home."""
