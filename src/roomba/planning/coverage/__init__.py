"""Paths that cover a floor: floor, passes, tour."""
