"""``python3 -m roomba.commands.status``."""

import sys

from roomba.commands.status.command import main

if __name__ == "__main__":
    sys.exit(main())
