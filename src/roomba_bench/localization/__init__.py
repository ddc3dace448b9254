"""Drives through homes on whose maps the robot finds its place."""
