"""Simulators of a robot with a lidar among walls, and the arena that they share."""
