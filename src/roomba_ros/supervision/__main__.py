"""``python3 -m roomba_ros.supervision``: Ctrl-C ends it without a word while it still imports."""

import os
import signal
import sys

for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, signal.SIG_DFL)

from roomba.errors import RoombaError  # noqa: E402
from roomba_ros.supervision.launch_xml import environment_of, launch_file  # noqa: E402

try:
    environment = environment_of(launch_file())
except RoombaError as error:
    sys.exit(str(error))
if not environment.items() <= os.environ.items():
    # The C library reads it when a process starts.
    os.environ.update(environment)
    os.execv(sys.executable, [sys.executable, "-m", "roomba_ros.supervision", *sys.argv[1:]])

from roomba_ros.supervision.run import run_and_leave  # noqa: E402

run_and_leave()
