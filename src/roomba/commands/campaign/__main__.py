"""``python3 -m roomba.commands.campaign``."""

import sys

from roomba.commands.campaign.command import main

if __name__ == "__main__":
    sys.exit(main())
