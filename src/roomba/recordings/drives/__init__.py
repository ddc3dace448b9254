"""Recorded drives: logs read as one, the channels that are read, where the sensors are."""
