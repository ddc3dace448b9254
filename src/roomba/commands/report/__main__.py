"""``python3 -m roomba.commands.report``."""

import sys

from roomba.commands.report.command import main

if __name__ == "__main__":
    sys.exit(main())
