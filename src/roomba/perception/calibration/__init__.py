"""Calibration of the robot by itself: how far wheels, gyro and lidar are off the configuration."""
