"""``roomba top``: state, map, topics and log of a robot on a whole terminal, and keys for it."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from roomba.client.address import HERE, page_address, token_for
from roomba.client.ports import DEFAULT_PORT, PORTS
from roomba.commands.options import HelpfulParser
from roomba.commands.play.living import add_robot_options, require_demo, wanted_robot
from roomba.commands.program_name import spelled
from roomba.commands.status.asking import NoRobotError, find_robot, state_at
from roomba.errors import RoombaError
from roomba.ui.state_words import lines_of
from roomba.ui.top.app import TopApp
from roomba.ui.top.link import PageLink
from roomba.ui.top.rates import TopicRates
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.ui.web.server import PageServer, listen

PROGRAM: Final = spelled("top")


def main(arguments: list[str] | None = None) -> int:
    """Show a robot until its user leaves; returns 0, 1 when none answers, or 2 for wrong usage."""
    parser = _parser()
    wanted = parser.parse_args(arguments)
    require_demo(parser, wanted)
    try:
        if wanted.demo:
            with _demo_robot(wanted) as (port, token):
                return _show(HERE, port, token, None)
        address = page_address(wanted.address)
        port = find_robot(PORTS if address.port is None else (address.port,), address.host)
        return _show(address.host, port, token_for(address, port), TopicRates())
    except NoRobotError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 1
    except RoombaError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2


def _show(host: str, port: int, token: str, rates: TopicRates | None) -> int:
    """Show the robot of a page: on a terminal until its user leaves, else once in plain lines."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        for name, value in lines_of(state_at(port, host)):
            print(f"{name:<8} {value}")
        return 0
    return TopApp(PageLink(port, token, host), rates).run() or 0


@contextmanager
def _demo_robot(wanted: argparse.Namespace) -> Iterator[tuple[int, str]]:
    """Let a robot live in a home as long as it is looked at; give port and token of its page."""
    client, token = wanted_robot(wanted), new_token()
    bound = listen("127.0.0.1", 0, is_fixed=True)
    server = PageServer(create_app(client, Guard(token)), bound)
    client.start()
    try:
        server.start()
        yield bound.getsockname()[1], token
    finally:
        server.stop()
        client.end()


def _parser() -> argparse.ArgumentParser:
    parser = HelpfulParser(
        prog=PROGRAM,
        description="The robot of ./roomba run, or of ./roomba play, on a whole terminal, with "
        "keys that command it. In a pipe: its state once, in plain lines.",
        epilog="Its keys command a robot that this user started on this machine; for another one "
        "give the whole printed address, with its token. Exit status: 0 when it was left, 1 when "
        "no robot answers, 2 for wrong usage.",
    )
    parser.add_argument(
        "address",
        nargs="?",
        default="",
        metavar="ADDRESS|PORT",
        help="the address that run or play printed, or its port (default: "
        f"{DEFAULT_PORT}, or the next at which a page answers)",
    )
    demo = parser.add_argument_group("a robot of its own, without ROS")
    demo.add_argument(
        "--demo", action="store_true", help="a robot lives in a home while it is looked at"
    )
    add_robot_options(demo)
    return parser
