"""``python -m roomba.commands.exercise``."""

import sys

from roomba.commands.exercise.command import main

sys.exit(main())
