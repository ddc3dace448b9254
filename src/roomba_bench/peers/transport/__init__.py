"""Transports of messages between two processes, without ROS."""
