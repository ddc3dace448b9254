"""Bags of ROS 1 written without ROS: chunk by chunk, mended after a kill, exported to ROS 2."""
