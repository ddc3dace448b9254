"""The others: one script per peer, run as a process of its own under ``.venv-bench``.

Each folder holds the peers of one subject, and the code that these share. The code that starts a
peer and speaks with it is here. Peers may import numpy, their own library, and this package, but
never the robot.
"""
