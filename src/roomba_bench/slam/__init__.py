"""Recorded drives, and how far their maps are off what was surveyed."""
