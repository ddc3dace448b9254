"""``python3 -m roomba_ros.model``: the robot as a URDF. A signal ends it without a traceback."""

import signal
import sys

for number in (signal.SIGINT, signal.SIGTERM, signal.SIGPIPE):
    signal.signal(number, signal.SIG_DFL)

from roomba_ros.model.description import main  # noqa: E402

sys.exit(main())
