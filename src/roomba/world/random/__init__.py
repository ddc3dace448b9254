"""Homes made at random from a seed."""
