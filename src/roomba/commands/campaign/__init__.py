"""Campaigns: homes, seeds and variants of the robot, run on many machines and compared."""
