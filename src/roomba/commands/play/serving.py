"""Serves a page until Ctrl-C, and prints its address."""

from __future__ import annotations

import argparse
import contextlib
import socket
from typing import Final

from roomba.client.household import Household
from roomba.client.observed import ObservedRobot
from roomba.client.ports import DEFAULT_PORT, LAST_PORT
from roomba.commands.options import whole
from roomba.commands.play.told_to_end import ToldToEnd
from roomba.history.recorder import HistoryKeeper
from roomba.ui.desktop import open_on_desktop
from roomba.ui.smart_home.switch import Switched
from roomba.ui.web.addresses import ALL, addresses_of, guard_for, is_host
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import LOOPBACK, Guard
from roomba.ui.web.kept_token import kept_token
from roomba.ui.web.server import PageServer, listen

_HEARD_WITHIN: Final = 0.2
"""s of wall time within which the program ends even if Python dropped the KeyboardInterrupt."""


def add_page_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of every page: its address, and whether a browser is opened."""
    parser.add_argument(
        "--port",
        type=whole(0, LAST_PORT),
        metavar="N",
        help="of the page; 0: any that is free "
        f"(default: {DEFAULT_PORT}, or the next that is free)",
    )
    parser.add_argument(
        "--host",
        type=_host,
        default=LOOPBACK[0],
        metavar="ADDRESS",
        help=f"where it is reached; {ALL}: from all machines of the home network, which then see "
        "all that it shows (default: from this machine alone)",
    )
    parser.add_argument(
        "--no-open",
        dest="open",
        action="store_false",
        help="open no browser on the page, where there is a desktop",
    )


def listen_at(wanted: argparse.Namespace) -> socket.socket:
    """Return a socket that listens where the options say; raises ServerError."""
    port = DEFAULT_PORT if wanted.port is None else wanted.port
    return listen(wanted.host, port, is_fixed=wanted.port is not None)


def serve_page(
    robot: ObservedRobot,
    bound: socket.socket,
    told: str,
    ending: ToldToEnd,
    *,
    is_opened: bool,
    keeper: HistoryKeeper | None = None,
    household: Household | None = None,
    smart_home: Switched | None = None,
) -> None:
    """Print the address; serve the page and the smart home of a robot until it is told to end.

    Raises ServerError.
    """
    with contextlib.ExitStack() as until_end, contextlib.suppress(KeyboardInterrupt):
        guard = guard_for(kept_token(), bound.getsockname()[0])
        server = PageServer(create_app(robot, guard, keeper, household=household), bound)
        until_end.callback(server.stop)
        # In a thread, so that Ctrl-C reaches this code and never an event loop that is being made.
        server.start()
        _tell(bound, guard, told)
        if is_opened:
            open_on_desktop(addresses_of(bound, guard.token)[0])
        if smart_home is not None:
            smart_home.start()
            until_end.callback(smart_home.stop)
        while not (ending.is_told or server.has_ended(within=_HEARD_WITHIN)):
            pass


def _tell(bound: socket.socket, guard: Guard, told: str) -> None:
    """Print where the page is."""
    address, *others = addresses_of(bound, guard.token)
    print(f"{told}\n\n    {address}")
    if others:
        print("\nFrom other machines of the network:\n")
        print("\n".join(f"    {other}" for other in others))
    print("\nCtrl-C ends it.", flush=True)


def _host(text: str) -> str:
    if not is_host(text):
        raise argparse.ArgumentTypeError(
            f"expected an address of this machine in numbers, such as {ALL}, got {text!r}"
        )
    return text
