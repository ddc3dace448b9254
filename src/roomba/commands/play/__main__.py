"""``python3 -m roomba.commands.play``."""

import sys

from roomba.commands.play.command import main

if __name__ == "__main__":
    sys.exit(main())
