"""Every number of the robot, validated and frozen, each with a file in ``data/configuration``."""
