"""The others: one script per peer, run as a process of its own under ``.venv-bench``.

Each folder holds the peers of one subject, and what these share beside them; what starts a peer and
speaks with it stands here. Peers may import numpy, their own library, and what is in this package;
never the robot.
"""
