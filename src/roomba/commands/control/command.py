"""``roomba control --demo``: the report's menu over a robot in a simulated home, without ROS."""

from __future__ import annotations

import argparse
import sys
from typing import Final

from roomba.commands.options import HelpfulParser
from roomba.commands.play.living import add_robot_options, wanted_robot
from roomba.commands.program_name import spelled
from roomba.errors import RoombaError
from roomba.headless.live.robot_client import LiveRobotClient
from roomba.ui.cleaning import CLEANING_HEADING
from roomba.ui.exploring import TASKS
from roomba.ui.menu import Menu
from roomba.ui.prompt import STATUS_INTERRUPTED

PROGRAM: Final = spelled("control")


def main(arguments: list[str] | None = None) -> int:
    """Run the menu until its user leaves; returns 0, 130 after Ctrl-C, 2 for wrong usage."""
    parser = _parser()
    wanted = parser.parse_args(arguments)
    if not wanted.demo:
        parser.error("expected --demo: the menu of a robot on ROS needs ROS, in a checkout")
    try:
        client = wanted_robot(wanted)
    except RoombaError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return STATUS_INTERRUPTED
    print(f"The robot lives in {wanted.home!r} while this menu is open; Ctrl-D leaves.", flush=True)
    client.start()
    try:
        robot = LiveRobotClient(client)
        return Menu(robot, more=TASKS, more_heading=CLEANING_HEADING).run()
    finally:
        client.end()


def _parser() -> argparse.ArgumentParser:
    parser = HelpfulParser(
        prog=PROGRAM,
        description="The menu: dirt, position, walk, clean, pause, dock, explore. Without --demo "
        "of the robot that runs on ROS.",
        epilog="Exit status: 0 when it was left, 1 when no robot runs on ROS, 2 for wrong usage, "
        "130 after Ctrl-C.",
    )
    parser.add_argument(
        "--demo", action="store_true", help="of a robot in a simulated home, without ROS"
    )
    add_robot_options(parser)
    return parser
