"""Localization on ROS."""
