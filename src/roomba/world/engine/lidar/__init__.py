"""The compiled lidar."""
