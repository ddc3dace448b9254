"""``python3 -m roomba.sim``: the command without ROS, and so without ``--bag``."""

import sys

from roomba.sim.command import main

if __name__ == "__main__":
    sys.exit(main())
