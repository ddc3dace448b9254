"""Runs the command: ``python -m roomba.commands.emulate``."""

import sys

from roomba.commands.emulate.command import main

if __name__ == "__main__":
    sys.exit(main())
