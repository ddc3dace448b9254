"""The report's menu on a terminal."""

from __future__ import annotations

import signal
import sys

from roomba.errors import RoombaError
from roomba.ui.cleaning import CLEANING_HEADING
from roomba.ui.exploring import TASKS
from roomba.ui.menu import Menu
from roomba_ros.client.ros_client import RosRobot
from roomba_ros.runtime.graph.alone import is_taken
from roomba_ros.runtime.graph.joining import join_graph
from roomba_ros.runtime.graph.staying import stay_in_graph
from roomba_ros.runtime.node import leave, require_master, wait_for_clock
from roomba_ros.runtime.subscriptions import tell_refusals


def main() -> None:
    """Run the menu until its user leaves."""
    require_master()
    # Ctrl-C belongs to the menu: it cancels a walk, and leaves a clean to itself.
    join_graph("control_node", is_anonymous=is_taken("control_node"))
    stay_in_graph()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        wait_for_clock()
        tell_refusals()
        robot = RosRobot()
        robot.start()
    except KeyboardInterrupt:
        leave(130)
    except RoombaError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
    leave(Menu(robot, more=TASKS, more_heading=CLEANING_HEADING).run())
