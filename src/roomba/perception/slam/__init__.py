"""SLAM: making a map of a home while driving in it."""
