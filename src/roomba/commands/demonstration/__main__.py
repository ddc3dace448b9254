"""``./roomba exec python -m roomba.commands.demonstration``."""

import sys

from roomba.commands.process_end import quiet_end, quiet_loading

if __name__ == "__main__":
    with quiet_end():
        with quiet_loading():
            from roomba.commands.demonstration.command import main

        sys.exit(main())
