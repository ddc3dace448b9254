"""Mirrors, found while a map is made: by the robot's own image or a touch, and by their images."""
