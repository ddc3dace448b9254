"""Measures claims about speed and quality, each beside peers in the same run: ``./roomba bench``.

Nothing is imported here: peers run under a Python that lacks the robot's packages.
"""
