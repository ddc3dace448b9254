"""The others: one script per peer, run as a process of its own under ``.venv-bench``.

They may import numpy, their own library, and what stands beside them here; never the robot.
"""
