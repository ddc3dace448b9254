"""Bags of ROS 1 written without ROS: chunk by chunk, kept in a ring, exported to ROS 2."""
