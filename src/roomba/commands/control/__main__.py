"""``python3 -m roomba.commands.control``."""

import sys

from roomba.commands.control.command import main

if __name__ == "__main__":
    sys.exit(main())
