"""Checks of the exercises about ROS: each has a graph of its own."""
