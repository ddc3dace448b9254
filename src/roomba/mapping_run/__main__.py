"""``python3 -m roomba.mapping_run``: the command without ROS, and so without ``--bag``."""

import sys

from roomba.mapping_run.command import main

if __name__ == "__main__":
    sys.exit(main())
