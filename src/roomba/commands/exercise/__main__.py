"""``python -m roomba.commands.exercise``."""

import sys

from roomba.commands.process_end import quiet_end, quiet_loading

if __name__ == "__main__":
    with quiet_end():
        with quiet_loading():
            from roomba.commands.exercise.command import main

        sys.exit(main())
