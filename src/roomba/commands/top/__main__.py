"""``python3 -m roomba.commands.top``."""

import sys

from roomba.commands.top.command import main

if __name__ == "__main__":
    sys.exit(main())
