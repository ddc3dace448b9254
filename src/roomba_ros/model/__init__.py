"""The robot's model for RViz and other programs: a URDF with the numbers of its configuration."""
