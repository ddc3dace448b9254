"""``./roomba import valetudo`` and ``./roomba export valetudo``."""
