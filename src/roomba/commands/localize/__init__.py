"""Recorded drives localized on a map: ``./roomba localize``."""
