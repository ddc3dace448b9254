"""Runs of the headless robot, written as bags."""
