"""``python3 -m roomba.commands.control``."""

import sys

from roomba.commands.process_end import quiet_end, quiet_loading

if __name__ == "__main__":
    with quiet_end():
        with quiet_loading():
            from roomba.commands.control.command import main

        sys.exit(main())
