"""``python3 -m roomba.commands.sim``: the command without ROS, and so without ``--bag``."""

import sys

from roomba.commands.sim.command import main

if __name__ == "__main__":
    sys.exit(main())
