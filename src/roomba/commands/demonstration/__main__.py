"""``./roomba exec python -m roomba.commands.demonstration``."""

import sys

from roomba.commands.demonstration.command import main

if __name__ == "__main__":
    sys.exit(main())
