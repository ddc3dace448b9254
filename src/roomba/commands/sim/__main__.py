"""``python3 -m roomba.commands.sim``: the command without ROS, and so without ``--bag``."""

import sys

from roomba.commands.ending import quiet_end, quiet_loading

if __name__ == "__main__":
    with quiet_end():
        with quiet_loading():
            from roomba.commands.sim.command import main

        sys.exit(main())
