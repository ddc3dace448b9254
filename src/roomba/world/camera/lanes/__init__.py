"""Compiled code that handles several pixels at once."""
