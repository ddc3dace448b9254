"""A page over the headless robot that cleans in real time: ``python3 -m roomba_bench.page.served``.

Prints its port, and serves until its standard input ends.
"""

from __future__ import annotations

import sys

from roomba.clean_request import CleanRequest
from roomba.commands.play.living import live_client
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.ui.web.server import PageServer, listen


def main() -> None:
    """Serve."""
    robot = live_client("flat", seed=1, speed=1.0, knows_map=True)
    bound = listen("127.0.0.1", 0, is_fixed=True)
    server = PageServer(create_app(robot, Guard(new_token())), bound)
    robot.start()
    server.start()
    robot.clean(CleanRequest())
    print(bound.getsockname()[1], flush=True)
    sys.stdin.read()
    server.stop()
    robot.end()


if __name__ == "__main__":
    main()
