"""``python3 -m roomba.commands.map.drive``: the command."""

import sys

from roomba.commands.map.drive.command import main

if __name__ == "__main__":
    sys.exit(main())
