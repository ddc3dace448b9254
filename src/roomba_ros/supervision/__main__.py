"""``python3 -m roomba_ros.supervision``: Ctrl-C ends it without a word while it still imports."""

import signal

for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, signal.SIG_DFL)

from roomba_ros.supervision.run import run_and_leave  # noqa: E402

run_and_leave()
