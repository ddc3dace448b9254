"""Measured claims, each beside its peers in the same run: ``./roomba bench``.

Nothing is imported here, for peers run under a Python that has not what the robot has.
"""
