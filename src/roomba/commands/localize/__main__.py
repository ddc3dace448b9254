"""``python3 -m roomba.commands.localize``: the command."""

import sys

from roomba.commands.localize.command import main

if __name__ == "__main__":
    sys.exit(main())
