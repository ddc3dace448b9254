"""``roomba top``: state, map, topics and log of a robot on a whole terminal, and keys for it."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final
from urllib.parse import parse_qs, urlsplit

from roomba.client.ports import DEFAULT_PORT, PORTS
from roomba.commands.play.living import add_robot_options, wanted_robot
from roomba.commands.spelling import spelled
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
    wanted = _parser().parse_args(arguments)
    try:
        if wanted.demo:
            with _demo_robot(wanted) as (port, token):
                return _show(port, token, None)
        named, token = _where(wanted.address)
        return _show(find_robot(PORTS if named is None else (named,)), token, TopicRates())
    except NoRobotError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 1
    except RoombaError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2


def _show(port: int, token: str, rates: TopicRates | None) -> int:
    """Show the robot at a port: on a terminal until its user leaves, else once in plain lines."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        for name, value in lines_of(state_at(port)):
            print(f"{name:<8} {value}")
        return 0
    return TopApp(PageLink(port, token), rates).run() or 0


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


def _where(address: str) -> tuple[int | None, str]:
    """Return port and token of the address of a page, or of a port alone; raises RoombaError."""
    if not address or address.isdigit():
        return (int(address) if address else None), ""
    try:
        parts = urlsplit(address)
        port = parts.port
    except ValueError:
        port = None
    if port is None:
        raise RoombaError(
            f"expected a port, or the address that ./roomba run or play printed, got {address!r}"
        )
    return port, parse_qs(parts.fragment).get("token", [""])[0]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=PROGRAM,
        description="The robot of ./roomba run, or of ./roomba play, on a whole terminal.",
    )
    parser.add_argument(
        "address",
        nargs="?",
        default="",
        metavar="ADDRESS|PORT",
        help="the address that run or play printed, without whose token one can only look; or "
        f"its port (default: {DEFAULT_PORT}, or the next at which a page answers)",
    )
    parser.add_argument(
        "--demo", action="store_true", help="a robot that lives in a home meanwhile, without ROS"
    )
    add_robot_options(parser)
    return parser
