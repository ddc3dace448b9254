"""Driving a path, and around what the map does not show."""
