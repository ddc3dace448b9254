"""``python3 -m roomba.commands.map``: the command without ``--bag``."""

import sys

from roomba.commands.map.command import main

if __name__ == "__main__":
    sys.exit(main())
