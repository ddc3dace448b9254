"""``python3 -m roomba_ros.supervision``: Ctrl-C ends it without a word while it still imports."""

import os
import signal
import sys

ENDING = (signal.SIGINT, signal.SIGTERM)
for number in ENDING:
    signal.signal(number, signal.SIG_DFL)
# Blocked since the process began anew, below: an interpreter that is interrupted says so at length.
signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)

from roomba.errors import RoombaError  # noqa: E402
from roomba_ros.supervision.isolation import FLAG, enter_isolation  # noqa: E402
from roomba_ros.supervision.launch_xml import environment_of, launch_file  # noqa: E402

arguments = [argument for argument in sys.argv[1:] if argument != FLAG]
try:
    environment = environment_of(launch_file())
    if len(arguments) < len(sys.argv) - 1:
        enter_isolation(arguments)
except RoombaError as error:
    print(f"./roomba run: {error}", file=sys.stderr)
    sys.exit(2)
sys.argv[1:] = arguments
if not environment.items() <= os.environ.items():
    # The C library reads it when a process starts.
    os.environ.update(environment)
    signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    os.execv(sys.executable, [sys.executable, "-m", "roomba_ros.supervision", *arguments])

from roomba_ros.supervision.run import run_and_leave  # noqa: E402

run_and_leave()
