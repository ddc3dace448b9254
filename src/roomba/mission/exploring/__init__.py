"""Exploring what the map does not show yet."""
